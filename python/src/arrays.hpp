#pragma once

#include <cstddef>
#include <cstdint>
#include <pybind11/numpy.h>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// A new array: (3,), (3, 3), N x 3, N x 3 x 3, (N,).
pybind11::array_t<double> array_of(const Pose& pose);
pybind11::array_t<double> array_of(const Eigen::Matrix3d& matrix);
pybind11::array_t<double> array_of(const std::vector<Pose>& poses);
pybind11::array_t<double> array_of(const std::vector<Eigen::Matrix3d>& matrices);
pybind11::array_t<double> array_of(const std::vector<double>& values);
pybind11::array_t<std::int64_t> array_of(const std::vector<std::int64_t>& values);

/// What can be read as an array of numbers of this shape (-1: of any length). Throws InputError,
/// which begins with `what`: "what: expected shape (3,), got (2,)".
Array checked_array(const pybind11::handle& value, const std::vector<std::ptrdiff_t>& shape,
                    const std::string& what);

/// Of three numbers x, y (m), theta (rad). Throws InputError.
Pose pose_of(const pybind11::handle& value, const std::string& what);
Pose finite_pose_of(const pybind11::handle& value, const std::string& what);
/// N x 3.
std::vector<Pose> poses_of(const pybind11::handle& value, const std::string& what);
Eigen::Matrix3d matrix_of(const pybind11::handle& value, const std::string& what);
/// Symmetric but by rounding.
Eigen::Matrix3d symmetric_of(const pybind11::handle& value, const std::string& what);
/// N x 3 x 3.
std::vector<Eigen::Matrix3d> symmetric_matrices_of(const pybind11::handle& value,
                                                   const std::string& what);
std::vector<double> values_of(const pybind11::handle& value, const std::string& what);

}  // namespace fathom
