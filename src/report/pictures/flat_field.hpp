#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace fathom {

/// Learns the illumination that all pictures of a survey have in common, such as vignetting or the
/// cone of a lamp, from the pictures themselves: a smooth field F by which every picture's floor
/// was multiplied.
///
/// The logarithm of each picture, averaged over some 32 × 32 cells, is fitted by a polynomial of
/// degree 4 in the two directions of the picture. What the pictures have in common is the mean of
/// its coefficients; what is of the floor changes from picture to picture and averages out. A
/// coefficient a whose mean of n independent pictures has the variance s²/n is known only as well
/// as that, so it counts by max(0, 1 − s²/(n a²)): with few pictures, or with pictures that are not
/// alike, nothing is corrected.
class FlatField {
 public:
  /// Of pictures of this size. Pictures under 16 pixels a side are left as they are.
  explicit FlatField(cv::Size size);

  /// 8-bit, one channel; looked at side by side.
  void add(std::span<const cv::Mat> pictures);

  /// The factors mean(F)/F by which pictures are to be multiplied: CV_32F of their size, which
  /// leaves their grey level as it was. `independent`: how many of the pictures show another piece
  /// of floor; below 2, and with fewer than 3 pictures, all factors are 1.
  cv::Mat gain(double independent) const;

 private:
  /// The polynomial of one, without its constant. `exact`: room for it, CV_32F.
  Eigen::VectorXd fitted(const cv::Mat& picture, cv::Mat& exact) const;
  Eigen::VectorXd common_part(double independent) const;

  cv::Size size_;
  cv::Size cells_;
  Eigen::MatrixXd basis_;  ///< orthonormal over the cells; the constant is column 0
  Eigen::MatrixXd monomials_from_basis_;
  std::vector<cv::Mat> exact_;  ///< kept: new memory costs more than what is done with it
  std::vector<Eigen::VectorXd> coefficients_;  ///< of each picture, without the constant
};

}  // namespace fathom
