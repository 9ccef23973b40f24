#include "flat_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include <Eigen/QR>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

constexpr int kDegree = 4;
constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;
constexpr int kMostCells = 32;
constexpr int kLeastPixels = 16;

using Terms = Eigen::Matrix<double, 1, kTerms>;

// x^i y^j with i + j ≤ 4, the constant first; both from −1 to 1 over the picture.
Terms terms_at(double x, double y) {
  std::array<double, kDegree + 1> x_to{1.0};
  std::array<double, kDegree + 1> y_to{1.0};
  for (std::size_t i = 1; i < x_to.size(); ++i) {
    x_to[i] = x_to[i - 1] * x;
    y_to[i] = y_to[i - 1] * y;
  }
  Terms terms;
  int next = 0;
  for (std::size_t degree = 0; degree < x_to.size(); ++degree) {
    for (std::size_t j = 0; j <= degree; ++j) terms(next++) = x_to[degree - j] * y_to[j];
  }
  return terms;
}

// Of a polynomial in x, by power.
using Powers = std::array<double, kDegree + 1>;

// Of the polynomial in x and y, with y held.
Powers along_row(const Eigen::VectorXd& monomials, double y) {
  Powers by_x{};
  int next = 0;
  for (std::size_t degree = 0; degree < by_x.size(); ++degree) {
    double y_to = 1.0;
    for (std::size_t j = 0; j <= degree; ++j, y_to *= y)
      by_x[degree - j] += monomials(next++) * y_to;
  }
  return by_x;
}

double value_at(const Powers& by_x, double x) {
  double value = 0.0;
  for (std::size_t i = by_x.size(); i-- > 0;) value = value * x + by_x[i];
  return value;
}

double centred(int i, int count) {
  return (2.0 * i + 1.0) / count - 1.0;
}

}  // namespace

FlatField::FlatField(cv::Size size) : size_(size) {
  if (std::min(size.width, size.height) < kLeastPixels) return;
  cells_ = cv::Size(std::min(kMostCells, size.width), std::min(kMostCells, size.height));
  Eigen::MatrixXd design(cells_.area(), kTerms);
  for (int v = 0; v < cells_.height; ++v) {
    for (int u = 0; u < cells_.width; ++u) {
      design.row(v * cells_.width + u) =
          terms_at(centred(u, cells_.width), centred(v, cells_.height));
    }
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design);
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(cells_.area(), kTerms);
  const Eigen::MatrixXd R = qr.matrixQR().topRows(kTerms);
  monomials_from_basis_ =
      R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(kTerms, kTerms));
}

Eigen::VectorXd FlatField::fitted(const cv::Mat& picture, cv::Mat& exact) const {
  cv::Mat cells;
  picture.convertTo(exact, CV_32F);
  cv::resize(exact, cells, cells_, 0, 0, cv::INTER_AREA);
  Eigen::VectorXd logarithms(cells_.area());
  for (int i = 0; i < cells_.area(); ++i) {
    // Black is as dark as a grey level of 1: its logarithm would drown all others.
    logarithms(i) = std::log(std::max(1.0F, cells.at<float>(i / cells_.width, i % cells_.width)));
  }
  return basis_.rightCols(kTerms - 1).transpose() * logarithms;
}

void FlatField::add(std::span<const cv::Mat> pictures) {
  if (cells_.empty()) return;
  const std::size_t before = coefficients_.size();
  coefficients_.resize(before + pictures.size());
  exact_.resize(std::max(exact_.size(), pictures.size()));
  cv::parallel_for_({0, static_cast<int>(pictures.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto place = static_cast<std::size_t>(i);
      coefficients_[before + place] = fitted(pictures[place], exact_[place]);
    }
  });
}

Eigen::VectorXd FlatField::common_part(double independent) const {
  Eigen::VectorXd common = Eigen::VectorXd::Zero(kTerms);
  if (coefficients_.size() < 3 || !(independent >= 2.0)) return common;
  const auto count = static_cast<double>(coefficients_.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(kTerms - 1);
  for (const Eigen::VectorXd& c : coefficients_) mean += c / count;
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(kTerms - 1);
  for (const Eigen::VectorXd& c : coefficients_) {
    variance += (c - mean).cwiseAbs2() / (count - 1.0);
  }
  for (int j = 0; j + 1 < kTerms; ++j) {
    const double power = mean(j) * mean(j);
    if (!(power > 0.0)) continue;
    common(j + 1) = mean(j) * std::max(0.0, 1.0 - variance(j) / (independent * power));
  }
  return common;
}

cv::Mat FlatField::gain(double independent) const {
  const Eigen::VectorXd common = common_part(independent);
  cv::Mat gain(size_, CV_32F, cv::Scalar(1.0));
  if (common.isZero(0.0)) return gain;
  const Eigen::VectorXd monomials = monomials_from_basis_ * common;
  std::vector<double> sums(static_cast<std::size_t>(size_.height));
  cv::parallel_for_({0, size_.height}, [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) {
      const Powers by_x = along_row(monomials, centred(v, size_.height));
      float* const row = gain.ptr<float>(v);
      double& sum = sums[static_cast<std::size_t>(v)];
      for (int u = 0; u < size_.width; ++u) {
        const double field = std::exp(value_at(by_x, centred(u, size_.width)));
        sum += field;
        row[u] = static_cast<float>(1.0 / field);
      }
    }
  });
  const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
  gain *= sum / size_.area();
  return gain;
}

}  // namespace fathom
