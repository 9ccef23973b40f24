#include "fathom/measurements/spoil.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>

#include <Eigen/Cholesky>

#include "fathom/core/random.hpp"

namespace fathom {
namespace {

constexpr int kMostDraws = 10'000;

std::vector<std::pair<std::string, FalseLoopKind>> kind_names() {
  return {{"random", FalseLoopKind::random},
          {"local", FalseLoopKind::local},
          {"grouped", FalseLoopKind::grouped}};
}

class Spoiler {
 public:
  Spoiler(const MeasurementLog& log, std::span<const Pose> reference, const SpoilOptions& options,
          RandomStream random)
      : reference_(reference), options_(options), random_(random) {
    for (std::size_t k = 1; k < log.size(); ++k) {
      for (const RelativePose& z : log.arrival(k).registrations) templates_.push_back(z.forward());
    }
  }

  std::vector<RelativePose> draw(std::size_t count) {
    if (count > 0 && templates_.empty()) {
      throw InputError("the log has no loop whose motion and information a false one could take");
    }
    const bool is_grouped = options_.kind == FalseLoopKind::grouped;
    const auto group = static_cast<std::size_t>(is_grouped ? options_.group_size : 1);
    std::vector<RelativePose> loops;
    while (loops.size() < count) {
      const std::vector<RelativePose> next = draw_group(std::min(group, count - loops.size()));
      loops.insert(loops.end(), next.begin(), next.end());
    }
    return loops;
  }

 private:
  // Loops of neighbours with neighbours, drawn again until all of them are false enough.
  std::vector<RelativePose> draw_group(std::size_t count) {
    bool has_fitted = false;
    for (int tries = 0; tries < kMostDraws; ++tries) {
      const RelativePose first = draw_one();
      if (first.from == first.to || first.from + count > first.to) continue;
      if (first.to + count > reference_.size()) continue;
      has_fitted = true;
      std::vector<RelativePose> group{first};
      while (group.size() < count) group.push_back(neighbour(first, group.size()));
      if (std::all_of(group.begin(), group.end(),
                      [this](const RelativePose& z) { return is_false_enough(z); })) {
        return group;
      }
    }
    if (!has_fitted) refuse_place(count);
    throw InputError(fmt::format(
        "the keyframes lie so close together that no false loop could be off by {:f} m or {:f} rad",
        options_.min_offset_m, options_.min_offset_rad));
  }

  [[noreturn]] void refuse_place(std::size_t count) const {
    const std::size_t n = reference_.size();
    if (count == 1) {
      throw InputError(fmt::format(
          "local false loops join keyframes that are two apart or more, and the log has {}", n));
    }
    throw InputError(
        fmt::format("groups of {} false loops do not fit into a log of {} keyframes, "
                    "or hardly anywhere; expected a group size of at most {}",
                    count, n, std::max<std::size_t>(1, n / 4)));
  }

  RelativePose draw_one() {
    RelativePose z = templates_[random_.index(templates_.size())];
    const std::size_t n = reference_.size();
    const std::size_t a = random_.index(n);
    std::size_t b = random_.index(n);
    if (options_.kind == FalseLoopKind::local) {
      const std::size_t reach = std::min(static_cast<std::size_t>(options_.reach), n - 1);
      b = reach < 2 ? n : a + 2 + random_.index(reach - 1);
      if (b >= n) b = a;  // drawn again
    }
    z.from = std::min(a, b);
    z.to = std::max(a, b);
    z.shared = nullptr;  // other pictures' errors, and keypoints
    z.repeats = 1.0;
    return z;
  }

  // What `first` says of the keyframes `steps` later, with noise of its own.
  RelativePose neighbour(const RelativePose& first, std::size_t steps) {
    RelativePose z = templates_[random_.index(templates_.size())];
    z.from = first.from + steps;
    z.to = first.to + steps;
    z.shared = nullptr;
    z.repeats = 1.0;
    const Pose back = between(reference_[z.from], reference_[first.from]);
    const Pose on = between(reference_[first.to], reference_[z.to]);
    const Eigen::LLT<Eigen::Matrix3d> information(z.information);
    const Eigen::Vector3d white(random_.normal(), random_.normal(), random_.normal());
    const Eigen::Vector3d noise = information.matrixU().solve(white);
    z.motion = compose(compose(compose(back, first.motion), on), Pose::from_vector(noise));
    return z;
  }

  bool is_false_enough(const RelativePose& z) const {
    const Eigen::Vector3d e = residual(z.motion, reference_[z.from], reference_[z.to]);
    return e.head<2>().norm() >= options_.min_offset_m ||
           std::abs(e.z()) >= options_.min_offset_rad;
  }

  std::span<const Pose> reference_;
  SpoilOptions options_;
  RandomStream random_;
  std::vector<RelativePose> templates_;
};

}  // namespace

void SpoilOptions::describe(OptionTable& table) {
  table.real("share", share, Range::between(0.0, 0.9), "",
             "false loops as a share of all loops, right ones included; 0: none");
  table.enumeration<FalseLoopKind>("kind", kind, kind_names(),
                                   "false loops between any two keyframes, near ones, or in groups "
                                   "that agree with each other");
  table.integer("group_size", group_size, Range::between(1, 1000), "loops",
                "grouped: loops of a group");
  table.integer("reach", reach, Range::between(2, 1e6), "keyframes",
                "local: the two keyframes are at most so far apart");
}

std::string name_of(FalseLoopKind kind) {
  for (const auto& [name, value] : kind_names()) {
    if (value == kind) return name;
  }
  return "random";
}

Spoiled spoil(const MeasurementLog& log, std::span<const Pose> reference,
              const SpoilOptions& options, std::uint64_t seed, std::uint64_t trial) {
  assert(reference.size() == log.size());
  const auto right = static_cast<double>(log.registration_count());
  const auto count =
      static_cast<std::size_t>(std::llround(options.share / (1.0 - options.share) * right));
  Spoiler spoiler(log, reference, options, RandomStream(seed, "false_loops", trial));
  std::vector<std::vector<RelativePose>> false_loops(log.size());
  for (const RelativePose& z : spoiler.draw(count)) {
    const RelativePose& step = log.arrival(z.to).step;
    // A reader of g2o takes the first edge from k − 1 to k for the step, before one from k to k
    // − 1.
    const bool is_along_reversed_step = z.from == step.to && z.to == step.from;
    false_loops[z.to].push_back(is_along_reversed_step ? z.reversed() : z);
  }
  Spoiled spoiled{MeasurementLog(log.start()), {}};
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) spoiled.log.add_keyframe(arrival.step);
    for (const AbsolutePose& z : arrival.absolute) spoiled.log.add_absolute(z);
    for (const RelativePose& z : arrival.registrations) spoiled.log.add_registration(z);
    for (const RelativePose& z : false_loops[k]) spoiled.log.add_registration(z);
    spoiled.is_false.insert(spoiled.is_false.end(), arrival.registrations.size(), false);
    spoiled.is_false.insert(spoiled.is_false.end(), false_loops[k].size(), true);
  }
  spoiled.log.ids = log.ids;
  spoiled.log.guess = log.guess;
  return spoiled;
}

}  // namespace fathom
