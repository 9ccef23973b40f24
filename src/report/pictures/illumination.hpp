#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "decoded_pictures.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom {

/// The factors by which each picture of a mosaic is to be multiplied: CV_32F of a picture's size.
/// Learnt from up to 40 of the pictures that are laid. Throws InputError where one cannot be read.
cv::Mat learnt_gain(const Camera& camera, DecodedPictures& decoded,
                    const std::vector<PlacedPicture>& pictures);

/// Pictures with the illumination taken out, CV_32F. Memory: one, or 64 MiB of them.
class LitPictures {
 public:
  /// `decoded` must outlive this.
  LitPictures(DecodedPictures& decoded, cv::Mat gain) : decoded_(decoded), gain_(std::move(gain)) {}

  using Use = std::function<void(std::size_t frame, const cv::Mat& picture)>;

  /// Of these frames in turn, some made side by side, and `beside` called for each on the thread
  /// that made it. A picture is gone when `take` returns. Throws InputError where one cannot be
  /// read.
  void for_each(std::span<const std::size_t> frames, const Use& take, const Use& beside = {});

 private:
  DecodedPictures& decoded_;
  cv::Mat gain_;
  std::vector<cv::Mat> lit_;  ///< kept: new memory costs more than what is done with it
};

}  // namespace fathom
