#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace sinew::python {

namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void wrong_shape(const py::array& array, const std::string& place,
                              const std::string& wanted) {
  throw Error(ErrorKind::wrong_shape, {.item = place},
              fmt::format("the array has shape {}", shape_text(array)),
              fmt::format("give an array of shape {}", wanted));
}

std::string type_name(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

// Text "entry [1, 2] is nan" for the first entry that is not finite.
std::string first_not_finite(const Array& array) {
  const auto bad = std::find_if_not(array.data(), array.data() + array.size(),
                                    [](double value) { return std::isfinite(value); });
  auto left = static_cast<py::ssize_t>(bad - array.data());
  std::string index;
  for (py::ssize_t i = array.ndim() - 1; i >= 0; --i) {
    index = fmt::format("{}{}{}", left % array.shape(i), index.empty() ? "" : ", ", index);
    left /= array.shape(i);
  }
  return fmt::format("entry [{}] is {}", index, *bad);
}

}  // namespace

double to_number(const py::handle& value, const std::string& place, const std::string& unit) {
  const bool is_array = py::isinstance<py::array>(value);
  const bool scalar = !is_array || py::reinterpret_borrow<py::array>(value).ndim() == 0;
  const double number = scalar && !PyBool_Check(value.ptr()) && !py::isinstance<py::str>(value)
                            ? PyFloat_AsDouble(value.ptr())
                            : -1.0;
  if (PyErr_Occurred() != nullptr || !scalar || PyBool_Check(value.ptr()) ||
      py::isinstance<py::str>(value)) {
    PyErr_Clear();
    throw Error(ErrorKind::wrong_type, {.item = place},
                fmt::format("{} of type {} is not a number",
                            std::string(py::repr(value)).substr(0, 60), type_name(value)),
                fmt::format("give one number in {}", unit));
  }
  if (!std::isfinite(number)) {
    throw Error(ErrorKind::not_finite, {.item = place}, fmt::format("the value is {}", number),
                fmt::format("give a finite number in {}", unit));
  }
  return number;
}

std::int64_t to_count(const py::handle& value, const std::string& place) {
  if (PyIndex_Check(value.ptr()) == 0 || PyBool_Check(value.ptr())) {
    throw Error(ErrorKind::wrong_type, {.item = place},
                fmt::format("{} of type {} is not a whole number",
                            std::string(py::repr(value)).substr(0, 60), type_name(value)),
                "give an int");
  }
  const Py_ssize_t number = PyNumber_AsSsize_t(value.ptr(), PyExc_OverflowError);
  if (PyErr_Occurred() == nullptr) return number;
  if (PyErr_ExceptionMatches(PyExc_OverflowError) == 0) throw py::error_already_set();
  PyErr_Clear();
  throw Error(ErrorKind::out_of_range, {.item = place}, "the number is too large",
              "give a smaller one");
}

Array to_array(const py::handle& value, const std::string& place, const std::string& wanted) {
  py::array any = py::array::ensure(value);
  if (!any) PyErr_Clear();
  const bool ragged = !any && PySequence_Check(value.ptr()) != 0;
  const char kind = any ? any.dtype().kind() : 'O';
  if (ragged) {
    throw Error(ErrorKind::wrong_shape, {.item = place}, "the rows differ in length",
                fmt::format("give an array of shape {}", wanted));
  }
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw Error(ErrorKind::wrong_type, {.item = place},
                fmt::format("{} of type {} holds no real numbers",
                            std::string(py::repr(value)).substr(0, 60), type_name(value)),
                fmt::format("give an array of shape {}", wanted));
  }
  Array array = Array::ensure(any);
  if (!array) throw py::error_already_set();
  const bool finite = std::all_of(array.data(), array.data() + array.size(),
                                  [](double number) { return std::isfinite(number); });
  if (!finite) {
    throw Error(ErrorKind::not_finite, {.item = place}, first_not_finite(array),
                "give finite numbers");
  }
  return array;
}

Vector3 to_vector3(const py::handle& value, const std::string& place, const std::string& unit) {
  const Array array = to_array(value, place, "(3,) " + unit);
  if (array.ndim() != 1 || array.shape(0) != 3) wrong_shape(array, place, "(3,) " + unit);
  return {array.at(0), array.at(1), array.at(2)};
}

Points to_points(const py::handle& value, const std::string& place, const std::string& unit,
                 Eigen::Index rows) {
  const std::string wanted =
      rows < 0 ? fmt::format("(n, 3) {}", unit) : fmt::format("({}, 3) {}", rows, unit);
  const Array array = to_array(value, place, wanted);
  if (array.ndim() != 2 || array.shape(1) != 3 || (rows >= 0 && array.shape(0) != rows)) {
    wrong_shape(array, place, wanted);
  }
  return Eigen::Map<const Points>(array.data(), array.shape(0), 3);
}

std::vector<double> to_list(const py::handle& value, const std::string& place,
                            const std::string& unit) {
  const Array array = to_array(value, place, "(n,) " + unit);
  if (array.ndim() != 1) wrong_shape(array, place, "(n,) " + unit);
  return {array.data(), array.data() + array.size()};
}

VectorX to_vector(const py::handle& value, const std::string& place, Eigen::Index size,
                  const std::string& unit) {
  const std::string wanted = fmt::format("({},) {}", size, unit);
  const Array array = to_array(value, place, wanted);
  if (array.ndim() != 1 || array.size() != size) wrong_shape(array, place, wanted);
  return Eigen::Map<const VectorX>(array.data(), size);
}

MatrixX to_matrix(const py::handle& value, const std::string& place, const std::string& wanted) {
  const Array array = to_array(value, place, wanted);
  if (array.ndim() != 2) wrong_shape(array, place, wanted);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), array.shape(0), array.shape(1));
}

Eigen::SparseMatrix<double> to_sparse(const py::object& matrix) {
  const py::object columns = matrix.attr("tocsc")();
  const auto shape = columns.attr("shape").cast<std::pair<int, int>>();
  const auto values = columns.attr("data").cast<py::array_t<double, py::array::forcecast>>();
  const auto rows = columns.attr("indices").cast<py::array_t<int, py::array::forcecast>>();
  const auto starts = columns.attr("indptr").cast<py::array_t<int, py::array::forcecast>>();
  return Eigen::Map<const Eigen::SparseMatrix<double>>(shape.first, shape.second, values.size(),
                                                       starts.data(), rows.data(), values.data());
}

MatrixX to_gappy_matrix(const py::handle& value, const std::string& place,
                        const std::string& wanted) {
  const py::array any = py::array::ensure(value);
  if (!any) PyErr_Clear();
  const char kind = any ? any.dtype().kind() : 'O';
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw Error(ErrorKind::wrong_type, {.item = place},
                fmt::format("a value of type {} holds no real numbers", type_name(value)),
                fmt::format("give an array of shape {}", wanted));
  }
  const Array array = Array::ensure(any);
  if (!array) throw py::error_already_set();
  if (array.ndim() != 1 && array.ndim() != 2) wrong_shape(array, place, wanted);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.data(), array.shape(0),
                                    array.ndim() == 2 ? array.shape(1) : 1);
}

Array copy(const Vector3& vector) { return Array(3, vector.data()); }
Array copy(const VectorX& vector) { return Array(vector.size(), vector.data()); }
Array copy(const Points& points) { return Array({points.rows(), Eigen::Index{3}}, points.data()); }
Array copy(const MatrixX& matrix) {
  Array array({matrix.rows(), matrix.cols()});
  auto values = array.mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) values(i, j) = matrix(i, j);
  }
  return array;
}

}  // namespace sinew::python
