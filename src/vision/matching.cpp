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

// A cost is the squared Euclidean distance, or the number of differing bits. While rows are compared
// Nearest holds costs; they become distances at the end.

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

// One look at the costs of a row serves both directions.
Nearest scan_row(int row, std::span<const float> costs, NearestBack& back) {
  Nearest nearest;
  for (std::size_t column = 0; column < costs.size(); ++column) {
    const float cost = costs[column];
    if (cost < nearest.next_distance) {
      if (cost < nearest.distance) {
        nearest = {static_cast<int>(column), cost, nearest.distance};
      } else {
        nearest.next_distance = cost;
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
NearestRows find_by_cost(int from_rows, int to_rows, const Costs& costs_of) {
  NearestRows found;
  found.in_to.resize(static_cast<std::size_t>(from_rows));
  NearestBack in_from(to_rows);
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
    in_from.merge(back);
  };
  cv::parallel_for_({0, (from_rows + kBlockRows - 1) / kBlockRows}, compare_blocks);
  for (std::size_t column = 0; column < in_from.row.size(); ++column) {
    found.in_from.push_back({in_from.row[column], in_from.cost[column], kInfinity});
  }
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
NearestRows find_euclidean(const cv::Mat& from, const cv::Mat& to) {
  const std::vector<float> from_norms = squared_norms(from);
  const std::vector<float> to_norms = squared_norms(to);
  NearestRows found = find_by_cost(from.rows, to.rows, [&](int first, int rows, float* block) {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, to.rows, from.cols, -2.0F,
                from.ptr<float>(first), static_cast<int>(from.step1()), to.ptr<float>(),
                static_cast<int>(to.step1()), 0.0F, block, to.rows);
    for (int row = 0; row < rows; ++row) {
      const float from_norm =
          from_norms[static_cast<std::size_t>(first) + static_cast<std::size_t>(row)];
      for (const float to_norm : to_norms) *block++ += from_norm + to_norm;
    }
  });
  // Rounding may leave a square just below zero.
  const auto distance_of = [](float square) { return std::sqrt(std::max(square, 0.0F)); };
  for (std::vector<Nearest>* side : {&found.in_to, &found.in_from}) {
    for (Nearest& nearest : *side) {
      nearest.distance = distance_of(nearest.distance);
      nearest.next_distance = distance_of(nearest.next_distance);
    }
  }
  return found;
}

NearestRows find_hamming(const cv::Mat& from, const cv::Mat& to) {
  return find_by_cost(from.rows, to.rows, [&](int first, int rows, float* block) {
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

NearestRows find_nearest(const Features& from, const Features& to) {
  const cv::Mat& a = from.descriptors;
  const cv::Mat& b = to.descriptors;
  if (a.empty() || b.empty()) {
    return {std::vector<Nearest>(from.size()), std::vector<Nearest>(to.size())};
  }
  require_same_kind(a, b);
  return a.type() == CV_32F ? find_euclidean(a, b) : find_hamming(a, b);
}

std::vector<Match> match(const NearestRows& nearest, const MatchingOptions& options) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < nearest.in_to.size(); ++i) {
    const int row = static_cast<int>(i);
    const Nearest& to = nearest.in_to[i];
    if (to.row < 0 || !is_distinct(to.distance, to.next_distance, options.ratio)) continue;
    if (options.mutual && nearest.in_from[static_cast<std::size_t>(to.row)].row != row) continue;
    matches.push_back({row, to.row, to.distance});
  }
  return matches;
}

std::vector<Match> match(const Features& from, const Features& to, const MatchingOptions& options) {
  return match(find_nearest(from, to), options);
}

std::vector<Match> all_nearest(const NearestRows& nearest) {
  std::vector<Match> matches = match(nearest, {1.0, false});
  for (std::size_t j = 0; j < nearest.in_from.size(); ++j) {
    const Nearest& from = nearest.in_from[j];
    if (from.row < 0) continue;
    const bool known = nearest.in_to[static_cast<std::size_t>(from.row)].row == static_cast<int>(j);
    if (!known) matches.push_back({from.row, static_cast<int>(j), from.distance});
  }
  return matches;
}

}  // namespace fathom
