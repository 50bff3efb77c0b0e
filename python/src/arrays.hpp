/// @file
/// Between NumPy and Eigen: checked conversions in, copies and live views out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/SparseCore>
#include <pybind11/numpy.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::python {

namespace py = pybind11;

/// Row-major array of doubles.
using Array = py::array_t<double, py::array::c_style>;

/// A number from Python. Throws Error(wrong-type | not-finite) at `place` for anything but a finite
/// real number (NumPy scalars included, booleans not).
/// @param value from Python. @param place names the argument. @param unit for the message: "m".
double to_number(const py::handle& value, const std::string& place, const std::string& unit);

/// A whole number from Python. Throws Error(wrong-type | out-of-range) at `place` for anything but
/// an integer of 64 bits (NumPy scalars included, booleans not).
/// @param value from Python. @param place names the argument.
std::int64_t to_count(const py::handle& value, const std::string& place);

/// An array of any shape. Throws Error(wrong-type) when it holds no real numbers,
/// Error(wrong-shape) when it is ragged, Error(not-finite) naming the first such entry.
/// @param value from Python. @param place names the argument. @param wanted describes the shape:
/// "(3,) m".
Array to_array(const py::handle& value, const std::string& place, const std::string& wanted);

/// (3,). Throws as to_array(), and Error(wrong-shape).
Vector3 to_vector3(const py::handle& value, const std::string& place, const std::string& unit);

/// (n, 3). Throws as to_array(), and Error(wrong-shape).
/// @param rows how many there must be; -1 for any number.
/// @param value,place,unit see to_vector3().
Points to_points(const py::handle& value, const std::string& place, const std::string& unit,
                 Eigen::Index rows = -1);

/// (n,). Throws as to_array(), and Error(wrong-shape).
std::vector<double> to_list(const py::handle& value, const std::string& place,
                            const std::string& unit);

/// (size,). Throws as to_array(), and Error(wrong-shape).
VectorX to_vector(const py::handle& value, const std::string& place, Eigen::Index size,
                  const std::string& unit);

/// Any matrix. Throws as to_array(), and Error(wrong-shape).
/// @param wanted describes shape and unit: "(steps, inputs) N m".
MatrixX to_matrix(const py::handle& value, const std::string& place, const std::string& wanted);

/// By columns. @param matrix of scipy.sparse.
Eigen::SparseMatrix<double> to_sparse(const py::object& matrix);

/// (rows,) or (rows, columns) with nan where nothing was measured; a vector is one column.
/// Throws Error(wrong-type | wrong-shape).
/// @param value,place,wanted see to_matrix().
MatrixX to_gappy_matrix(const py::handle& value, const std::string& place,
                        const std::string& wanted);

/// Copies.
Array copy(const Vector3& vector);
Array copy(const VectorX& vector);
Array copy(const MatrixX& matrix);
Array copy(const Points& points);

/// A view of (rows, columns) numbers that live as long as `owner`.
template <typename Scalar>
py::array view(const Scalar* data, py::ssize_t rows, py::ssize_t columns, const py::object& owner,
               bool writable = false) {
  py::array_t<Scalar> array({rows, columns}, data, owner);
  if (!writable) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  }
  return array;
}

}  // namespace sinew::python
