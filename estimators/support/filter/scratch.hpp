#pragma once

#include <vector>

#include <Eigen/Core>

namespace fathom::filter {

/// Room for a matrix that is needed again and again, a little larger each time. Memory asked for
/// anew at each update comes in pages that the system first clears, which takes as long as a
/// quarter of the update itself.
class Scratch {
 public:
  /// A matrix with undefined content; of the same shape as before, with the same content.
  Eigen::Map<Eigen::MatrixXd> shaped(Eigen::Index rows, Eigen::Index columns) {
    const auto needed = static_cast<std::size_t>(rows * columns);
    if (numbers_.size() < needed) numbers_.resize(needed + needed / 8);
    rows_ = rows;
    columns_ = columns;
    return matrix();
  }

  /// The matrix last shaped; valid until it is shaped anew.
  Eigen::Map<Eigen::MatrixXd> matrix() { return {numbers_.data(), rows_, columns_}; }

  /// Its first columns alone, as they are.
  void keep_columns(Eigen::Index columns) { columns_ = columns; }

  std::size_t bytes() const { return numbers_.capacity() * sizeof(double); }

 private:
  std::vector<double> numbers_;
  Eigen::Index rows_ = 0;
  Eigen::Index columns_ = 0;
};

}  // namespace fathom::filter
