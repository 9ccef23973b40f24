#include "apps/parse_error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/described.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

bool is_flag(const std::string& word) {
  return word.size() > 1 && word.front() == '-';
}

std::vector<std::string> flag_names_of(const DescribedCommand& command) {
  std::vector<std::string> names;
  for (const DescribedFlag& flag : command.flags) {
    names.insert(names.end(), flag.names.begin(), flag.names.end());
  }
  return names;
}

// "--set=x" is the flag --set.
std::string name_in(const std::string& word) {
  return word.substr(0, word.find('='));
}

std::string unknown_flag(const std::string& word, const std::vector<std::string>& known) {
  return fmt::format("unknown flag {}{}", in_quotes(name_in(word)),
                     suggestion(name_in(word), known));
}

// "--batch" is "--mode batch".
std::string unknown_flag_of(const DescribedCommand& command, const std::string& word) {
  const std::string choice = word.substr(std::min(word.size(), word.find_first_not_of('-')));
  for (const DescribedFlag& flag : command.flags) {
    if (std::ranges::find(flag.choices, choice) == flag.choices.end()) continue;
    return fmt::format("unknown flag {}; did you mean {}?", in_quotes(word),
                       in_quotes(flag.names.back() + " " + choice));
  }
  return unknown_flag(word, flag_names_of(command));
}

// CLI11 begins its text with the name of the argument or flag.
const DescribedFlag* meant_by(const DescribedCommand& command, const std::string& text) {
  const std::string name = text.substr(0, text.find_first_of(" :"));
  for (const auto* flags : {&command.arguments, &command.flags}) {
    for (const DescribedFlag& flag : *flags) {
      if (std::ranges::find(flag.names, name) != flag.names.end()) return &flag;
    }
  }
  return nullptr;
}

std::string missing(const DescribedFlag& flag) {
  return fmt::format("{} is missing: {}{}", in_quotes(flag.names.front()), flag.help,
                     flag.choices.empty() ? "" : ": " + joined(flag.choices, ", "));
}

std::string of_command(const CLI::App& app, const CLI::ParseError& error) {
  const DescribedCommand command = described(app);
  const std::vector<std::string> left = app.remaining();
  // First of all: a flag that is misspelt leaves its value, or lacks what is required.
  if (const auto flag = std::ranges::find_if(left, is_flag); flag != left.end()) {
    return unknown_flag_of(command, *flag);
  }
  const DescribedFlag* const meant = meant_by(command, error.what());
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && meant != nullptr) {
    return missing(*meant);
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && meant != nullptr) {
    return fmt::format("{}: expected {} after it", meant->names.back(),
                       meant->value_name.empty() ? "one word" : meant->value_name);
  }
  if (!left.empty()) return in_quotes(left.front()) + " is a word too many";
  return error.what();
}

}  // namespace

std::string with_help(const CLI::App& program, const std::string& text) {
  return fmt::format("{} (see fathom {} --help)", text,
                     program.get_subcommands().front()->get_name());
}

std::string parse_error_text(const CLI::App& program, const CLI::ParseError& error,
                             const std::string& first) {
  if (const auto commands = program.get_subcommands(); !commands.empty()) {
    return with_help(program, of_command(*commands.front(), error));
  }
  if (first.empty()) return "a command is missing (fathom --help lists them)";
  if (is_flag(first)) {
    return unknown_flag(first, {"--help", "--version"}) + " (see fathom --help)";
  }
  std::vector<std::string> names{"--version"};
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("unknown command {}{} (fathom --help lists them)", in_quotes(first),
                     suggestion(first, names));
}

}  // namespace fathom
