// A pose graph as text, g2o or TORO: read, written and read again, converted, looked at.
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/graph_conversion.hpp"
#include "fathom/measurements/loop_terms.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

// Larger graphs would be a test of patience.
constexpr std::size_t kMostKeyframes = 50;

void look_at(const MeasurementLog& log) {
  const std::string written = to_g2o(log);
  const MeasurementLog again = parse_g2o(written, "written");
  fuzz::require(to_g2o(again) == written, "a log reads back as it was written");
  fuzz::is_taken([&] { with_start_of_priors(log, "input"); });
  chi2(log, log.odometry());
  if (log.size() <= kMostKeyframes) loop_terms(log);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(fuzz::text_of(data, size));
  std::optional<MeasurementLog> log;
  if (fuzz::is_taken([&] { log = parse_g2o(text, "input"); })) {
    look_at(*log);
  } else {
    GraphOptions lenient;
    lenient.component = 1;
    lenient.drop_self_edges = true;
    if (fuzz::is_taken([&] { log = parse_g2o(text, "input", lenient); })) look_at(*log);
  }
  for (const GraphFormat format : {GraphFormat::g2o, GraphFormat::toro}) {
    fuzz::is_taken([&] { convert_graph(text, "input", format, {true, true}); });
  }
  return 0;
}
