/// @file
/// Converts C++ errors to sinew.Error and sinew.RunError, and notices to sinew.Notice.
#pragma once

#include <string>
#include <utility>

#include <pybind11/pybind11.h>

#include "sinew/core/error.hpp"
#include "sinew/core/notice.hpp"

namespace sinew::python {

namespace py = pybind11;

/// Thrown if two threads use one simulation at the same time; becomes sinew.Error of kind
/// "simulation-busy". It belongs to the bindings since only Python can share a simulation by
/// accident.
struct SimulationBusy {};

/// The Python exception of an error: an instance of sinew.Error, or sinew.RunError for a failed
/// run.
py::object to_python(const Error& error);

/// The sinew.Notice of a notice.
py::object to_python(const Notice& notice);

/// Returns `make()`. If that throws an Error without a location, the Error gets the argument's
/// name.
/// @param argument such as "Ramp". @param make called once.
template <typename Make>
auto at_argument(const std::string& argument, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw error.at({.item = argument});
  }
}

/// Registers the translation of Error and SimulationBusy for all bound functions.
void register_errors();

}  // namespace sinew::python
