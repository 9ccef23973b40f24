#include <limits>
#include <span>
#include <utility>

#include <Eigen/Cholesky>

#include "fathom/core/chi_squared.hpp"
#include "fathom/estimation/gate.hpp"

namespace fathom {
namespace {

class Compatibility {
 public:
  Compatibility(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S, double probability,
                std::span<const int> ranks)
      : innovation_(innovation), S_(S), ranks_(ranks), limits_{0.0} {
    for (Eigen::Index m = 1; m <= innovation.size(); ++m) {
      limits_.push_back(chi_squared_quantile(probability, static_cast<double>(m)));
    }
  }

  std::vector<std::size_t> search(const std::vector<std::size_t>& candidates) {
    candidates_ = candidates;
    extend({}, 0.0, 0);
    return best_;
  }

  std::vector<std::size_t> drop_the_worst(std::vector<std::size_t> set) const {
    while (!set.empty() && !(nis(set) <= limit_of(set))) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t worst = 0;
      for (std::size_t i = 0; i < set.size(); ++i) {
        std::vector<std::size_t> rest = set;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        const double without = nis(rest);
        if (without < least) {
          least = without;
          worst = i;
        }
      }
      set.erase(set.begin() + static_cast<std::ptrdiff_t>(worst));
    }
    return set;
  }

 private:
  double nis(const std::vector<std::size_t>& set) const { return joint_nis(innovation_, S_, set); }

  std::size_t rank_of(std::size_t candidate) const {
    return ranks_.empty() ? 3 : static_cast<std::size_t>(ranks_[candidate]);
  }

  double limit_of(std::span<const std::size_t> set, std::span<const std::size_t> more = {}) const {
    std::size_t degrees = 0;
    for (const std::size_t j : set) degrees += rank_of(j);
    for (const std::size_t j : more) degrees += rank_of(j);
    return limits_[degrees];
  }

  // With or without candidate `next`. The joint value only grows with a set, so a branch that could
  // not be compatible, larger, or as large and better, even with all that is left, ends.
  void extend(const std::vector<std::size_t>& set, double value, std::size_t next) {
    const std::size_t most = set.size() + candidates_.size() - next;
    if (most < best_.size()) return;
    if (value > limit_of(set, std::span(candidates_).subspan(next))) return;
    if (most == best_.size() && value >= best_value_) return;
    if (next == candidates_.size()) {
      best_ = set;
      best_value_ = value;
      return;
    }
    std::vector<std::size_t> larger = set;
    larger.push_back(candidates_[next]);
    extend(larger, nis(larger), next + 1);
    extend(set, value, next + 1);
  }

  const Eigen::VectorXd& innovation_;
  const Eigen::MatrixXd& S_;
  std::span<const int> ranks_;
  std::vector<double> limits_;  ///< by degrees of freedom
  std::vector<std::size_t> candidates_;
  std::vector<std::size_t> best_;
  double best_value_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double joint_nis(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                 const std::vector<std::size_t>& chosen) {
  const auto rows = static_cast<Eigen::Index>(3 * chosen.size());
  Eigen::VectorXd nu(rows);
  Eigen::MatrixXd covariance(rows, rows);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto to = static_cast<Eigen::Index>(3 * i);
    const auto from = static_cast<Eigen::Index>(3 * chosen[i]);
    nu.segment<3>(to) = innovation.segment<3>(from);
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      covariance.block<3, 3>(to, static_cast<Eigen::Index>(3 * j)) =
          S.block<3, 3>(from, static_cast<Eigen::Index>(3 * chosen[j]));
    }
  }
  if (rows == 0) return 0.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return nu.dot(llt.solve(nu));
}

std::vector<bool> jointly_compatible(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                                     const std::vector<bool>& candidates, double probability,
                                     std::span<const int> ranks) {
  std::vector<std::size_t> indices;
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    if (candidates[j]) indices.push_back(j);
  }
  Compatibility test(innovation, S, probability, ranks);
  const std::vector<std::size_t> set = indices.size() <= kMostSearched
                                           ? test.search(indices)
                                           : test.drop_the_worst(std::move(indices));
  std::vector<bool> passed(candidates.size(), false);
  for (const std::size_t j : set) passed[j] = true;
  return passed;
}

}  // namespace fathom
