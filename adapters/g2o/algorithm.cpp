#include "adapters/g2o/algorithm.hpp"

#include <g2o/core/optimization_algorithm_dogleg.h>
#include <g2o/core/optimization_algorithm_gauss_newton.h>
#include <g2o/core/optimization_algorithm_levenberg.h>
#include <g2o/solvers/cholmod/linear_solver_cholmod.h>
#include <g2o/solvers/slam2d_linear/solver_slam2d_linear.h>
#include <string>
#include <utility>
#include <vector>

namespace fathom::g2o_adapter {
namespace {

const std::vector<std::pair<std::string, Method>>& method_names() {
  static const std::vector<std::pair<std::string, Method>> names{
      {"gauss_newton", Method::gauss_newton},
      {"levenberg_marquardt", Method::levenberg_marquardt},
      {"dogleg", Method::dogleg},
      {"slam2d_linear", Method::slam2d_linear}};
  return names;
}

}  // namespace

void Options::describe(OptionTable& table) {
  table.enumeration("method", method, method_names(),
                    "slam2d_linear: Gauss-Newton from headings that are solved for first");
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "iterations of one solve at most");
  table.real("tolerance", tolerance, Range::positive(), "",
             "g2o's gain: a solve ends when an iteration lowers F by a smaller share");
  gate.describe(table);
}

std::unique_ptr<Algorithm> make_algorithm(Method method) {
  auto linear = std::make_unique<g2o::LinearSolverCholmod<BlockSolver::PoseMatrixType>>();
  linear->setBlockOrdering(true);
  auto solver = std::make_unique<BlockSolver>(std::move(linear));
  switch (method) {
    case Method::gauss_newton:
      break;
    case Method::levenberg_marquardt:
      return std::make_unique<g2o::OptimizationAlgorithmLevenberg>(std::move(solver));
    case Method::dogleg:
      return std::make_unique<g2o::OptimizationAlgorithmDogleg>(std::move(solver));
    case Method::slam2d_linear:
      return std::make_unique<g2o::SolverSLAM2DLinear>(std::move(solver));
  }
  return std::make_unique<g2o::OptimizationAlgorithmGaussNewton>(std::move(solver));
}

}  // namespace fathom::g2o_adapter
