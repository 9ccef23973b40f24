#pragma once

#include <string>

#include "fathom/core/options.hpp"

namespace fathom {

/// What an estimator makes of errors that registrations of one picture share
/// (docs/shared_errors.md).
enum class SharedErrorModel {
  states,      ///< n of each picture is estimated beside its pose
  consider,    ///< n is not estimated, but known to be there: the covariance has it, and gains of
               ///< filters weigh by it (Schmidt 1966)
  independent  ///< as if registrations were independent
};

struct SharedErrorOptions {
  SharedErrorModel model = SharedErrorModel::states;

  /// Of a graph: states or independent.
  void describe(OptionTable& table);
  /// Of a filter, all three; `note`: what else the help says.
  void describe_of_filter(OptionTable& table, const std::string& note = {});
};

}  // namespace fathom
