#pragma once

#include <filesystem>

#include "fathom/results/result_store.hpp"

namespace fathom::test {

/// A made-up study: estimators "iterated" (trajectory_iekf), "a&b_<c>%" (ekf) and "graph"
/// (ceres_pose_graph) on lawnmower paths of `keyframes`, in cells of two axes, with all metrics and
/// series of docs/formats.md. The errors are Gaussian walks of known spread; the second estimator
/// states a spread that is half the true one; the third is twice as wrong as the first.
struct FixtureOptions {
  std::string data_set = "simulated";
  std::size_t surveys = 1;
  std::size_t trials = 6;
  std::size_t keyframes = 40;
  std::vector<std::string> separations{"5", "10", "20"};
  std::vector<std::string> noises{"low", "high & <b>50%</b>"};
  std::string noise_name = "noise, \"odometry\"";
  std::vector<std::string> alignments{};  ///< of the last axis; empty: "origin" alone
  bool ground_truth = true;               ///< else no accuracy, consistency, or truth
  bool loops = true;
  /// Of every fifth keyframe a fix at its true position, with σ of 0.5 and 0.25 m, but that of
  /// keyframe 20 is 2 m off along x and 1 m along y; of every keyframe a heading, which is true but
  /// that of keyframe 12, a quarter turn off. "iterated" rejects both, "graph" gives both a weight
  /// of 0.1, the other one uses them.
  bool absolute = false;
  bool absolute_is_old = false;  ///< stored without what was measured
  /// In the first cell measurements do not fit each other; F (`chi2`) is the study's first metric.
  bool misfit = false;
  int jobs = 2;
  double size = 1.0;      ///< of all errors
  double baseline = 1.0;  ///< of dead reckoning's, times `size`

  bool operator==(const FixtureOptions&) const = default;
};

StudyDescription fixture_study(const FixtureOptions& options = {});

/// In the last cell and in every survey the second estimator diverges on trial 0 and fails on trial
/// 1, and the third stops at its iteration limit on trial 0; those that failed have no metrics but
/// `keyframes`.
void write_fixture(const std::filesystem::path& folder, const FixtureOptions& options = {});

}  // namespace fathom::test
