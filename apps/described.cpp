#include "apps/described.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name()};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// "MODE:{incremental,batch}": what stands for the value, then its choices.
void read_type(const std::string& type, DescribedFlag& flag) {
  const std::size_t colon = type.find(':');
  flag.value_name = type.substr(0, colon);
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return;
  const std::string choices = type.substr(open + 1, close - open - 1);
  for (const std::string_view choice : split(choices, ",")) flag.choices.emplace_back(choice);
}

DescribedFlag described_flag(const CLI::Option& option) {
  DescribedFlag flag;
  flag.names = names_of(option);
  read_type(option.get_type_name(), flag);
  flag.default_text = option.get_default_str();
  flag.help = option.get_description();
  flag.is_required = option.get_required();
  flag.is_repeatable = option.get_expected_max() > 1;
  for (const CLI::Option* other : option.get_excludes()) {
    flag.excludes.push_back(names_of(*other).front());
  }
  std::sort(flag.excludes.begin(), flag.excludes.end());
  return flag;
}

}  // namespace

DescribedCommand described(const CLI::App& command) {
  DescribedCommand all{command.get_name(), command.get_description(), command.get_footer(), {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    (option->get_positional() ? all.arguments : all.flags).push_back(described_flag(*option));
  }
  return all;
}

std::vector<DescribedCommand> described_commands(const CLI::App& program) {
  std::vector<DescribedCommand> all;
  for (const CLI::App* command : program.get_subcommands({})) {
    if (!command->get_group().empty()) all.push_back(described(*command));
  }
  return all;
}

}  // namespace fathom
