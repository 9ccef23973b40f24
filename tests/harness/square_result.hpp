#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "harness/square_log.hpp"

namespace fathom::test {

/// The square as a recording: keyframes every second frame, half a metre further on.
inline Recording square(bool with_truth = true) {
  Recording recording;
  recording.log = square_log();
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000'000);
    recording.frames.push_back({recording.keyframe_times_ns[k], k, Pose{}});
    recording.frames.push_back(
        {recording.keyframe_times_ns[k] + 500'000'000, k, Pose{0.5, 0.0, 0.1}});
    recording.frame_dead_reckoning.resize(recording.frames.size());
  }
  if (with_truth) recording.ground_truth = square_truth();
  return recording;
}

/// What an estimator makes of a recording.
inline Result evaluated(const Recording& recording, const std::string& type = "ekf",
                        const EstimatorValues& values = {}) {
  return evaluate(recording, {type, type, values}, builtin_estimators(), {}, {});
}

/// No value of a written object is null, however deep.
inline void expect_no_null(const nlohmann::json& value, const std::string& where) {
  EXPECT_FALSE(value.is_null()) << where;
  if (!value.is_structured()) return;
  for (const auto& [key, item] : value.items()) expect_no_null(item, where + "." + key);
}

}  // namespace fathom::test
