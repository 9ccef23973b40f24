#include "apps/flags.hpp"

#include <algorithm>
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/output.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& kind, Range range,
                         const std::string& given) {
  const std::string bounds = range.text();
  throw FlagError(fmt::format("{}: expected {}{}, got {}", name, kind,
                              bounds.empty() ? "" : " " + bounds, in_quotes(given)));
}

double real_of(const std::string& name, Range range, const std::string& text) {
  const std::optional<double> number = parse_real(text);
  if (!number || !range.contains(*number)) refuse(name, "a number", range, text);
  return *number;
}

int integer_of(const std::string& name, Range range, const std::string& text) {
  const std::optional<std::int64_t> number = parse_integer(text);
  constexpr Range kInt{std::numeric_limits<int>::min(), std::numeric_limits<int>::max()};
  const auto is_in = [&](Range bounds) { return bounds.contains(static_cast<double>(*number)); };
  if (!number || !is_in(kInt) || !is_in(range)) refuse(name, "a whole number", range, text);
  return static_cast<int>(*number);
}

// An empty word is the slip of a script, such as a variable that is not set.
const std::string& word_of(const std::string& name, const std::string& text) {
  if (text.empty()) throw FlagError(name + ": expected a word, got ''");
  // An empty variable of the shell before it, most often.
  if (text.starts_with("--")) {
    throw InputError(name + ": expected a word, got the flag " + in_quotes(text) +
                     "; a file of this name is ./" + text);
  }
  return text;
}

CLI::Validator one_of(const std::string& name, const std::vector<std::string>& choices) {
  const auto refusal = [name, choices](const std::string& given) -> std::string {
    if (std::ranges::find(choices, given) != choices.end()) return "";
    throw FlagError(name + ": " + not_one_of(given, choices));
  };
  return {refusal, "{" + joined(choices, ",") + "}"};
}

}  // namespace

const Flag& Flag::required() const {
  option_->required()->default_str("");  // what must be given has none
  return *this;
}

const Flag& Flag::excludes(const Flag& other) const {
  option_->excludes(other.option_);
  return *this;
}

bool Flag::is_given() const {
  return option_->count() > 0;
}

Command::Command(CLI::App& program, const std::string& name, const std::string& help,
                 const std::string& footer)
    : command_(program.add_subcommand(name, help)) {
  command_->footer(footer);
}

Flag Command::add(const std::string& name, const std::string& value_name, const std::string& help,
                  const std::string& default_text, const std::function<void(const Values&)>& read) {
  CLI::Option* option = command_->add_option_function<Values>(name, read, help);
  option->type_name(value_name)->expected(1)->default_str(default_text);
  return Flag(*option);
}

Flag Command::argument(const std::string& name, std::string& field, const std::string& help) {
  CLI::Option* option = command_->add_option_function<std::string>(
      name, [&field, name](const std::string& given) { field = word_of(name, given); }, help);
  return Flag(*option->type_name("")->required());
}

Flag Command::argument(const std::string& name, std::string& field,
                       const std::vector<std::string>& choices, const std::string& help) {
  CLI::Option* option = command_->add_option(name, field, help);
  return Flag(*option->required()->check(one_of(name, choices))->type_name(""));
}

Flag Command::arguments(const std::string& name, std::vector<std::string>& field,
                        const std::string& help) {
  return optional_arguments(name, field, help).required();
}

Flag Command::optional_arguments(const std::string& name, std::vector<std::string>& field,
                                 const std::string& help) {
  CLI::Option* option = command_->add_option_function<Values>(
      name,
      [&field, name](const Values& given) {
        for (const std::string& text : given) field.push_back(word_of(name, text));
      },
      help);
  return Flag(*option->type_name("")->expected(1, CLI::detail::expected_max_vector_size));
}

Flag Command::text(const std::string& name, std::string& field, const std::string& value_name,
                   const std::string& help) {
  return add(name, value_name, help, field,
             [&field, name](const Values& given) { field = word_of(name, given[0]); });
}

Flag Command::texts(const std::string& name, std::vector<std::string>& field,
                    const std::string& value_name, const std::string& help) {
  CLI::Option* option = command_->add_option(name, field, help);
  return Flag(*option->type_name(value_name)->allow_extra_args(false));
}

Flag Command::choice(const std::string& name, std::string& field,
                     const std::vector<std::string>& choices, const std::string& value_name,
                     const std::string& help) {
  CLI::Option* option = command_->add_option(name, field, help);
  return Flag(*option->check(one_of(name, choices))->type_name(value_name)->default_str(field));
}

Flag Command::real(const std::string& name, double& field, Range range,
                   const std::string& value_name, const std::string& help) {
  return add(
      name, value_name, help, number_text(field),
      [&field, name, range](const Values& given) { field = real_of(name, range, given[0]); });
}

Flag Command::real(const std::string& name, std::optional<double>& field, Range range,
                   const std::string& value_name, const std::string& help) {
  return add(name, value_name, help, "", [&field, name, range](const Values& given) {
    field = real_of(name, range, given[0]);
  });
}

Flag Command::reals(const std::string& name, std::vector<double>& field, Range range,
                    const std::string& value_name, const std::string& help) {
  CLI::Option* option = command_->add_option_function<Values>(
      name,
      [&field, name, range](const Values& given) {
        field.clear();
        for (const std::string& text : given) field.push_back(real_of(name, range, text));
      },
      help);
  return Flag(*option->type_name(value_name)->allow_extra_args(false));
}

Flag Command::integer(const std::string& name, int& field, Range range,
                      const std::string& value_name, const std::string& help) {
  return add(
      name, value_name, help, std::to_string(field),
      [&field, name, range](const Values& given) { field = integer_of(name, range, given[0]); });
}

Flag Command::integer(const std::string& name, std::optional<int>& field, Range range,
                      const std::string& value_name, const std::string& help) {
  return add(name, value_name, help, "", [&field, name, range](const Values& given) {
    field = integer_of(name, range, given[0]);
  });
}

Flag Command::integers(const std::string& name, std::vector<std::size_t>& field, Range range,
                       const std::string& value_name, const std::string& help) {
  CLI::Option* option = command_->add_option_function<Values>(
      name,
      [&field, name, range](const Values& given) {
        field.clear();
        for (const std::string& text : given) {
          field.push_back(static_cast<std::size_t>(integer_of(name, range, text)));
        }
      },
      help);
  return Flag(*option->type_name(value_name)->allow_extra_args(false));
}

Flag Command::boolean(const std::string& name, bool& field, const std::string& help) {
  return Flag(*command_->add_flag(name, field, help));
}

void Command::quiet() {
  command_->add_flag_callback("--quiet", print_nothing, "No output but errors");
}

std::vector<std::string> Command::given() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : command_->get_options()) {
    if (option->count() > 0 && !option->get_positional()) names.push_back(option->get_name());
  }
  return names;
}

void Command::hidden() {
  command_->group("");
}

void Command::on_run(std::function<void()> action) {
  command_->callback(std::move(action));
}

}  // namespace fathom
