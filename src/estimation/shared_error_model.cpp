#include "fathom/estimation/shared_error_model.hpp"

namespace fathom {

void SharedErrorOptions::describe(OptionTable& table, const std::string& note) {
  table.enumeration("shared_errors", model,
                    {{"states", SharedErrorModel::states},
                     {"consider", SharedErrorModel::consider},
                     {"independent", SharedErrorModel::independent}},
                    "errors that a picture's registrations share: estimated, in the covariance "
                    "alone, or left out" +
                        note);
}

}  // namespace fathom
