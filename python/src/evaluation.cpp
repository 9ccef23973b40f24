// Accuracy, consistency, statistics over trials.

#include <fmt/format.h>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/paired.hpp"
#include "fathom/evaluation/proportion.hpp"
#include "fathom/evaluation/statistics.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/statistics.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

Alignment alignment_of(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [word, alignment] : alignment_names()) {
    if (word == name) return alignment;
    known.push_back(word);
  }
  throw InputError("alignment: " + not_one_of(name, known));
}

// Else accuracy would be absent without a word.
void require_finite_poses(const std::vector<Pose>& poses, const std::string& of) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (is_finite(poses[k])) continue;
    throw InputError(fmt::format(
        "pose {} of the {} is not finite; expected x, y (m) and theta (rad), or leave it out of "
        "both",
        k, of));
  }
}

// The ANEES is of all but the first, whose covariance is zero where the start is known.
void require_definite(const std::vector<Eigen::Matrix3d>& covariances) {
  for (std::size_t k = 0; k < covariances.size(); ++k) {
    const Eigen::Matrix3d& C = covariances[k];
    if (k == 0 ? is_positive_semidefinite(C) : is_positive_definite(C)) continue;
    throw InputError(fmt::format(
        "covariance {} is not positive definite; expected variances > 0 and correlations between "
        "-1 and 1{}",
        k, k == 0 ? ", or all zero of a start that is known" : ""));
  }
}

py::dict evaluate_poses(const py::object& estimate, const py::object& reference,
                        const std::string& alignment, const py::object& covariances) {
  const std::vector<Pose> ours = poses_of(estimate, "estimate");
  const std::vector<Pose> theirs = poses_of(reference, "reference");
  const Alignment how = alignment_of(alignment);
  require_finite_poses(ours, "estimate");
  require_finite_poses(theirs, "reference");
  py::dict row;
  if (const auto judged = accuracy(ours, theirs, how)) {
    row["mean_position_error_m"] = judged->mean_position_error_m;
    row["ate_rmse_m"] = judged->ate_rmse_m;
    row["max_position_error_m"] = judged->max_position_error_m;
    row["final_position_error_m"] = judged->final_position_error_m;
    row["heading_rmse_rad"] = judged->heading_rmse_rad;
    row["motion_reference_estimate"] = array_of(judged->motion_reference_estimate);
  }
  if (covariances.is_none()) return row;
  // An alignment to the reference would take away part of what the covariances speak of.
  const Alignment of_start = how == Alignment::se2 ? Alignment::origin : how;
  const auto matrices = symmetric_matrices_of(covariances, "covariances");
  require_definite(matrices);
  const auto honest = consistency(ours, theirs, matrices, of_start);
  if (!honest) return row;
  row["anees"] = honest->anees;
  row["position_anees"] = honest->position_anees;
  row["share_inside_2_sigma"] = honest->share_inside_2_sigma;
  row["pose_nees"] = array_of(honest->pose_nees);
  return row;
}

// A call without the interpreter's lock.
template <class Call>
auto unlocked(Call call) {
  const py::gil_scoped_release released;
  return call();
}

py::object moments_of(const py::object& values) {
  const auto found = moments(values_of(values, "values"));
  if (!found) return py::none();
  return py::dict(py::arg("count") = found->count, py::arg("mean") = found->mean,
                  py::arg("standard_deviation") = found->standard_deviation,
                  py::arg("median") = found->median, py::arg("min") = found->min,
                  py::arg("max") = found->max);
}

py::object difference_of(const py::object& a, const py::object& b, double probability,
                         std::uint64_t seed) {
  BootstrapOptions options;
  options.probability = probability;
  options.seed = seed;
  const std::vector<double> values_a = values_of(a, "a");
  const std::vector<double> values_b = values_of(b, "b");
  return dict_of(unlocked([&] { return paired_difference(values_a, values_b, options); }));
}

void bind_statistics(py::module_& module) {
  module.def("moments", &moments_of, py::arg("values"),
             "Count, mean, standard_deviation (n - 1), median, min, max; None of no values.");
  module.def(
      "bootstrap_interval",
      [](const py::object& values, double probability, std::size_t resamples, std::uint64_t seed) {
        const std::vector<double> all = values_of(values, "values");
        return pair_of(unlocked([&] {
          return bootstrap_interval(all, {probability, resamples, seed});
        }));
      },
      py::arg("values"), py::arg("probability") = 0.95, py::arg("resamples") = 2000,
      py::arg("seed") = 1,
      "(low, high) of the mean of independent values, BCa (Efron 1987); None of fewer than two. "
      "Of a study Results.interval knows the surveys.");
  module.def("paired_difference", &difference_of, py::arg("a"), py::arg("b"),
             py::arg("probability") = 0.95, py::arg("seed") = 1,
             "Of a - b over the same trials, which are independent draws: count, mean, its "
             "bootstrap interval, and the p-value of Wilcoxon's signed-rank test. Of a study "
             "Results.difference knows the surveys.");
  module.def(
      "holm", [](const py::object& p) { return array_of(holm(values_of(p, "p_values"))); },
      py::arg("p_values"), "Holm's step-down adjustment (1979) of a family of p-values.");
  module.def(
      "anees_interval",
      [](std::size_t trials, std::size_t degrees, double probability) {
        return pair_of(anees_interval(trials, degrees, probability));
      },
      py::arg("trials"), py::arg("degrees_of_freedom") = 3, py::arg("probability") = 0.95,
      "(low, high) that holds the ANEES over independent trials if covariances are right.");
  module.def(
      "wilson_interval",
      [](std::size_t successes, std::size_t count, double probability) {
        return pair_of(wilson_interval(successes, count, probability));
      },
      py::arg("successes"), py::arg("count"), py::arg("probability") = 0.95,
      "(low, high) of a proportion (Wilson 1927).");
}

// Seconds would be as good as none.
std::vector<std::int64_t> times_of(const py::object& given) {
  const py::array array = py::array::ensure(given);
  if (!array) PyErr_Clear();
  const bool is_whole =
      array && array.ndim() == 1 && (array.size() == 0 || array.dtype().kind() == 'i');
  if (!is_whole) throw InputError("times_ns: expected whole nanoseconds, an array of int64");
  return given.cast<std::vector<std::int64_t>>();
}

// What read_tum would refuse.
void require_readable(const std::vector<std::int64_t>& times_ns, const std::vector<Pose>& poses,
                      std::size_t k) {
  if (!is_finite(poses[k])) {
    throw InputError(fmt::format("trajectory[{}]: expected finite numbers", k));
  }
  if (k == 0 || times_ns[k] > times_ns[k - 1]) return;
  throw InputError(fmt::format("times_ns[{}]: expected more than the {} ns before it, got {} ns", k,
                               times_ns[k - 1], times_ns[k]));
}

}  // namespace

py::object pair_of(const std::optional<Interval>& interval) {
  if (!interval) return py::none();
  return py::make_tuple(interval->low, interval->high);
}

py::object dict_of(const std::optional<PairedDifference>& difference) {
  if (!difference) return py::none();
  return py::dict(py::arg("count") = difference->count, py::arg("mean") = difference->mean,
                  py::arg("interval") = pair_of(difference->interval),
                  py::arg("p_value") = difference->signed_rank.p_value,
                  py::arg("exact") = difference->signed_rank.exact);
}

void bind_evaluation(py::module_& module) {
  module.def("_evaluate", &evaluate_poses);
  bind_statistics(module);
  module.def("_read_tum", [](const std::string& path) {
    std::vector<std::int64_t> times;
    std::vector<Pose> poses;
    for (const StampedPose& one : unlocked([&] { return read_tum(path); })) {
      times.push_back(one.time_ns);
      poses.push_back(one.pose);
    }
    return py::make_tuple(array_of(times), array_of(poses));
  });
  module.def("_write_tum",
             [](const std::string& path, const py::object& times_ns, const py::object& trajectory) {
               const std::vector<std::int64_t> times = times_of(times_ns);
               const std::vector<Pose> poses = poses_of(trajectory, "trajectory");
               if (times.size() != poses.size())
                 throw InputError("times_ns: as many as poses are needed");
               std::vector<StampedPose> stamped;
               for (std::size_t k = 0; k < poses.size(); ++k) {
                 require_readable(times, poses, k);
                 stamped.push_back({times[k], poses[k]});
               }
               unlocked([&] { write_file(path, to_tum(stamped)); });
             });
}

}  // namespace fathom
