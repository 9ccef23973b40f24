#include "fathom/vision/ransac.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "pair_ransac.hpp"
#include "rigid_motion.hpp"

namespace fathom {
namespace {

using PointList = std::vector<Eigen::Vector2d>;

// Root mean square distance from the centre: how well the points fix a heading.
double spread(const PointList& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  double square = 0.0;
  for (const Eigen::Vector2d& point : points) square += (point - mean).squaredNorm();
  return std::sqrt(square / static_cast<double>(points.size()));
}

// One run over one set of pairs; the steps of the header by their numbers.
class Ransac {
 public:
  Ransac(const PointPairs& pairs, const RansacOptions& options, const RansacTuning& tuning,
         std::uint64_t seed)
      : pairs_(pairs),
        options_(options),
        tuning_(tuning),
        max_error_m_(options.max_error_on_floor(0.0)),
        random_(seed) {}

  // The figure accepts a motion with more than β inliers; `min_inliers` itself is enough here.
  Consensus run() {
    Consensus best;
    if (pairs_.size() < static_cast<std::size_t>(options_.sample_size)) return best;
    double needed = options_.iterations;
    for (int i = 0; i < needed; ++i) {
      const std::optional<Pose> trial = fit_sample();  // 1
      if (!trial) continue;
      const int support = pairs_.count_inliers(*trial, max_error_m_);  // 2
      most_inliers_ = std::max(most_inliers_, support);
      if (support < options_.min_inliers || cannot_win(support, best)) continue;  // 3
      std::vector<int> inliers = pairs_.inliers(*trial, max_error_m_);
      if (inliers == best.inliers) continue;  // the same fit again
      if (!has_enough_places(inliers)) continue;
      Consensus fitted = fit(std::move(inliers));  // 4
      if (fitted.motion && (!best.motion || is_better(fitted, best)))
        best = std::move(fitted);  // 5
      needed = std::min(needed, iterations_for(best));
    }
    if (best.motion && options_.score == RansacScore::inliers) refit(best);
    best.most_inliers = std::max(most_inliers_, static_cast<int>(best.inliers.size()));
    best.most_places = most_places_;
    return best;
  }

 private:
  // After so many, a sample of inliers alone was drawn with the wanted confidence.
  double iterations_for(const Consensus& best) const {
    if (options_.score == RansacScore::paper || !best.motion) return options_.iterations;
    const double share =
        static_cast<double>(best.inliers.size()) / static_cast<double>(pairs_.size());
    const double all_inliers = std::pow(share, options_.sample_size);
    if (all_inliers >= 1.0) return 1.0;
    return std::log1p(-options_.confidence) / std::log1p(-all_inliers);
  }

  // `sample_size` different pairs, uniformly (Floyd's algorithm).
  void draw_sample() {
    sample_.clear();
    const std::size_t size = static_cast<std::size_t>(options_.sample_size);
    for (std::size_t last = pairs_.size() - size; last < pairs_.size(); ++last) {
      const int drawn = static_cast<int>(random_.index(last + 1));
      const bool taken = std::ranges::find(sample_, drawn) != sample_.end();
      sample_.push_back(taken ? static_cast<int>(last) : drawn);
    }
  }

  std::optional<Pose> fit_sample() {
    for (int redraw = 0; redraw < tuning_.redraws; ++redraw) {
      draw_sample();
      // What cannot agree as a whole is no sample of right matches: not worth a fit.
      if (sample_.size() == 2 && !pairs_.fit_together(sample_[0], sample_[1], max_error_m_)) {
        return std::nullopt;
      }
      gather(sample_);
      if (spread(from_) > max_error_m_ && spread(to_) > max_error_m_) {
        return find_motion(from_, to_);
      }
    }
    return std::nullopt;
  }

  bool has_enough_places(const std::vector<int>& inliers) {
    const int places = pairs_.count_places(inliers, max_error_m_, options_.min_places);
    most_places_ = std::max(most_places_, places);
    return places >= options_.min_places;
  }

  Consensus fit(std::vector<int> inliers) {
    gather(inliers);
    Consensus fitted;
    fitted.motion = find_motion(from_, to_);
    if (!fitted.motion) return fitted;
    fitted.rms_m =
        std::sqrt(squared_error(*fitted.motion, from_, to_) / static_cast<double>(inliers.size()));
    fitted.inliers = std::move(inliers);
    return fitted;
  }

  // Known before the fit where the number of inliers decides.
  bool cannot_win(int support, const Consensus& best) const {
    return options_.score == RansacScore::inliers &&
           support < static_cast<int>(best.inliers.size());
  }

  bool is_better(const Consensus& a, const Consensus& b) const {
    if (options_.score == RansacScore::paper) return epsilon(a) < epsilon(b);
    if (a.inliers.size() != b.inliers.size()) return a.inliers.size() > b.inliers.size();
    return a.rms_m < b.rms_m;
  }

  // The figure's ε: the sum of the squared errors of the inliers.
  static double epsilon(const Consensus& consensus) {
    return consensus.rms_m * consensus.rms_m * static_cast<double>(consensus.inliers.size());
  }

  void refit(Consensus& best) {
    for (int round = 0; round < tuning_.refit_rounds; ++round) {
      std::vector<int> inliers = pairs_.inliers(*best.motion, max_error_m_);
      if (inliers == best.inliers || inliers.size() < best.inliers.size()) return;
      if (!has_enough_places(inliers)) return;
      Consensus fitted = fit(std::move(inliers));
      if (!fitted.motion) return;
      best = std::move(fitted);
    }
  }

  void gather(const std::vector<int>& indices) {
    from_.clear();
    to_.clear();
    for (const int index : indices) {
      from_.push_back(pairs_.p(index));
      to_.push_back(pairs_.q(index));
    }
  }

  const PointPairs& pairs_;
  const RansacOptions& options_;
  const RansacTuning& tuning_;
  double max_error_m_;
  RandomStream random_;
  int most_inliers_ = 0;
  int most_places_ = 0;
  std::vector<int> sample_;
  PointList from_;  // of the pairs last gathered
  PointList to_;
};

}  // namespace

void RansacOptions::describe(OptionTable& table) {
  table.integer("iterations", iterations, Range::between(1, 1e7), "",
                "samples drawn per pair, at most");
  table.real("confidence", confidence, Range{0.5, 1.0}, "",
             "end once a sample of inliers alone was drawn with this probability; 1 is off");
  table.integer("sample_size", sample_size, Range::between(2, 100), "matches",
                "matches in a sample (the paper's N)");
  table.real("max_error_px", max_error_px, Range::positive(), "pixels",
             "a match agrees with a motion within so many pixels of the coarser picture");
  table.real_or_off("max_error_m", max_error_m, Range::positive(), "m",
                    "or within this distance on the floor, whatever the altitude");
  table.integer("min_inliers", min_inliers, Range::at_least(3), "matches",
                "with fewer that agree, no motion is found");
  table.integer("min_places", min_places, Range::between(1, 1000), "places",
                "nor with those that agree in fewer places, further apart than the largest error");
  table.enumeration(
      "score", score, {{"inliers", RansacScore::inliers}, {"paper", RansacScore::paper}},
      "keep most inliers, then least RMS; or, as the paper, the least sum of squared errors");
}

double RansacOptions::max_error_on_floor(double metres_per_pixel) const {
  const double error_m = max_error_m.value_or(max_error_px * metres_per_pixel);
  if (error_m > 0.0 && std::isfinite(error_m)) return error_m;
  throw InputError(
      "ransac.max_error_px: without pictures and their altitudes it is no distance; "
      "expected ransac.max_error_m");
}

Consensus ransac(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q,
                 const RansacOptions& options, std::uint64_t seed, const RansacTuning& tuning) {
  return ransac(PointPairs(p, q), options, seed, tuning);
}

Consensus ransac(const PointPairs& pairs, const RansacOptions& options, std::uint64_t seed,
                 const RansacTuning& tuning) {
  return Ransac(pairs, options, tuning, seed).run();
}

}  // namespace fathom
