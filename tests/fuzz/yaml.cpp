// A configuration in YAML as text, and a `--set` of it: read into settings, and no more, so that
// many can be tried (settings.cpp checks what they say).
#include "fathom/configuration/config_file.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

constexpr std::size_t kLongestKey = 200;
constexpr std::size_t kMostPrefixes = 8;  // each looks through all settings

void look_at(const Settings& settings) {
  std::size_t below = 0;
  std::size_t looked = 0;
  for (const Setting& setting : settings.all()) {
    fuzz::require(settings.find(setting.key) == &setting, "every key is there once");
    fuzz::require(setting.key.size() <= kLongestKey, "keys are short");
    if (++looked > kMostPrefixes) continue;
    const std::string prefix = setting.key.substr(0, setting.key.find('.') + 1);
    if (!prefix.empty()) below = settings.below(prefix).all().size();
    fuzz::require(prefix.empty() || below > 0, "a key lies below its first part");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  fuzz::is_taken([&] { look_at(parse_settings(text, "input")); });
  fuzz::is_taken([&] {
    for (const Setting& one : parse_overrides("a.b=" + text)) {
      fuzz::require(one.key.starts_with("a.b"), "a key is that which was given");
    }
  });
  return 0;
}
