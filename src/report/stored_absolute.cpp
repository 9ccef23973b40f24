#include "stored_absolute.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace fathom {
namespace {

// A series by the measurements of a run; NaN where it is absent or too short.
class Column {
 public:
  Column(const ResultStore& store, const RunKey& key, const std::string& name)
      : values_(store.series(key, "absolute_" + name).value_or(std::vector<double>())) {}

  double operator[](std::size_t i) const {
    return i < values_.size() ? values_[i] : std::numeric_limits<double>::quiet_NaN();
  }
  std::size_t size() const { return values_.size(); }

 private:
  std::vector<double> values_;
};

}  // namespace

std::vector<StoredAbsolute> stored_absolute(const ResultStore& store, const RunKey& key,
                                            std::size_t poses) {
  const auto column = [&](const char* name) { return Column(store, key, name); };
  const Column keyframe = column("keyframe");
  std::vector<StoredAbsolute> all;
  if (keyframe.size() == 0) return all;
  const Column fate = column("fate");
  const Column weight = column("weight");
  const Column nis = column("nis");
  const Column x = column("x_m");
  const Column y = column("y_m");
  const Column xx = column("cov_xx");
  const Column xy = column("cov_xy");
  const Column yy = column("cov_yy");
  const Column theta = column("theta_rad");
  const Column sigma = column("sigma_rad");
  for (std::size_t i = 0; i < keyframe.size(); ++i) {
    if (!(keyframe[i] >= 0.0 && keyframe[i] < static_cast<double>(poses))) continue;
    if (!(fate[i] >= 0.0 && fate[i] < 3.0)) continue;
    StoredAbsolute one;
    one.fate = static_cast<std::size_t>(fate[i]);
    one.weight = weight[i];
    if (nis[i] >= 0.0) one.nis = nis[i];
    one.mark.pose = static_cast<std::size_t>(keyframe[i]);
    one.mark.is_kept = one.weight > 0.5;
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
