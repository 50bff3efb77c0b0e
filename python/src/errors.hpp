/// @file
/// How C++ errors become sinew.Error and sinew.RunError, and notices sinew.Notice.
#pragma once

#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"

namespace sinew::python {

namespace py = pybind11;

/// Thrown when two threads use one simulation at the same time; becomes sinew.Error of kind
/// "simulation-busy". It stands here since only Python can share a simulation by accident.
struct SimulationBusy {};

/// The Python exception for an error: an instance of sinew.Error, or sinew.RunError for a failed
/// run.
py::object to_python(const Error& error);

/// A sinew.Notice.
py::object to_python(const Notice& notice);

/// The value of `make()`; an Error without a place gets the argument's name.
/// @param argument as "Ramp". @param make called once.
template <typename Make>
auto at_argument(const std::string& argument, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw error.at({.item = argument});
  }
}

/// Lets every bound function throw Error and SimulationBusy.
void register_errors();

}  // namespace sinew::python
