#pragma once

#include <string>

#include "fathom/core/options.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom {

/// Whether a run has a process of its own, which a crash ends in place of the program.
enum class Isolation {
  automatic,  ///< what is not built in has one
  process,    ///< every estimator has one
  none
};

struct IsolationOptions {
  Isolation isolation = Isolation::automatic;
  double time_limit_s = 3600.0;
  int memory_limit_mib = 4096;

  void describe(OptionTable& table);
  bool is_isolated(const EstimatorEntry& entry) const;
};

/// Whether a key is one of these options.
bool is_isolation_key(const std::string& key);

}  // namespace fathom
