#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fathom/core/random.hpp"

namespace fathom::study_errors {

// Of mean 1: normal with a deviation of 0.3, or log-normal.
enum class Shape { normal, skewed, heavy };

inline const char* name_of(Shape shape) {
  switch (shape) {
    case Shape::normal:
      return "normal";
    case Shape::skewed:
      return "log-normal, 0.5";
    case Shape::heavy:
      break;
  }
  return "log-normal, 1";
}

inline double drawn(Shape shape, RandomStream& random) {
  if (shape == Shape::normal) return 1.0 + 0.3 * random.normal();
  const double sigma = shape == Shape::skewed ? 0.5 : 1.0;
  return std::exp(sigma * random.normal() - 0.5 * sigma * sigma);
}

inline double percent(std::size_t part, std::size_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

// Each prints one table, of so many studies a row.
void print_worse(std::size_t repeats, std::uint64_t seed);
void print_equivalent(std::size_t repeats, std::uint64_t seed);
void print_rare(std::size_t repeats, std::uint64_t seed);
void print_coverage(std::size_t repeats, std::uint64_t seed);
void print_cells(std::size_t repeats, std::uint64_t seed);

}  // namespace fathom::study_errors
