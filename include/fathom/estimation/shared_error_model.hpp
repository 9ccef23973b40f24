#pragma once

#include "fathom/core/options.hpp"

namespace fathom {

/// What an estimator makes of errors that registrations of one picture share
/// (docs/shared_errors.md).
enum class SharedErrorModel {
  states,      ///< n of each picture is estimated beside its pose
  consider,    ///< poses as if registrations were independent, their covariance with what is shared
  independent  ///< as if registrations were independent
};

struct SharedErrorOptions {
  SharedErrorModel model = SharedErrorModel::states;

  void describe(OptionTable& table);
};

}  // namespace fathom
