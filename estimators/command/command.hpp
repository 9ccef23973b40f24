#pragma once

#include <memory>
#include <string>
#include <vector>

#include "estimators/command/program_graph.hpp"
#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace fathom {
namespace command {
class Solver;
}

struct CommandOptions {
  std::string command;
  int solves = 1;
  /// Keys of every estimator, of no use here: the program has options of its own.
  int max_iterations = 100;
  double tolerance = 1e-6;
  GateOptions gate;

  void describe(OptionTable& table);
  /// Throws InputError where there is no program of this name, or the command names but one of its
  /// files, or a gate is on.
  void check(const EstimatorSetup& setup) const;
};

/// The estimate of another program (docs/estimators/command.md). It has no covariance. Failure of
/// the program is thrown: nothing can go on without it.
class CommandEstimator final : public RelativeEstimator {
 public:
  CommandEstimator(const EstimatorSetup& setup, const CommandOptions& options);
  ~CommandEstimator() override;

  void add_keyframe(const RelativePose& step) override;
  UpdateReport close_loops(std::span<const RelativePose> loops) override;
  UpdateReport finish(std::span<const Pose> start) override;
  std::optional<Eigen::MatrixXd> joint_covariance(std::span<const std::size_t>) const override {
    return std::nullopt;
  }
  std::size_t size() const override { return graph_.poses.size(); }
  Pose pose(std::size_t k) const override { return graph_.poses[k]; }

 private:
  void solve();

  SolveMode mode_;
  std::unique_ptr<command::Solver> solver_;
  command::ProgramGraph graph_;
};

EstimatorEntry command_entry();

}  // namespace fathom
