#include "fathom/report/match_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include <opencv2/imgproc.hpp>

#include "bgr.hpp"
#include "fathom/report/palette.hpp"
#include "picture_canvas.hpp"
#include "text_layout.hpp"

namespace fathom {
namespace {

constexpr Colour kInlierColour = palette::sky_blue;
constexpr Colour kOutlierColour = palette::orange;
constexpr int kGapPx = 12;
constexpr int kMarginPx = 14;
constexpr int kTopPx = 64;  ///< of the pictures; a caption and their names stand above
constexpr double kCaptionPx = 22.0;
constexpr double kNamePx = 16.0;
constexpr std::size_t kMostLines = 90;

double gain_of(const cv::Mat& a, const cv::Mat& b) {
  const cv::Scalar mean = 0.5 * (cv::mean(a) + cv::mean(b));
  constexpr double kMean = 120.0;
  return std::clamp(kMean / std::max(1.0, mean[1]), 1.0, 3.0);
}

/// Two pictures side by side at one scale, and the way from their pixels to the canvas.
class Pair {
 public:
  Pair(const cv::Mat& a, const cv::Mat& b) {
    constexpr double kWidest = 800.0;
    constexpr double kHighest = 900.0;
    scale_ =
        std::min({1.0, kWidest / std::max(a.cols, b.cols), kHighest / std::max(a.rows, b.rows)});
    cv::resize(a, a_, {}, scale_, scale_, cv::INTER_AREA);
    cv::resize(b, b_, {}, scale_, scale_, cv::INTER_AREA);
    const double gain = gain_of(a_, b_);
    a_ *= gain;
    b_ *= gain;
  }

  int width_px() const { return a_.cols + kGapPx + b_.cols; }
  int height_px() const { return std::max(a_.rows, b_.rows); }

  /// Both on white.
  cv::Mat side_by_side() const {
    cv::Mat page(kTopPx + height_px() + kMarginPx, width_px() + 2 * kMarginPx, CV_8UC3,
                 cv::Scalar::all(255));
    a_.copyTo(page(cv::Rect({kMarginPx, kTopPx}, a_.size())));
    b_.copyTo(page(cv::Rect({left_b(), kTopPx}, b_.size())));
    return page;
  }

  void draw_names(Canvas& canvas, const MatchPicture& picture) const {
    const auto name = [&](const std::string& text, int left, int width) {
      canvas.text(shortened(text, kNamePx, width), {double(left), kTopPx - 10.0},
                  {.size = kNamePx});
    };
    name("A  " + picture.name_a, kMarginPx, a_.cols);
    name("B  " + picture.name_b, left_b(), b_.cols);
  }

  // Pixels are at their centres.
  Eigen::Vector2d in_a(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d half(0.5, 0.5);
    return scale_ * (pixel + half) - half + Eigen::Vector2d(kMarginPx, kTopPx);
  }
  Eigen::Vector2d in_b(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d half(0.5, 0.5);
    return scale_ * (pixel + half) - half + Eigen::Vector2d(left_b(), kTopPx);
  }

 private:
  int left_b() const { return kMarginPx + a_.cols + kGapPx; }

  double scale_ = 1.0;
  cv::Mat a_;
  cv::Mat b_;
};

/// The matches that agree, and the others, both in their order.
struct Sorted {
  std::vector<PixelPair> inliers;
  std::vector<PixelPair> others;
};

Sorted sorted(const MatchPicture& picture) {
  const auto ends = [](const PixelPair& pair) {
    return std::array{pair.a.x(), pair.a.y(), pair.b.x(), pair.b.y()};
  };
  std::set<std::array<double, 4>> inliers;
  for (const PixelPair& pair : picture.inliers) inliers.insert(ends(pair));
  Sorted sorted;
  for (const PixelPair& match : picture.matches) {
    (inliers.contains(ends(match)) ? sorted.inliers : sorted.others).push_back(match);
  }
  return sorted;
}

// As many of the matches as may be, one for each cell of a net over A, finer until it suffices.
std::vector<PixelPair> spread(const MatchPicture& picture, const std::vector<PixelPair>& among,
                              std::size_t most) {
  if (among.size() <= most) return among;
  std::vector<PixelPair> chosen;
  for (int cells = 1; cells <= 64; ++cells) {
    std::set<std::pair<int, int>> taken;
    std::vector<PixelPair> next;
    for (const PixelPair& match : among) {
      const double cell_px = std::max(picture.a.cols, picture.a.rows) / static_cast<double>(cells);
      const std::pair<int, int> cell(static_cast<int>(match.a.x() / cell_px),
                                     static_cast<int>(match.a.y() / cell_px));
      if (taken.insert(cell).second) next.push_back(match);
    }
    if (next.size() > most) break;
    chosen = std::move(next);
  }
  return chosen;
}

struct Marks {
  std::vector<PixelPair> matches;
  std::size_t most_lines = 0;
  bool agree = false;
};

// Returns how many lines there are.
std::size_t draw(Canvas& canvas, const Pair& pair, const MatchPicture& picture,
                 const Marks& marks) {
  const Colour colour = marks.agree ? kInlierColour : kOutlierColour;
  const std::vector<PixelPair> joined = spread(picture, marks.matches, marks.most_lines);
  for (const PixelPair& match : joined) {
    canvas.line(pair.in_a(match.a), pair.in_b(match.b), {colour, 1.0, {}, 1.0});
  }
  for (const PixelPair& match : marks.matches) {
    for (const Eigen::Vector2d& at : {pair.in_a(match.a), pair.in_b(match.b)}) {
      if (marks.agree) canvas.disc(at, 2.5, colour);
      if (!marks.agree) canvas.ring(at, 3.5, {colour, 1.0, {}, 1.0});
    }
  }
  return joined.size();
}

// Lines go to both kinds by their numbers, to the rarer one a third; what one kind cannot use, the
// other one may.
std::size_t lines_of_inliers(std::size_t inliers, std::size_t others) {
  const std::size_t all = std::max<std::size_t>(1, inliers + others);
  const std::size_t third = kMostLines / 3;
  const std::size_t share = std::clamp(kMostLines * inliers / all, third, kMostLines - third);
  return std::min(inliers, kMostLines - std::min(others, kMostLines - share));
}

std::string count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " match" : " matches");
}

std::string lines_text(std::size_t lines, std::size_t matches) {
  return lines < matches ? ", " + std::to_string(lines) + " joined by lines" : "";
}

void draw_caption(Canvas& canvas, const Pair& pair, const std::string& caption) {
  const double size = kCaptionPx * std::min(1.0, pair.width_px() / text_width(caption, kCaptionPx));
  canvas.text(caption, {kMarginPx, 26}, {.size = size});
}

}  // namespace

cv::Mat render_raw_matches(const MatchPicture& picture) {
  const Pair pair(as_bgr(picture.a), as_bgr(picture.b));
  const Sorted matches = sorted(picture);
  const std::size_t all = picture.matches.size();
  const std::size_t most = lines_of_inliers(matches.inliers.size(), matches.others.size());
  return drawn_over(pair.side_by_side(), [&](Canvas& canvas) {
    pair.draw_names(canvas, picture);
    std::size_t lines = draw(canvas, pair, picture, {matches.inliers, most, true});
    lines += draw(canvas, pair, picture, {matches.others, kMostLines - lines, false});
    std::string caption = "Before RANSAC: " + count_text(all) + lines_text(lines, all);
    if (all > 0) {
      caption += fmt::format(".  {} agree (blue), {} do not (orange)", matches.inliers.size(),
                             matches.others.size());
    }
    draw_caption(canvas, pair, caption);
  });
}

cv::Mat render_accepted_matches(const MatchPicture& picture) {
  const Pair pair(as_bgr(picture.a), as_bgr(picture.b));
  const std::vector<PixelPair>& inliers = picture.inliers;
  return drawn_over(pair.side_by_side(), [&](Canvas& canvas) {
    pair.draw_names(canvas, picture);
    const std::size_t lines = draw(canvas, pair, picture, {inliers, kMostLines, true});
    const std::string found = count_text(inliers.size()) + lines_text(lines, inliers.size());
    const std::string shown = inliers.empty() ? "none to show" : "the best supported " + found;
    draw_caption(canvas, pair,
                 picture.not_found.empty() ? "After RANSAC: " + found
                                           : "Not found: " + picture.not_found + "; " + shown);
  });
}

}  // namespace fathom
