#pragma once

#include <optional>
#include <pybind11/pybind11.h>

#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/paired.hpp"

namespace fathom {

/// (low, high), or None.
pybind11::object pair_of(const std::optional<Interval>& interval);

/// count, mean, interval, p_value, exact; None of no difference.
pybind11::object dict_of(const std::optional<PairedDifference>& difference);

}  // namespace fathom
