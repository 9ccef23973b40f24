#include "apps/completion.hpp"

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr const char* kOpening = R"(# Completion of fathom for bash. Made by 'fathom pages'.

_fathom_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}

_fathom_folders() {
  compopt -o filenames 2> /dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$current")
}

# With no word offered, bash offers files.
_fathom_nothing() {
  compopt +o default 2> /dev/null
}

_fathom() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command=${COMP_WORDS[1]}
  COMPREPLY=()
  # bash takes '=' for a word of its own.
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $previous == '=' ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

constexpr const char* kEnd = R"(}

complete -o default -F _fathom fathom
)";

std::string words_call(const std::vector<std::string>& words) {
  return "_fathom_words '" + joined(words, " ") + "'";
}

// What completes the value of a flag; nothing said of a file, which bash completes.
std::string call_of(const DescribedFlag& flag, const WordsOfValues& known) {
  if (!flag.choices.empty()) return words_call(flag.choices);
  if (const auto found = known.find(flag.value_name); found != known.end()) {
    return words_call(found->second);
  }
  if (flag.value_name == "DIR") return "_fathom_folders";
  return flag.value_name == "FILE" ? ":" : "_fathom_nothing";
}

std::string cases_of_values(const DescribedCommand& command, const WordsOfValues& known) {
  std::string text;
  for (const DescribedFlag& flag : command.flags) {
    if (flag.value_name.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : flag.names) patterns.push_back(command.name + ":" + name);
    text += "    " + joined(patterns, " | ") + ") " + call_of(flag, known) + "; return ;;\n";
  }
  return text;
}

std::string case_of_flags(const DescribedCommand& command) {
  std::vector<std::string> names;
  for (const DescribedFlag& flag : command.flags) {
    names.insert(names.end(), flag.names.begin(), flag.names.end());
  }
  return "      " + command.name + ") " + words_call(names) + " ;;\n";
}

std::string case_of_argument(const DescribedCommand& command, const WordsOfValues& known) {
  if (command.arguments.empty()) return "";
  const DescribedFlag& argument = command.arguments.front();
  std::vector<std::string> words = argument.choices;
  if (const auto found = known.find(argument.names.front()); found != known.end()) {
    words = found->second;
  }
  return words.empty() ? "" : "    " + command.name + ") " + words_call(words) + " ;;\n";
}

}  // namespace

std::string bash_completion(const DescribedCommand& program,
                            const std::vector<DescribedCommand>& commands,
                            const WordsOfValues& known) {
  std::vector<std::string> first;
  first.reserve(commands.size());
  for (const DescribedCommand& command : commands) first.push_back(command.name);
  for (const DescribedFlag& flag : program.flags) {
    first.insert(first.end(), flag.names.begin(), flag.names.end());
  }
  std::string values;
  std::string flags;
  std::string arguments;
  for (const DescribedCommand& command : commands) {
    values += cases_of_values(command, known);
    flags += case_of_flags(command);
    arguments += case_of_argument(command, known);
  }
  return std::string(kOpening) + "  if ((COMP_CWORD == 1)); then\n    " + words_call(first) +
         "\n    return\n  fi\n  case \"$command:$previous\" in\n" + values +
         "  esac\n  if [[ $current == -* ]]; then\n    case \"$command\" in\n" + flags +
         "    esac\n    return\n  fi\n  case \"$command\" in\n" + arguments + "  esac\n" + kEnd;
}

}  // namespace fathom
