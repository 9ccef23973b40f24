// What follows `--set`, a setting a line: parsed, and checked together as a run's.
#include "fathom/configuration/configuration.hpp"
#include "fathom/core/text.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  Settings settings;
  std::string_view rest = fuzz::text_of(data, size);
  for (bool is_last = false; !is_last;) {
    const std::size_t end = rest.find('\n');
    is_last = end == std::string_view::npos;
    const std::string one(rest.substr(0, end));
    fuzz::is_taken([&] { settings.put(parse_override(one)); });
    if (!is_last) rest.remove_prefix(end + 1);
  }
  if (settings.all().empty()) return 0;
  fuzz::is_taken([&] { configure(settings, kind_of(settings), builtin_estimators()); });
  return 0;
}
