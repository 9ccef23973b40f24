#include "fathom/vision/matching.hpp"

#include <algorithm>
#include <cblas.h>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <mutex>

#include <opencv2/core.hpp>

#include "byte_distances.hpp"
#include "fathom/core/blas_memory.hpp"
#include "nearest_scan.hpp"

namespace fathom {
namespace {

// Rows of `from` compared at a time: the block of costs then stays in the second-level cache.
constexpr int kBlockRows = 128;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// `costs_of(first, rows, block, stride)` fills the first `to_rows` columns of a block, row by row
// `stride` apart, with the costs of rows of `from`.
template <class Costs>
NearestRows find_by_cost(int from_rows, int to_rows, const Costs& costs_of) {
  NearestRows found;
  found.in_to.resize(static_cast<std::size_t>(from_rows));
  found.in_from.reserve(static_cast<std::size_t>(to_rows));
  NearestBack in_from(to_rows);
  std::mutex merging;
  const auto compare_blocks = [&](const cv::Range& blocks) {
    // Columns beyond the last are never nearest.
    const std::size_t stride =
        (static_cast<std::size_t>(to_rows) + kMostLanes - 1) / kMostLanes * kMostLanes;
    std::vector<float> block(kBlockRows * stride, kInfinity);
    NearestBack back(static_cast<int>(stride));
    for (int first = blocks.start * kBlockRows;
         first < std::min(blocks.end * kBlockRows, from_rows); first += kBlockRows) {
      const int rows = std::min(kBlockRows, from_rows - first);
      costs_of(first, rows, block.data(), static_cast<int>(stride));
      for (int row = 0; row < rows; ++row) {
        const float* costs = block.data() + static_cast<std::size_t>(row) * stride;
        found.in_to[static_cast<std::size_t>(first) + static_cast<std::size_t>(row)] =
            scan_row(first + row, costs, stride, back);
      }
    }
    const std::lock_guard lock(merging);
    in_from.merge(back);
  };
  cv::parallel_for_({0, (from_rows + kBlockRows - 1) / kBlockRows}, compare_blocks);
  for (std::size_t column = 0; column < static_cast<std::size_t>(to_rows); ++column) {
    found.in_from.push_back({in_from.row[column], in_from.cost[column], kInfinity});
  }
  return found;
}

// Rows (−2a, ‖a‖², 1) of `from` or (b, 1, ‖b‖²) of `to`: their products are squared distances.
enum class Side { from, to };
cv::Mat_<float> with_norms(const cv::Mat& descriptors, Side side) {
  const int length = descriptors.cols;
  cv::Mat_<float> rows(descriptors.rows, length + 2);
  const float factor = side == Side::from ? -2.0F : 1.0F;
  for (int row = 0; row < descriptors.rows; ++row) {
    const float* values = descriptors.ptr<float>(row);
    float* out = rows[row];
    for (int i = 0; i < length; ++i) out[i] = factor * values[i];
    const float norm = cblas_sdot(length, values, 1, values, 1);
    out[length] = side == Side::from ? norm : 1.0F;
    out[length + 1] = side == Side::from ? 1.0F : norm;
  }
  return rows;
}

// ‖a‖² + ‖b‖² − 2 a·b, all in one matrix product per block. SIFT's whole numbers up to 255 keep
// every sum below 2²⁴, so that the squared distances are exact.
NearestRows find_by_product(const cv::Mat& from, const cv::Mat& to) {
  const cv::Mat_<float> a = with_norms(from, Side::from);
  const cv::Mat_<float> b = with_norms(to, Side::to);
  return find_by_cost(from.rows, to.rows, [&](int first, int rows, float* block, int stride) {
    const BlasMemory memory;
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, b.rows, a.cols, 1.0F, a[first],
                static_cast<int>(a.step1()), b[0], static_cast<int>(b.step1()), 0.0F, block,
                stride);
  });
}

NearestRows find_euclidean(const cv::Mat& from, const cv::Mat& to) {
  const auto bytes = ByteDistances::between(from, to);
  NearestRows found = bytes ? find_by_cost(from.rows, to.rows,
                                           [&](int first, int rows, float* block, int stride) {
                                             bytes->fill(first, rows, block, stride);
                                           })
                            : find_by_product(from, to);
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
  return find_by_cost(from.rows, to.rows, [&](int first, int rows, float* block, int stride) {
    cv::Mat bits;
    cv::batchDistance(from.rowRange(first, first + rows), to, bits, CV_32S, cv::noArray(),
                      cv::NORM_HAMMING);
    cv::Mat costs(rows, to.rows, CV_32F, block, static_cast<std::size_t>(stride) * sizeof(float));
    bits.convertTo(costs, CV_32F);
  });
}

void require_same_kind(const cv::Mat& from, const cv::Mat& to) {
  const bool known = from.type() == CV_32F || from.type() == CV_8U;
  if (!known || from.type() != to.type() || from.cols != to.cols) {
    throw InputError(fmt::format(
        "descriptors must be of one kind to be matched, got {} x {} and {} x {}", from.cols,
        cv::typeToString(from.type()), to.cols, cv::typeToString(to.type())));
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
