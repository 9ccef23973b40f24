#pragma once

#include <cstdint>

#include "fathom/harness/replay.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/square_log.hpp"

namespace fathom::test {

/// What comes of the square's log where an estimator follows the script.
inline Run replayed(Script& script, const ReplayOptions& options = {}) {
  return replay(square_log(), scripted(script), {}, options);
}

/// Finds 4242 bytes. What it was asked to do is among the calls of the script.
class FakeMeter : public MemoryMeter {
 public:
  explicit FakeMeter(Script& script) : script_(script) {}
  void start() override { script_.calls.push_back("start"); }
  std::int64_t stop() override {
    script_.calls.push_back("stop");
    return 4242;
  }
  void pause() override { script_.calls.push_back("pause"); }
  void resume() override { script_.calls.push_back("resume"); }

 private:
  Script& script_;
};

}  // namespace fathom::test
