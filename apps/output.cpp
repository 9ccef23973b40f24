#include "apps/output.hpp"

#include <cstdarg>
#include <cstdio>

#include "fathom/core/utf8.hpp"

namespace fathom {
namespace {

bool is_silent = false;

[[gnu::format(printf, 1, 0)]] std::string formatted(const char* format, std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  if (length < 0) return "";
  std::string text(static_cast<std::size_t>(length), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, arguments);
  return text;
}

void write_to(std::FILE* stream, const std::string& text) {
  const std::string shown = printable(text);
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

}  // namespace

void print_nothing() {
  is_silent = true;
}

void print(const char* format, ...) {
  if (is_silent) return;
  std::va_list arguments;
  va_start(arguments, format);
  write_to(stdout, formatted(format, arguments));
  va_end(arguments);
}

void print_error(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  write_to(stderr, formatted(format, arguments));
  va_end(arguments);
}

std::string printed(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::string text = formatted(format, arguments);
  va_end(arguments);
  return text;
}

void print_note(const std::string& note) {
  print_error("fathom: note: %s\n", note.c_str());
}

}  // namespace fathom
