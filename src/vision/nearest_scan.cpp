#include "nearest_scan.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "fathom/core/cpu.hpp"

namespace fathom {
namespace {

constexpr float kFurthest = std::numeric_limits<float>::infinity();

// Columns that are looked at side by side, by the vector extension of g++ and clang++: as many as a
// register holds, for more are taken one by one.
struct FourLanes {
  using Floats = float __attribute__((vector_size(16)));
  using Ints = int __attribute__((vector_size(16)));
};
struct EightLanes {
  using Floats = float __attribute__((vector_size(32)));
  using Ints = int __attribute__((vector_size(32)));
};
struct SixteenLanes {
  using Floats = float __attribute__((vector_size(64)));
  using Ints = int __attribute__((vector_size(64)));
};

// The nearest and the next nearest of a row, from those of each lane.
Nearest nearest_of(std::span<const float> cost, std::span<const float> next_cost,
                   std::span<const int> column) {
  Nearest result;
  for (std::size_t lane = 0; lane < cost.size(); ++lane) {
    const bool is_nearer = cost[lane] < result.distance ||
                           (cost[lane] == result.distance && column[lane] < result.row);
    if (is_nearer) {
      result = {column[lane], cost[lane], std::min(result.distance, next_cost[lane])};
    } else {
      result.next_distance = std::min(result.next_distance, cost[lane]);
    }
  }
  return result;
}

// One look at the costs of a row serves both directions. `count` is a multiple of kMostLanes.
template <class Lanes>
[[gnu::always_inline]] inline Nearest scan(int row, const float* costs, std::size_t count,
                                           NearestBack& back) {
  using Floats = typename Lanes::Floats;
  using Ints = typename Lanes::Ints;
  constexpr std::size_t kWidth = sizeof(Floats) / sizeof(float);
  Floats nearest = Floats{} + kFurthest;
  Floats next = nearest;
  Ints nearest_column = Ints{} - 1;
  Ints column{};
  for (std::size_t lane = 0; lane < kWidth; ++lane) column[lane] = static_cast<int>(lane);
  const Ints this_row = Ints{} + row;
  for (std::size_t first = 0; first < count; first += kWidth) {
    Floats cost;
    std::memcpy(&cost, costs + first, sizeof(cost));
    const Ints is_nearer = cost < nearest;
    const Floats passed = is_nearer ? nearest : cost;
    next = passed < next ? passed : next;
    nearest = is_nearer ? cost : nearest;
    nearest_column = is_nearer ? column : nearest_column;
    column += static_cast<int>(kWidth);

    Floats back_cost;
    Ints back_row;
    std::memcpy(&back_cost, back.cost.data() + first, sizeof(back_cost));
    std::memcpy(&back_row, back.row.data() + first, sizeof(back_row));
    const Ints is_nearer_back = cost < back_cost;
    back_cost = is_nearer_back ? cost : back_cost;
    back_row = is_nearer_back ? this_row : back_row;
    std::memcpy(back.cost.data() + first, &back_cost, sizeof(back_cost));
    std::memcpy(back.row.data() + first, &back_row, sizeof(back_row));
  }
  std::array<float, kWidth> costs_of_lanes{};
  std::array<float, kWidth> next_costs{};
  std::array<int, kWidth> columns{};
  std::memcpy(costs_of_lanes.data(), &nearest, sizeof(nearest));
  std::memcpy(next_costs.data(), &next, sizeof(next));
  std::memcpy(columns.data(), &nearest_column, sizeof(nearest_column));
  return nearest_of(costs_of_lanes, next_costs, columns);
}

FATHOM_FOR_AVX2 Nearest scan_by_avx2(int row, const float* costs, std::size_t count,
                                     NearestBack& back) {
  return scan<EightLanes>(row, costs, count, back);
}

FATHOM_FOR_AVX512 Nearest scan_by_avx512(int row, const float* costs, std::size_t count,
                                         NearestBack& back) {
  return scan<SixteenLanes>(row, costs, count, back);
}

}  // namespace

void NearestBack::merge(const NearestBack& other) {
  for (std::size_t column = 0; column < row.size(); ++column) {
    if (other.cost[column] < cost[column] ||
        (other.cost[column] == cost[column] && other.row[column] < row[column])) {
      cost[column] = other.cost[column];
      row[column] = other.row[column];
    }
  }
}

Nearest scan_row(int row, const float* costs, std::size_t count, NearestBack& back) {
  if (has_avx512()) return scan_by_avx512(row, costs, count, back);
  if (has_avx2()) return scan_by_avx2(row, costs, count, back);
  return scan<FourLanes>(row, costs, count, back);
}

}  // namespace fathom
