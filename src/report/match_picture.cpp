#include "fathom/report/match_picture.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "bgr.hpp"
#include "canvas.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/report/palette.hpp"

namespace fathom {
namespace {

constexpr Colour kInlierColour = palette::sky_blue;
constexpr Colour kOutlierColour = palette::orange;
constexpr int kGapPx = 12;
constexpr int kMarginPx = 14;
constexpr double kCaptionPx = 44.0;
constexpr double kCaptionHeight = 16.0;

/// Two pictures side by side at one scale, and the way from their pixels to the canvas.
class Pair {
 public:
  Pair(const cv::Mat& a, const cv::Mat& b) {
    constexpr double kWidest = 800.0;
    constexpr double kHighest = 700.0;
    scale_ =
        std::min({1.0, kWidest / std::max(a.cols, b.cols), kHighest / std::max(a.rows, b.rows)});
    cv::resize(as_bgr(a), a_, {}, scale_, scale_, cv::INTER_AREA);
    cv::resize(as_bgr(b), b_, {}, scale_, scale_, cv::INTER_AREA);
  }

  int width_px() const { return a_.cols + kGapPx + b_.cols; }
  int height_px() const { return std::max(a_.rows, b_.rows); }

  void draw(Canvas& canvas, double top_px) const {
    canvas.image(a_, {kMarginPx, top_px});
    canvas.image(b_, {double(kMarginPx + a_.cols + kGapPx), top_px});
  }

  void draw_match(Canvas& canvas, double top_px, const PixelPair& match, Colour colour) const {
    const Eigen::Vector2d half(0.5, 0.5);  // pixels are at their centres
    const Eigen::Vector2d a = scale_ * (match.a + half) - half + Eigen::Vector2d(kMarginPx, top_px);
    const Eigen::Vector2d b =
        scale_ * (match.b + half) - half + Eigen::Vector2d(kMarginPx + a_.cols + kGapPx, top_px);
    canvas.line({a, b}, {colour, 1.0});
    canvas.ring(a, 3.0, {colour, 1.0});
    canvas.ring(b, 3.0, {colour, 1.0});
  }

 private:
  double scale_ = 1.0;
  cv::Mat a_;
  cv::Mat b_;
};

std::vector<bool> inlier_flags(const MatchPicture& picture) {
  std::vector<bool> flags(picture.matches.size(), false);
  for (const std::size_t i : picture.inliers) {
    if (i >= flags.size()) {
      throw InputError("inlier " + std::to_string(i) + " is none of the " +
                       std::to_string(flags.size()) + " matches");
    }
    flags[i] = true;
  }
  return flags;
}

std::string count_text(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

cv::Mat render(const MatchPicture& picture) {
  const Pair pair(as_bgr(picture.a), as_bgr(picture.b));
  const std::vector<bool> is_inlier = inlier_flags(picture);
  const auto inliers =
      static_cast<std::size_t>(std::count(is_inlier.begin(), is_inlier.end(), true));
  const double row_px = kCaptionPx + pair.height_px();
  Canvas canvas(pair.width_px() + 2 * kMarginPx, static_cast<int>(2 * row_px) + kMarginPx);

  const double before_top = kCaptionPx;
  const double after_top = row_px + kCaptionPx;
  pair.draw(canvas, before_top);
  pair.draw(canvas, after_top);
  for (const bool wanted : {false, true}) {  // inliers over the others
    for (std::size_t i = 0; i < picture.matches.size(); ++i) {
      if (is_inlier[i] != wanted) continue;
      const Colour colour = wanted ? kInlierColour : kOutlierColour;
      pair.draw_match(canvas, before_top, picture.matches[i], colour);
      if (wanted) pair.draw_match(canvas, after_top, picture.matches[i], colour);
    }
  }
  const std::string names = picture.name_a.empty() && picture.name_b.empty()
                                ? ""
                                : picture.name_a + "  |  " + picture.name_b + "  |  ";
  const std::string before =
      names + "before RANSAC: " + count_text(picture.matches.size(), "match", "matches") +
      " (refused in orange)";
  canvas.text(before, {kMarginPx, before_top - 14},
              Canvas::fitting_height_px(before, kCaptionHeight, pair.width_px()));
  canvas.text(inliers == 0 ? "after RANSAC: not found"
                           : "after RANSAC: " + count_text(inliers, "inlier", "inliers"),
              {kMarginPx, after_top - 14}, kCaptionHeight);
  return canvas.finish();
}

}  // namespace fathom
