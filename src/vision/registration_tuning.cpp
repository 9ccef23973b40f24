#include "fathom/vision/registration_tuning.hpp"

namespace fathom {

void FeatureTuning::describe(OptionTable& table) {
  table.real("window_px", window_px, Range::between(1.0, 1000.0), "pixels",
             "flatten: radius of the window of mean and deviation; benchmark");
  table.real("window_growth", window_growth, Range::between(0.0, 1000.0), "",
             "flatten: the window's radius grows by this times the blur; benchmark, noise");
  table.real("least_deviation", least_deviation, Range{1e-3, 255.0}, "grey",
             "flatten: added to a deviation; one grey is what rounding makes");
  table.real("deviation", deviation, Range{1.0, 127.0}, "grey",
             "flatten: deviation of the result; three of them fill the range of 8 bits");
  table.real("mean", mean, Range::between(0.0, 255.0), "grey",
             "flatten: mean of the result; the middle of the range");
  table.real("fine_blur_px", fine_blur_px, Range{0.1, 100.0}, "pixels",
             "noise: the fine band is the picture less itself blurred by this; benchmark, noise");
  table.real("middle_blur_px", middle_blur_px, Range{0.1, 100.0}, "pixels",
             "noise: the middle band begins at this blur; benchmark, noise");
  table.real("coarse_blur_px", coarse_blur_px, Range{0.1, 100.0}, "pixels",
             "noise: and ends at this one; benchmark, noise");
  table.real("noise_in_fine_band", noise_in_fine_band, Range{0.0, 1.0, true}, "",
             "noise: deviation of white noise of deviation 1 in the fine band; of the filter");
  table.real("noise_in_middle_band", noise_in_middle_band, Range{0.0, 1.0}, "",
             "noise: likewise in the middle band (the filter alone has 0.19); benchmark, noise");
  table.real("floor_band_ratio", floor_band_ratio, Range{0.0, 1.0}, "",
             "noise: deviation of a floor without noise, fine over middle band; benchmark, clean");
  table.real(
      "noise_left", noise_left, Range{1e-3, 1e3}, "",
      "noise: the blur leaves this times the floor's deviation in the middle band; benchmark");
  table.real("least_floor", least_floor, Range{1e-6, 255.0}, "grey",
             "noise: least deviation of a floor, against a division by zero");
  table.real("least_blur_px", least_blur_px, Range{0.0, 100.0}, "pixels",
             "noise: a blur below this is left out; it would change next to nothing");
  table.real("most_blur_px", most_blur_px, Range{0.0, 100.0}, "pixels",
             "noise: most blur; more takes the keypoints along; benchmark, noise");
}

void MatchingTuning::describe(OptionTable& table) {
  table.real("size_ratio", size_ratio, Range{1.0, 1e6}, "",
             "keypoint sizes on the floor differ by this factor at most; SIFT finds a keypoint up "
             "to two of an octave's three layers away");
  table.real("turn_tolerance_rad", turn_tolerance_rad, Range{0.0, 3.2}, "rad",
             "a match's orientations turn as the motion does, to this; right matches of the "
             "benchmark: 95 %");
}

void RansacTuning::describe(OptionTable& table) {
  table.integer("redraws", redraws, Range::between(1, 1e6), "",
                "a sample that fixes no heading is drawn again so often; bounds the time alone");
  table.integer("refit_rounds", refit_rounds, Range::between(0, 1e6), "",
                "the best motion is fitted to its inliers again so often at most; a few suffice");
}

void DecisionTuning::describe(OptionTable& table) {
  table.integer("support_rounds", support_rounds, Range::between(0, 1e6), "",
                "a motion is fitted to its support again so often at most; a few suffice");
  table.integer(
      "most_places", most_places, Range::between(1, 1e6), "places",
      "places of the best motion are counted up to here, or as far as its rival's need; more "
      "decide nothing");
  table.real("rival_distance", rival_distance, Range{1.0, 1e6}, "max_error_m",
             "a rival is another motion by at least this; nearer ones share the support of the "
             "best");
  table.real("grid_spacing", grid_spacing, Range::between(1.0, 10.0), "errors",
             "rivals with the heading of the best: their grid; discs of the error cover the plane "
             "up to 1.41");
  table.real("fine_divisor", fine_divisor, Range{1.0, 1e3}, "",
             "support is counted at max_error_m and at this part of it; chance brings together "
             "its square less");
  table.real(
      "rival_share", rival_share, Range{0.0, 1.0}, "places",
      "a rival (repetition, relief, a wrong altitude) has at most this share of the best motion's: "
      "right pairs of simulated ripples reach 0.20, wrong ones of a tiled floor begin at 0.24");
}

void FitTuning::describe(OptionTable& table) {
  table.real("gate", gate, Range{1e-3, 1e6}, "variances",
             "squared error of an inlier of the fit, at most: the 99.6 % quantile of chi squared, "
             "2 degrees of freedom");
  table.integer("rounds", rounds, Range::between(1, 1e6), "",
                "the fit and its inliers are found in turns so often at most; a few suffice");
}

void CovarianceTuning::describe(OptionTable& table) {
  table.real("cluster_px", cluster_px, Range::at_least(0.0), "pixels",
             "side of the squares in which errors may be alike, some keypoints wide; 0: none are");
  table.integer("least_clusters", least_clusters, Range::between(2, 1e6), "",
                "with fewer squares errors count as independent: too few for a variance");
  table.real("shared_error", shared_error, Range::at_least(0.0), "",
             "error that all matches of a pair share, over that of one: NIS 3 over clean pairs and "
             "the moderate conditions of the benchmark, overlaps of 30 to 90 %");
}

void RegistrationTuning::describe(OptionTable& table) {
  table.group("features", features);
  table.group("matching", matching);
  table.group("ransac", ransac);
  table.group("decision", decision);
  table.group("fit", fit);
  table.group("covariance", covariance);
}

}  // namespace fathom
