#include "fathom/vision/matching.hpp"

#include <algorithm>
#include <cblas.h>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>

#include <opencv2/core.hpp>

namespace fathom {
namespace {

// Rows of `from` compared at a time: the block of costs then stays in the second-level cache.
constexpr int kBlockRows = 64;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A cost is the squared Euclidean distance, or the number of differing bits.
struct Nearest {
  int row = -1;
  float cost = kInfinity;
  float next_cost = kInfinity;
};

// The nearest row of `from` for each row of `to`, among the rows of `from` seen so far.
struct NearestBack {
  std::vector<int> row;
  std::vector<float> cost;

  explicit NearestBack(int to_rows)
      : row(static_cast<std::size_t>(to_rows), -1),
        cost(static_cast<std::size_t>(to_rows), kInfinity) {}

  // Of equal costs the lower row: the result does not depend on the order of merging.
  void merge(const NearestBack& other) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (other.cost[column] < cost[column] ||
          (other.cost[column] == cost[column] && other.row[column] < row[column])) {
        cost[column] = other.cost[column];
        row[column] = other.row[column];
      }
    }
  }
};

struct Neighbours {
  std::vector<Nearest> in_to;  // of each row of `from`
  NearestBack in_from;         // of each row of `to`
};

// One look at the costs of a row serves both directions.
Nearest scan_row(int row, std::span<const float> costs, NearestBack& back) {
  Nearest nearest;
  for (std::size_t column = 0; column < costs.size(); ++column) {
    const float cost = costs[column];
    if (cost < nearest.next_cost) {
      if (cost < nearest.cost) {
        nearest = {static_cast<int>(column), cost, nearest.cost};
      } else {
        nearest.next_cost = cost;
      }
    }
    if (cost < back.cost[column]) {
      back.cost[column] = cost;
      back.row[column] = row;
    }
  }
  return nearest;
}

// `costs_of(first, rows, block)` fills a block, rows × to_rows, with the costs of rows of `from`.
template <class Costs>
Neighbours find_neighbours(int from_rows, int to_rows, const Costs& costs_of) {
  Neighbours found{std::vector<Nearest>(static_cast<std::size_t>(from_rows)), NearestBack(to_rows)};
  std::mutex merging;
  const auto compare_blocks = [&](const cv::Range& blocks) {
    const std::size_t columns = static_cast<std::size_t>(to_rows);
    std::vector<float> block(kBlockRows * columns);
    NearestBack back(to_rows);
    for (int first = blocks.start * kBlockRows;
         first < std::min(blocks.end * kBlockRows, from_rows); first += kBlockRows) {
      const int rows = std::min(kBlockRows, from_rows - first);
      costs_of(first, rows, block.data());
      for (int row = 0; row < rows; ++row) {
        const float* costs = block.data() + static_cast<std::size_t>(row) * columns;
        found.in_to[static_cast<std::size_t>(first) + static_cast<std::size_t>(row)] =
            scan_row(first + row, {costs, columns}, back);
      }
    }
    const std::lock_guard lock(merging);
    found.in_from.merge(back);
  };
  cv::parallel_for_({0, (from_rows + kBlockRows - 1) / kBlockRows}, compare_blocks);
  return found;
}

std::vector<float> squared_norms(const cv::Mat& descriptors) {
  std::vector<float> norms;
  for (int row = 0; row < descriptors.rows; ++row) {
    const float* values = descriptors.ptr<float>(row);
    norms.push_back(cblas_sdot(descriptors.cols, values, 1, values, 1));
  }
  return norms;
}

// ‖a‖² + ‖b‖² − 2 a·b, all products in one matrix product per block. SIFT's whole numbers up to 255
// keep every sum below 2²⁴, so that the squared distances are exact.
Neighbours euclidean_neighbours(const cv::Mat& from, const cv::Mat& to) {
  const std::vector<float> from_norms = squared_norms(from);
  const std::vector<float> to_norms = squared_norms(to);
  return find_neighbours(from.rows, to.rows, [&](int first, int rows, float* block) {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, to.rows, from.cols, -2.0F,
                from.ptr<float>(first), static_cast<int>(from.step1()), to.ptr<float>(),
                static_cast<int>(to.step1()), 0.0F, block, to.rows);
    for (int row = 0; row < rows; ++row) {
      const float from_norm =
          from_norms[static_cast<std::size_t>(first) + static_cast<std::size_t>(row)];
      for (const float to_norm : to_norms) *block++ += from_norm + to_norm;
    }
  });
}

Neighbours hamming_neighbours(const cv::Mat& from, const cv::Mat& to) {
  return find_neighbours(from.rows, to.rows, [&](int first, int rows, float* block) {
    cv::Mat bits;
    cv::batchDistance(from.rowRange(first, first + rows), to, bits, CV_32S, cv::noArray(),
                      cv::NORM_HAMMING);
    bits.convertTo(cv::Mat(rows, to.rows, CV_32F, block), CV_32F);
  });
}

void require_same_kind(const cv::Mat& from, const cv::Mat& to) {
  const bool known = from.type() == CV_32F || from.type() == CV_8U;
  if (!known || from.type() != to.type() || from.cols != to.cols) {
    throw InputError("descriptors must be of one kind to be matched, got " +
                     std::to_string(from.cols) + " x " + cv::typeToString(from.type()) + " and " +
                     std::to_string(to.cols) + " x " + cv::typeToString(to.type()));
  }
}

bool is_distinct(float distance, float next_distance, double ratio) {
  if (ratio >= 1.0) return true;
  return next_distance < kInfinity && distance < ratio * next_distance;
}

}  // namespace

void MatchingOptions::describe(OptionTable& table) {
  table.real("ratio", ratio, {0.0, 1.0, true}, "",
             "a match is this much nearer than the second nearest; 1 is off");
  table.boolean("mutual", mutual, "a match is nearest both ways");
}

std::vector<Match> match(const Features& from, const Features& to, const MatchingOptions& options) {
  std::vector<Match> matches;
  const cv::Mat& a = from.descriptors;
  const cv::Mat& b = to.descriptors;
  if (a.empty() || b.empty()) return matches;
  require_same_kind(a, b);

  const bool euclidean = a.type() == CV_32F;
  const Neighbours neighbours = euclidean ? euclidean_neighbours(a, b) : hamming_neighbours(a, b);
  // Rounding may leave a square just below zero.
  const auto distance_of = [euclidean](float cost) {
    return euclidean ? std::sqrt(std::max(cost, 0.0F)) : cost;
  };
  for (int row = 0; row < a.rows; ++row) {
    const Nearest& nearest = neighbours.in_to[static_cast<std::size_t>(row)];
    if (nearest.row < 0) continue;
    const float distance = distance_of(nearest.cost);
    if (!is_distinct(distance, distance_of(nearest.next_cost), options.ratio)) continue;
    if (options.mutual && neighbours.in_from.row[static_cast<std::size_t>(nearest.row)] != row)
      continue;
    matches.push_back({row, nearest.row, distance});
  }
  return matches;
}

}  // namespace fathom
