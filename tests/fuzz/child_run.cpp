// What a run in a process of its own sends back: the bytes of a run, with some of them replaced,
// and cut or continued by the last byte of the input.
#include <stdexcept>

#include "fathom/estimators/builtin.hpp"
#include "src/harness/conformance/logs.hpp"
#include "src/harness/run_bytes.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

MeasurementLog small_log() {
  conformance::LogOptions options;
  options.keyframes = 8;
  options.loops_at_end_only = true;
  MeasurementLog log = conformance::circle_log(options);
  log.add_absolute(AbsolutePose::heading(7, 0.1, 0.2));
  return log;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const MeasurementLog log = small_log();
  static const std::string sound = bytes_of(replay(log, builtin_estimators().find("ekf"), {}, {}));
  std::string bytes = sound;
  if (size > 0) {
    const std::size_t kept = bytes.size() * data[size - 1] / 250;
    bytes = fuzz::edited(bytes, fuzz::Draws(data, size - 1));
    bytes.resize(kept);
  }
  try {
    const std::string again = bytes_of(run_of(bytes, log, {}));
    fuzz::require(again == bytes, "a run is written as it was read");
  } catch (const std::runtime_error&) {
    // They are not whole.
  }
  return 0;
}
