/// @file
/// Lists of things as NumPy arrays of what each of them has.
#pragma once

#include <array>
#include <vector>

#include "arrays.hpp"

namespace sinew::python {

/// (n, columns): of each entry what get() returns, a std::array of as many numbers.
template <typename Scalar, std::size_t Columns, typename Entry, typename Get>
py::array_t<Scalar> rows(const std::vector<Entry>& list, Get get) {
  py::array_t<Scalar> array({list.size(), Columns});
  Scalar* to = array.mutable_data();
  for (const Entry& entry : list) {
    for (const Scalar value : get(entry)) *to++ = value;
  }
  return array;
}

/// (n,): of each entry the number that get() returns.
template <typename Scalar, typename Entry, typename Get>
py::array_t<Scalar> numbers(const std::vector<Entry>& list, Get get) {
  py::array_t<Scalar> array(static_cast<py::ssize_t>(list.size()));
  Scalar* to = array.mutable_data();
  for (const Entry& entry : list) *to++ = static_cast<Scalar>(get(entry));
  return array;
}

/// (n, 3): of each entry the Vector3 that get() returns.
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
