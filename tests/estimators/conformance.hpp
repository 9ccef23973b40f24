#pragma once

#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/estimators/logs.hpp"

namespace fathom::test {

/// What every estimator of the registry must do, whatever its method: the parameter is its name.
class Conformance : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Estimator> make(const StartPose& start = {},
                                  const EstimatorValues& values = {}) const {
    return builtin_estimators().find(GetParam()).create({start}, values);
  }

  /// `none`, and every robust loss of the estimator.
  static std::vector<std::string> losses() {
    for (const OptionDescription& option : builtin_estimators().find(GetParam()).options) {
      if (option.key != "loss") continue;
      std::vector<std::string> all;
      std::istringstream choices(option.range);
      for (std::string word; choices >> word;) {
        if (word != "|") all.push_back(word);
      }
      return all;
    }
    return {"none"};
  }
};

}  // namespace fathom::test
