#include "apps/man_pages.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/core/version.hpp"

namespace fathom {
namespace {

// What troff would take for its own. Hyphens and quotes stay those of ASCII, so that they may be
// copied into a shell.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += letter;
    }
  }
  return out.starts_with('.') ? "\\&" + out : out;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string in_capitals(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::toupper(letter));
  return text;
}

std::string head(const std::string& name, const std::string& help) {
  return fmt::format(".TH {} 1 \"\" \"Fathom {}\" \"Fathom\"\n.SH NAME\n{} \\- {}\n",
                     in_capitals(escaped(name)), version(), escaped(name), escaped(help));
}

// As sentences, since the page has no columns for them.
std::string remarks(const DescribedFlag& flag) {
  std::string text;
  if (!flag.choices.empty()) text += " One of: " + joined(flag.choices, ", ") + ".";
  if (!flag.default_text.empty()) text += " Default: " + flag.default_text + ".";
  if (flag.is_required && flag.names.front().starts_with('-')) text += " Required.";
  if (flag.is_repeatable) text += " May be repeated.";
  if (!flag.excludes.empty()) text += " Not together with " + joined(flag.excludes, ", ") + ".";
  return text;
}

std::string entry(const DescribedFlag& flag) {
  const bool is_flag = flag.names.front().starts_with('-');
  std::string line;
  for (const std::string& name : flag.names) {
    line += (line.empty() ? "" : ", ") + (is_flag ? bold(name) : italic(name));
  }
  if (!flag.value_name.empty()) line += " " + italic(flag.value_name);
  const std::string end = flag.help.empty() || flag.help.ends_with('.') ? "" : ".";
  return ".TP\n" + line + "\n" + escaped(flag.help + end + remarks(flag)) + "\n";
}

std::string section(const std::string& title, const std::vector<DescribedFlag>& flags) {
  if (flags.empty()) return "";
  std::string text = ".SH " + title + "\n";
  for (const DescribedFlag& flag : flags) text += entry(flag);
  return text;
}

std::string synopsis(const DescribedCommand& command) {
  std::string line =
      ".SH SYNOPSIS\n" + bold("fathom " + command.name) + " [" + italic("OPTIONS") + "]";
  for (const DescribedFlag& argument : command.arguments) {
    const std::string dots = argument.is_repeatable ? "..." : "";
    line += " " + (argument.is_required ? italic(argument.names.front()) + dots
                                        : "[" + italic(argument.names.front()) + dots + "]");
  }
  return line + "\n";
}

// The footer of --help: lines of examples, the first after "Example:" and the others indented, and
// lines of prose.
struct Footer {
  std::vector<std::string> examples;
  std::vector<std::string> prose;
};

Footer footer_of(const DescribedCommand& command) {
  Footer footer;
  bool is_in_examples = false;
  for (const std::string_view whole : split(command.footer, "\n")) {
    const std::string_view line = trim(whole);
    if (line.empty()) continue;
    const std::size_t colon = line.starts_with("Example") ? line.find(':') : std::string::npos;
    is_in_examples = colon != std::string::npos || (is_in_examples && whole.starts_with(' '));
    const std::string_view text = colon == std::string::npos ? line : trim(line.substr(colon + 1));
    // A line that is no command goes on with the one above.
    const bool goes_on = is_in_examples && !text.starts_with("fathom");
    if (goes_on && !footer.examples.empty()) footer.examples.back() += " \\";
    (is_in_examples ? footer.examples : footer.prose)
        .push_back((goes_on ? "    " : "") + std::string(text));
  }
  return footer;
}

}  // namespace

std::string program_page(const DescribedCommand& program,
                         const std::vector<DescribedCommand>& commands) {
  std::string text = head(program.name, program.help);
  text += fmt::format(".SH SYNOPSIS\n{} {} [{}] {}\n.SH COMMANDS\n", bold(program.name),
                      italic("COMMAND"), italic("OPTIONS"), italic("ARGUMENTS"));
  for (const DescribedCommand& command : commands) {
    text += fmt::format(".TP\n\\fBfathom\\-{}\\fR(1)\n{}.\n", escaped(command.name),
                        escaped(command.help));
  }
  return text + section("OPTIONS", program.flags) + ".SH NOTES\n" + escaped(program.footer) + "\n";
}

std::string command_page(const DescribedCommand& command) {
  const Footer footer = footer_of(command);
  std::string text = head("fathom-" + command.name, command.help) + synopsis(command);
  text += ".SH DESCRIPTION\n" + escaped(command.help) + ".\n";
  for (const std::string& line : footer.prose) text += escaped(line) + "\n";
  text += section("ARGUMENTS", command.arguments) + section("OPTIONS", command.flags);
  if (!footer.examples.empty()) {
    text += ".SH EXAMPLES\n.nf\n";
    for (const std::string& line : footer.examples) text += escaped(line) + "\n";
    text += ".fi\n";
  }
  return text + ".SH SEE ALSO\n\\fBfathom\\fR(1)\n";
}

}  // namespace fathom
