#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace fathom {

/// A flag or an argument, as --help says it.
struct DescribedFlag {
  std::vector<std::string> names;  ///< "-h", "--help"; of an argument its one name
  std::string value_name;          ///< "DIR"; empty where it takes none, and of an argument
  std::vector<std::string> choices;
  std::string default_text;
  std::string help;
  bool is_required = false;
  bool is_repeatable = false;
  std::vector<std::string> excludes;
};

struct DescribedCommand {
  std::string name;
  std::string help;
  std::string footer;
  std::vector<DescribedFlag> arguments;
  std::vector<DescribedFlag> flags;
};

/// The program, or one of its commands.
DescribedCommand described(const CLI::App& command);

/// All commands that --help lists, in its order.
std::vector<DescribedCommand> described_commands(const CLI::App& program);

}  // namespace fathom
