#pragma once

#include <string>

namespace fathom {

/// Standard output and standard error, formatted as printf does. All that a command says goes this
/// way, as most of it holds what files say: it is made printable() first.
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);
[[gnu::format(printf, 1, 2)]] void print_error(const char* format, ...);

/// From now on print() says nothing.
void print_nothing();

/// The same as a text, as it is.
[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...);

/// "fathom: note: …", a line of standard error.
void print_note(const std::string& note);

}  // namespace fathom
