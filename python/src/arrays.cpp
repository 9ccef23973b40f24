#include "python/src/arrays.hpp"

#include <algorithm>
#include <string_view>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/geometry/symmetry.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

std::string shape_text(const std::vector<std::ptrdiff_t>& shape) {
  std::string text;
  for (const std::ptrdiff_t size : shape) {
    text += (text.empty() ? "" : ", ") + (size < 0 ? "N" : std::to_string(size));
  }
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

bool fits(const Array& array, const std::vector<std::ptrdiff_t>& shape) {
  if (static_cast<std::size_t>(array.ndim()) != shape.size()) return false;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  }
  return true;
}

Eigen::Matrix3d matrix_at(const double* data) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data);
}

void require_symmetric(const Eigen::Matrix3d& matrix, const std::string& what) {
  if (is_symmetric(matrix)) return;
  throw InputError(what + ": expected a symmetric matrix of finite numbers");
}

void copy(const Eigen::Matrix3d& matrix, double* data) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> copied(data);
  copied = matrix;
}

}  // namespace

py::array_t<double> array_of(const Pose& pose) {
  const double values[3] = {pose.x, pose.y, pose.theta};
  return py::array_t<double>(3, values);
}

py::array_t<double> array_of(const Eigen::Matrix3d& matrix) {
  py::array_t<double> array({py::ssize_t{3}, py::ssize_t{3}});
  copy(matrix, array.mutable_data());
  return array;
}

py::array_t<double> array_of(const std::vector<Pose>& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{3}});
  double* to = array.mutable_data();
  for (const Pose& pose : poses) {
    for (const double value : {pose.x, pose.y, pose.theta}) *to++ = value;
  }
  return array;
}

py::array_t<double> array_of(const std::vector<Eigen::Matrix3d>& matrices) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(matrices.size()), py::ssize_t{3}, py::ssize_t{3}});
  double* to = array.mutable_data();
  for (const Eigen::Matrix3d& matrix : matrices) {
    copy(matrix, to);
    to += 9;
  }
  return array;
}

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<std::int64_t> array_of(const std::vector<std::int64_t>& values) {
  return py::array_t<std::int64_t>(static_cast<py::ssize_t>(values.size()), values.data());
}

Array checked_array(const py::handle& value, const std::vector<std::ptrdiff_t>& shape,
                    const std::string& what) {
  // Words that look like numbers are none, and complex ones would lose a part.
  const auto is_real = [](const py::array& given) {
    return std::string_view("biufO").find(given.dtype().kind()) != std::string_view::npos;
  };
  const py::array given = py::array::ensure(value);
  Array array =
      given && is_real(given) ? Array::ensure(given) : Array(py::reinterpret_steal<Array>(nullptr));
  if (!array) {
    PyErr_Clear();
    throw InputError(what + ": expected numbers of shape " + shape_text(shape) + ", got " +
                     py::str(py::type::of(value).attr("__name__")).cast<std::string>());
  }
  if (fits(array, shape)) return array;
  const std::vector<std::ptrdiff_t> got(array.shape(), array.shape() + array.ndim());
  throw InputError(what + ": expected shape " + shape_text(shape) + ", got " + shape_text(got));
}

Pose pose_of(const py::handle& value, const std::string& what) {
  const Array array = checked_array(value, {3}, what);
  const double* data = array.data();
  return {data[0], data[1], data[2]};
}

Pose finite_pose_of(const py::handle& value, const std::string& what) {
  Pose pose = pose_of(value, what);
  if (!is_finite(pose)) throw InputError(what + ": expected finite numbers");
  pose.theta = wrap_angle(pose.theta);
  return pose;
}

std::vector<Pose> poses_of(const py::handle& value, const std::string& what) {
  const Array array = checked_array(value, {-1, 3}, what);
  std::vector<Pose> poses;
  const double* data = array.data();
  for (py::ssize_t k = 0; k < array.shape(0); ++k, data += 3) {
    poses.push_back({data[0], data[1], data[2]});
  }
  return poses;
}

Eigen::Matrix3d matrix_of(const py::handle& value, const std::string& what) {
  return matrix_at(checked_array(value, {3, 3}, what).data());
}

Eigen::Matrix3d symmetric_of(const py::handle& value, const std::string& what) {
  const Eigen::Matrix3d matrix = matrix_of(value, what);
  require_symmetric(matrix, what);
  return matrix;
}

std::vector<Eigen::Matrix3d> symmetric_matrices_of(const py::handle& value,
                                                   const std::string& what) {
  const Array array = checked_array(value, {-1, 3, 3}, what);
  std::vector<Eigen::Matrix3d> matrices;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    matrices.push_back(matrix_at(array.data(k)));
    require_symmetric(matrices.back(), what + "[" + std::to_string(k) + "]");
  }
  return matrices;
}

std::vector<double> values_of(const py::handle& value, const std::string& what) {
  const Array array = checked_array(value, {-1}, what);
  return {array.data(), array.data() + array.size()};
}

}  // namespace fathom
