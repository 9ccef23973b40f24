// A configuration in YAML: parsed, and checked as a run's, a comparison's and a study's.
#include "fathom/configuration/config_file.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  const std::string text(fuzz::text_of(data, size));
  Settings settings;
  if (!fuzz::is_taken([&] { settings = parse_settings(text, "input"); })) return 0;
  const EstimatorRegistry& registry = builtin_estimators();
  if (kind_of(settings) == ConfigurationKind::single) {
    fuzz::is_taken([&] { configure(settings, ConfigurationKind::single, registry); });
  } else {
    fuzz::is_taken([&] { configure_study(settings, registry); });
  }
  return 0;
}
