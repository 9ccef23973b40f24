#include "apps/output.hpp"

#include <cstdarg>
#include <cstdio>
#include <vector>

#include "fathom/core/utf8.hpp"

namespace fathom {
namespace {

[[gnu::format(printf, 2, 0)]] void print_to(std::FILE* stream, const char* format,
                                            std::va_list arguments) {
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, again);
  va_end(again);
  if (length < 0) return;
  std::vector<char> text(static_cast<std::size_t>(length) + 1);
  std::vsnprintf(text.data(), text.size(), format, arguments);
  const std::string shown = printable({text.data(), static_cast<std::size_t>(length)});
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

}  // namespace

void print(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  print_to(stdout, format, arguments);
  va_end(arguments);
}

void print_error(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  print_to(stderr, format, arguments);
  va_end(arguments);
}

void print_note(const std::string& note) {
  print_error("fathom: note: %s\n", note.c_str());
}

}  // namespace fathom
