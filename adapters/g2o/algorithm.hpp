#pragma once

#include <g2o/core/block_solver.h>
#include <g2o/core/optimization_algorithm_with_hessian.h>
#include <memory>

#include "adapters/support/graph_adapter.hpp"

namespace fathom::g2o_adapter {

enum class Method { gauss_newton, levenberg_marquardt, dogleg, slam2d_linear };

struct Options {
  Method method = Method::gauss_newton;
  int max_iterations = 100;
  double tolerance = 1e-6;  ///< the gain that the program g2o ends at
  GateOptions gate;

  void describe(OptionTable& table);
  void check(const EstimatorSetup& setup) const { check_gate(gate, setup, true); }
};

using Algorithm = g2o::OptimizationAlgorithmWithHessian;
using BlockSolver = g2o::BlockSolverPL<3, 3>;

/// With CHOLMOD.
std::unique_ptr<Algorithm> make_algorithm(Method method);

}  // namespace fathom::g2o_adapter
