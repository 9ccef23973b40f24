#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace fathom {

/// What is wrong with a command line, in the words of this program: an unknown command or flag with
/// the nearest one, what is missing and what it is, a word too many. `first` is the first word that
/// was given, empty where there was none.
std::string parse_error_text(const CLI::App& program, const CLI::ParseError& error,
                             const std::string& first);

/// The text, and where the command that was given says more.
std::string with_help(const CLI::App& program, const std::string& text);

}  // namespace fathom
