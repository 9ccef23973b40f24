#include "fathom/estimation/shared_error_model.hpp"

namespace fathom {

void SharedErrorOptions::describe(OptionTable& table) {
  table.enumeration(
      "shared_errors", model,
      {{"states", SharedErrorModel::states}, {"independent", SharedErrorModel::independent}},
      "errors that a picture's registrations share: estimated, or left out");
}

void SharedErrorOptions::describe_of_filter(OptionTable& table, const std::string& note) {
  table.enumeration("shared_errors", model,
                    {{"states", SharedErrorModel::states},
                     {"consider", SharedErrorModel::consider},
                     {"independent", SharedErrorModel::independent}},
                    "errors that a picture's registrations share: estimated, considered in gains "
                    "and covariance, or left out" +
                        note);
}

}  // namespace fathom
