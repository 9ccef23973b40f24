#include "stored_absolute.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fathom/evaluation/run.hpp"
#include "fathom/results/run_series.hpp"

namespace fathom {
namespace {

// NaN where a series is absent or too short.
class Column {
 public:
  Column(const ResultStore& store, const RunKey& key, const RunSeries<double>& series)
      : values_(series_of(store, key, series).value_or(std::vector<double>())) {}

  double operator[](std::size_t i) const {
    return i < values_.size() ? values_[i] : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  std::vector<double> values_;
};

}  // namespace

std::vector<StoredAbsolute> stored_absolute(const ResultStore& store, const RunKey& key,
                                            std::size_t poses) {
  std::vector<StoredAbsolute> all;
  const auto keyframe = series_of(store, key, series::absolute_keyframe);
  const auto fate = series_of(store, key, series::absolute_fate);
  const auto nis = series_of(store, key, series::absolute_nis);
  if (!keyframe || !fate || !nis) return all;
  const auto column = [&](const RunSeries<double>& series) { return Column(store, key, series); };
  const Column weight = column(series::absolute_weight);
  const Column x = column(series::absolute_x_m);
  const Column y = column(series::absolute_y_m);
  const Column xx = column(series::absolute_cov_xx);
  const Column xy = column(series::absolute_cov_xy);
  const Column yy = column(series::absolute_cov_yy);
  const Column theta = column(series::absolute_theta_rad);
  const Column sigma = column(series::absolute_sigma_rad);
  for (std::size_t i = 0; i < std::min({keyframe->size(), fate->size(), nis->size()}); ++i) {
    if ((*keyframe)[i] >= poses) continue;
    StoredAbsolute one;
    one.fate = (*fate)[i];
    one.weight = weight[i];
    one.nis = (*nis)[i];
    one.mark.pose = (*keyframe)[i];
    one.mark.is_kept = is_kept(one.weight);
    if (std::isfinite(x[i]) && std::isfinite(y[i])) {
      one.mark.measured.position = Eigen::Vector2d(x[i], y[i]);
      one.mark.measured.position_covariance << xx[i], xy[i], xy[i], yy[i];
    }
    if (std::isfinite(theta[i])) {
      one.mark.measured.heading_rad = theta[i];
      one.mark.measured.heading_sigma_rad = sigma[i];
    }
    if (one.mark.measured.position || one.mark.measured.heading_rad) all.push_back(one);
  }
  return all;
}

std::vector<AbsoluteMark> marks_of(const std::vector<StoredAbsolute>& all) {
  std::vector<AbsoluteMark> marks;
  marks.reserve(all.size());
  for (const StoredAbsolute& one : all) marks.push_back(one.mark);
  return marks;
}

}  // namespace fathom
