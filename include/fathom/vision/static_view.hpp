#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fathom {

/// When a place of the picture counts as one that keeps its content. Chosen on simulated floors, on
/// real pictures from a kite, and on both with a bar, text and spots drawn in
/// (docs/front_end.md).
struct StaticViewOptions {
  int longest_side_px = 640;   ///< larger pictures are reduced by a whole factor
  double window_px = 7.0;      ///< of the flattening, as FeatureTuning::window_px
  double least_deviation = 2;  ///< greys: less texture counts as less, not as much noise
  int correlation_px = 7;      ///< of a square about a pixel, from its middle to its border
  double least_correlation = 0.5;
  double possible_correlation = 0.35;  ///< of half the pictures, for may_have_static_view()
  /// Two pictures that agree so much are of one place, and one of them is left out. Where more
  /// than this share of the picture keeps its content, nothing can be told either.
  double most_agreement = 0.6;
  /// The rest of the picture must change: its correlation is at most this. Where it is more the
  /// vehicle was at rest for most of the pictures.
  double most_correlation_elsewhere = 0.1;
  int least_pictures = 6;     ///< of different places
  int speck_px = 5;           ///< narrower ones are chance
  int gap_px = 15;            ///< narrower ones, as between letters, are closed
  double least_area = 200.0;  ///< pixels of a part
};

/// Which part of all pictures of a camera keeps its content while the camera moves.
struct StaticView {
  cv::Mat mask;         ///< CV_8U: 0 where it does, 255 elsewhere; empty: nowhere
  bool is_told = true;  ///< false: the pictures are too few, or too much alike, to tell
};

/// A picture as find_static_view() takes it: reduced, and flattened as features are, so that light
/// that falls off towards the corners or moves with the vehicle is gone. `gray`: 8-bit.
cv::Mat detail_of_view(const cv::Mat& gray, const StaticViewOptions& options = {});

/// By the correlation of all pictures with each other at every place, zero-mean and normalised:
/// with d_i a picture's detail, Σ over a window of ((Σ d_i)² − Σ d_i²) over (n − 1) Σ d_i², the
/// intraclass correlation. `details` are of pictures of `size`, spread over a survey; few of one
/// place.
StaticView find_static_view(std::span<const cv::Mat> details, cv::Size size,
                            const StaticViewOptions& options = {});

/// Whether it is worth to look at more pictures: false where none of these few has a place that
/// could be found. Said of less than find_static_view() needs.
bool may_have_static_view(std::span<const cv::Mat> details, const StaticViewOptions& options = {});

/// The share of the picture that is masked.
double masked_share(const cv::Mat& mask);

/// Where: "the lowest 12 %", "the uppermost 9 %, 3 other parts".
std::string masked_where(const cv::Mat& mask);

}  // namespace fathom
