#include "byte_distances.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "fathom/core/cpu.hpp"

namespace fathom {
namespace {

constexpr int kLanes = 16;                 // columns of one register
constexpr int kVectors = 4;                // registers side by side
constexpr int kGroup = kLanes * kVectors;  // columns of a group
constexpr int kTogether = 4;               // bytes of one lane
constexpr int kRows = 4;                   // rows of a tile

int groups_of(int rows) {
  return (rows + kGroup - 1) / kGroup;
}

// Where the first four bytes of a row stand; the next four are kStep further, and so on.
constexpr std::size_t kStep = 64;
std::size_t place_of(int row, int length) {
  const int vector = row / kLanes;
  const int lane = row % kLanes;
  return static_cast<std::size_t>(vector) * static_cast<std::size_t>(length / kTogether) * kStep +
         static_cast<std::size_t>(lane * kTogether);
}

// Costs of `rows` rows (kRows at most) to one group of columns: with b′ = b − 128,
// ‖a − b‖² = ‖a‖² − 256 Σa + ‖b‖² − 2 Σ a b′.
struct Tile {
  const std::uint8_t* from;     ///< of the first row
  const std::int32_t* squares;  ///< of the rows
  const std::int32_t* sums;
  const std::int8_t* to;  ///< of the group
  const std::int32_t* to_squares;
  int length;
  int columns;  ///< of the group that there are
};

template <int Rows>
FATHOM_FOR_AVX512_VNNI void fill_tile(const Tile& tile, float* costs, int stride) {
  using Floats = float __attribute__((vector_size(64)));
  SixteenInts sums[Rows][kVectors] = {};
  const int steps = tile.length / kTogether;
  for (int k = 0; k < steps; ++k) {
    SixteenInts columns[kVectors];
    for (int v = 0; v < kVectors; ++v) {
      const std::size_t place = (static_cast<std::size_t>(v) * static_cast<std::size_t>(steps) +
                                 static_cast<std::size_t>(k)) *
                                kStep;
      std::memcpy(&columns[v], tile.to + place, kStep);
    }
    for (int r = 0; r < Rows; ++r) {
      int four = 0;
      std::memcpy(&four,
                  tile.from + static_cast<std::ptrdiff_t>(r) * tile.length +
                      static_cast<std::ptrdiff_t>(k) * kTogether,
                  sizeof(four));
      const SixteenInts row = SixteenInts{} + four;
      for (int v = 0; v < kVectors; ++v) add_byte_products(sums[r][v], row, columns[v]);
    }
  }
  for (int r = 0; r < Rows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(v) * kLanes;
      SixteenInts squares;
      std::memcpy(&squares, tile.to_squares + first, sizeof(squares));
      const Floats cost = __builtin_convertvector(
          squares + (tile.squares[r] - 256 * tile.sums[r]) - 2 * sums[r][v], Floats);
      const int left = std::clamp(tile.columns - v * kLanes, 0, kLanes);
      std::memcpy(costs + static_cast<std::ptrdiff_t>(r) * stride + first, &cost,
                  static_cast<std::size_t>(left) * sizeof(float));
    }
  }
}

}  // namespace

std::optional<ByteDistances::Bytes> ByteDistances::bytes_of(const cv::Mat& descriptors) {
  Bytes bytes;
  const auto length = static_cast<std::size_t>(descriptors.cols);
  bytes.values.resize(static_cast<std::size_t>(descriptors.rows) * length);
  for (int row = 0; row < descriptors.rows; ++row) {
    const float* values = descriptors.ptr<float>(row);
    std::uint8_t* out = bytes.values.data() + static_cast<std::size_t>(row) * length;
    std::int32_t square = 0;
    std::int32_t sum = 0;
    std::size_t whole_ones = 0;
    for (std::size_t i = 0; i < length; ++i) {
      const float value = values[i];
      const bool is_in_range = (value >= 0.0F) & (value <= 255.0F);  // false of NaN
      const auto whole = static_cast<std::int32_t>(is_in_range ? value : 0.0F);
      whole_ones += static_cast<float>(whole) == value ? 1 : 0;
      out[i] = static_cast<std::uint8_t>(whole);
      square += whole * whole;
      sum += whole;
    }
    if (whole_ones != length) return std::nullopt;
    bytes.squares.push_back(square);
    bytes.sums.push_back(sum);
  }
  return bytes;
}

std::optional<ByteDistances> ByteDistances::between(const cv::Mat& from, const cv::Mat& to) {
  if (!has_avx512_vnni() || from.cols % kTogether != 0) return std::nullopt;
  std::optional<Bytes> a = bytes_of(from);
  const std::optional<Bytes> b = a ? bytes_of(to) : std::nullopt;
  if (!b) return std::nullopt;
  return ByteDistances(std::move(*a), *b, to.cols, to.rows);
}

ByteDistances::ByteDistances(Bytes from, const Bytes& to, int length, int to_rows)
    : length_(length), to_rows_(to_rows), from_(std::move(from)) {
  const auto padded = static_cast<std::size_t>(groups_of(to_rows)) * kGroup;
  to_.resize(padded * static_cast<std::size_t>(length), 0);
  to_squares_.assign(padded, 0);
  std::ranges::copy(to.squares, to_squares_.begin());
  const std::uint8_t* values = to.values.data();
  for (int row = 0; row < to_rows; ++row) {
    std::int8_t* out = to_.data() + place_of(row, length);
    for (int i = 0; i < length; i += kTogether, values += kTogether, out += kStep) {
      std::uint32_t four = 0;
      std::memcpy(&four, values, sizeof(four));
      four ^= 0x80808080U;  // less 128, each
      std::memcpy(out, &four, sizeof(four));
    }
  }
}

void ByteDistances::fill(int first, int rows, float* costs, int stride) const {
  for (int group = 0; group < groups_of(to_rows_); ++group) {
    const auto column = static_cast<std::size_t>(group) * kGroup;
    for (int r = 0; r < rows; r += kRows) {
      const auto row = static_cast<std::size_t>(first) + static_cast<std::size_t>(r);
      const Tile tile{from_.values.data() + row * static_cast<std::size_t>(length_),
                      from_.squares.data() + row,
                      from_.sums.data() + row,
                      to_.data() + column * static_cast<std::size_t>(length_),
                      to_squares_.data() + column,
                      length_,
                      std::min(kGroup, to_rows_ - group * kGroup)};
      float* out = costs + static_cast<std::ptrdiff_t>(r) * stride + column;
      switch (std::min(kRows, rows - r)) {
        case 4:
          fill_tile<4>(tile, out, stride);
          break;
        case 3:
          fill_tile<3>(tile, out, stride);
          break;
        case 2:
          fill_tile<2>(tile, out, stride);
          break;
        default:
          fill_tile<1>(tile, out, stride);
      }
    }
  }
}

}  // namespace fathom
