#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace fathom {

/// Squared distances between descriptors of whole numbers from 0 to 255, as SIFT's are, by the
/// processor's products of bytes (AVX-512 VNNI): the same numbers as by floats, which hold them
/// exactly, in less time.
class ByteDistances {
 public:
  /// Nothing where the processor has no such products, or the descriptors other numbers or a length
  /// that is no multiple of four.
  static std::optional<ByteDistances> between(const cv::Mat& from, const cv::Mat& to);

  /// Of `rows` rows of `from`, from `first` on, to all of `to`: row by row `stride` apart.
  void fill(int first, int rows, float* costs, int stride) const;

 private:
  struct Bytes {
    std::vector<std::uint8_t> values;  ///< row by row
    std::vector<std::int32_t> squares;
    std::vector<std::int32_t> sums;
  };

  static std::optional<Bytes> bytes_of(const cv::Mat& descriptors);
  ByteDistances(Bytes from, const Bytes& to, int length, int to_rows);

  int length_;
  int to_rows_;
  Bytes from_;
  std::vector<std::int8_t> to_;  ///< less 128, in the order in which the kernel reads them
  std::vector<std::int32_t> to_squares_;
};

}  // namespace fathom
