/// @file
/// Converts between NumPy and Eigen: checked conversions from Python, copies and views to Python.
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

/// Converts a number. Throws Error(wrong-type | not-finite) at `place` for anything but a finite
/// real number (NumPy scalars included, booleans not).
/// @param value from Python. @param place names the argument. @param unit for the message: "m".
double to_number(const py::handle& value, const std::string& place, const std::string& unit);

/// Converts an integer. Throws Error(wrong-type | out-of-range) at `place` for anything but
/// an integer of 64 bits (NumPy scalars included, booleans not).
/// @param value from Python. @param place names the argument.
std::int64_t to_count(const py::handle& value, const std::string& place);

/// Converts an array of any shape. Throws Error(wrong-type) unless it contains real numbers,
/// Error(wrong-shape) if it is ragged, and Error(not-finite) that names the first such entry.
/// @param value from Python. @param place names the argument. @param wanted describes the shape:
/// "(3,) m".
Array to_array(const py::handle& value, const std::string& place, const std::string& wanted);

/// Converts an array (3,). Throws what to_array() throws, and Error(wrong-shape).
Vector3 to_vector3(const py::handle& value, const std::string& place, const std::string& unit);

/// Converts an array (n, 3). Throws what to_array() throws, and Error(wrong-shape).
/// @param rows required number of rows; -1 for any number.
/// @param value,place,unit as for to_vector3().
Points to_points(const py::handle& value, const std::string& place, const std::string& unit,
                 Eigen::Index rows = -1);

/// Converts an array (n,). Throws what to_array() throws, and Error(wrong-shape).
std::vector<double> to_list(const py::handle& value, const std::string& place,
                            const std::string& unit);

/// Converts an array (size,). Throws what to_array() throws, and Error(wrong-shape).
VectorX to_vector(const py::handle& value, const std::string& place, Eigen::Index size,
                  const std::string& unit);

/// Converts a matrix of any shape. Throws what to_array() throws, and Error(wrong-shape).
/// @param wanted describes shape and unit: "(steps, inputs) N m".
MatrixX to_matrix(const py::handle& value, const std::string& place, const std::string& wanted);

/// Converts a sparse matrix to column-major storage. @param matrix of scipy.sparse.
Eigen::SparseMatrix<double> to_sparse(const py::object& matrix);

/// Converts a matrix (rows, columns), or a vector (rows,) as one column. Missing measurements may
/// be nan. Throws Error(wrong-type | wrong-shape). @param value,place,wanted as for to_matrix().
MatrixX to_gappy_matrix(const py::handle& value, const std::string& place,
                        const std::string& wanted);

/// Copies to a new NumPy array.
Array copy(const Vector3& vector);
Array copy(const VectorX& vector);
Array copy(const MatrixX& matrix);
Array copy(const Points& points);

/// The same array, which raises ValueError when it is written to.
template <typename Numbers>
Numbers read_only(Numbers array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Copies the present value of an attribute, such as a position. Writing to it changes nothing in
/// the simulation and hence raises ValueError.
template <typename Matrix>
Array reading(const Matrix& matrix) {
  return read_only(copy(matrix));
}

/// A NumPy view of (rows, columns) numbers. It keeps `owner`, to which the numbers belong, alive.
template <typename Scalar>
py::array view(const Scalar* data, py::ssize_t rows, py::ssize_t columns, const py::object& owner,
               bool writable = false) {
  py::array_t<Scalar> array({rows, columns}, data, owner);
  return writable ? array : read_only(array);
}

}  // namespace sinew::python
