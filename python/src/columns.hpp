/// @file
/// Converts lists of structs to NumPy arrays of their members.
#pragma once

#include <array>
#include <vector>

#include "arrays.hpp"

namespace sinew::python {

/// An array (n, columns). get() returns the numbers of an entry as a std::array.
template <typename Scalar, std::size_t Columns, typename Entry, typename Get>
py::array_t<Scalar> rows(const std::vector<Entry>& list, Get get) {
  py::array_t<Scalar> array({list.size(), Columns});
  Scalar* to = array.mutable_data();
  for (const Entry& entry : list) {
    for (const Scalar value : get(entry)) *to++ = value;
  }
  return array;
}

/// An array (n,). get() returns the number of an entry.
template <typename Scalar, typename Entry, typename Get>
py::array_t<Scalar> numbers(const std::vector<Entry>& list, Get get) {
  py::array_t<Scalar> array(static_cast<py::ssize_t>(list.size()));
  Scalar* to = array.mutable_data();
  for (const Entry& entry : list) *to++ = static_cast<Scalar>(get(entry));
  return array;
}

/// An array (n, 3). get() returns the Vector3 of an entry.
template <typename Entry, typename Get>
Array vectors(const std::vector<Entry>& list, Get get) {
  Array array({list.size(), std::size_t{3}});
  double* to = array.mutable_data();
  for (const Entry& entry : list) {
    const Vector3 vector = get(entry);
    for (int c = 0; c < 3; ++c) *to++ = vector[c];
  }
  return array;
}

}  // namespace sinew::python
