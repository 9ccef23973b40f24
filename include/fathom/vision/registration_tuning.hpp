#pragma once

#include "fathom/core/options.hpp"

namespace fathom {

/// Of `features.flatten` (docs/registration.md). Greys are those of an 8-bit picture.
struct FeatureTuning {
  double window_px = 6.0;
  double window_growth = 4.0;
  double least_deviation = 1.0;
  double deviation = 40.0;
  double mean = 128.0;
  double fine_blur_px = 0.7;
  double middle_blur_px = 1.0;
  double coarse_blur_px = 2.0;
  double noise_in_fine_band = 0.72;
  double noise_in_middle_band = 0.14;
  double floor_band_ratio = 0.6;
  double noise_left = 0.8;
  double least_floor = 0.1;
  double least_blur_px = 0.4;
  double most_blur_px = 2.5;

  void describe(OptionTable& table);
};

struct MatchingTuning {
  double size_ratio = 1.6;
  double turn_tolerance_rad = 0.5;

  void describe(OptionTable& table);
};

struct RansacTuning {
  int redraws = 100;
  int refit_rounds = 20;

  void describe(OptionTable& table);
};

/// Of `decision.method: false_alarms`.
struct DecisionTuning {
  int support_rounds = 10;
  int most_places = 200;
  double rival_distance = 3.0;
  double grid_spacing = 1.5;
  double fine_divisor = 3.0;
  double rival_share = 0.2;

  void describe(OptionTable& table);
};

/// Of the weighted fit, after a decision by false alarms.
struct FitTuning {
  double gate = 11.0;
  int rounds = 20;

  void describe(OptionTable& table);
};

struct CovarianceTuning {
  double cluster_px = 64.0;
  int least_clusters = 6;
  double shared_error = 0.055;

  void describe(OptionTable& table);
};

/// The tuned numbers of a registration, by its steps. Their defaults belong together: the figures
/// of docs/registration_benchmark.md hold for all of them as they are. Each says in its description
/// where its value comes from. All of them are part of a registration's key, so no cache outlives a
/// change.
///
/// "Benchmark" in a description: calibrated on the rendered pairs of registration_benchmark, four
/// procedural floors and a picture of a real one under twelve conditions.
struct RegistrationTuning {
  FeatureTuning features;
  MatchingTuning matching;
  RansacTuning ransac;
  DecisionTuning decision;
  FitTuning fit;
  CovarianceTuning covariance;

  void describe(OptionTable& table);
};

}  // namespace fathom
