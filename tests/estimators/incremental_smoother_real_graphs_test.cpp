// incremental_smoother on real graphs, against batch optima of what it has been given.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "fathom/measurements/g2o.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using test::arrive;
using test::make;

class IncrementalSmootherOnRealGraphs : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(PoseGraphs, IncrementalSmootherOnRealGraphs,
                         testing::Values("CSAIL", "MIT", "intel", "manhattan", "M3500", "ring"),
                         [](const auto& name) { return name.param; });

TEST_P(IncrementalSmootherOnRealGraphs, StaysWithinOnePercentOfTheBatchOptimum) {
  const std::string file = "pose_graphs/" + GetParam() + ".g2o";
  FATHOM_REQUIRE_DATA(file);
  const MeasurementLog log = read_g2o(test::data_path(file));
  const auto ours = make("incremental_smoother", log.origin());
  MeasurementLog so_far(log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    EXPECT_TRUE(is_done(arrive(*ours, log, k).outcome)) << k;
    so_far.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) so_far.add_registration(z);
    if (k % 100 != 0 && k + 1 != log.size()) continue;
    const auto batch = make("sparse_gauss_newton", log.origin(), {}, SolveMode::batch);
    test::feed(*batch, so_far);
    const double optimum = chi2(so_far, poses_of(*batch));
    EXPECT_LT(chi2(so_far, poses_of(*ours)), optimum + std::max(1e-6, 0.01 * optimum)) << k;
  }
}

}  // namespace
}  // namespace fathom
