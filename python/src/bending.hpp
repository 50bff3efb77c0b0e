/// @file
/// Shared parts of the bindings of bending actuators.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "sinew/pcc/bending_motion.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

using BendingActuatorClass =
    py::class_<pcc::BendingActuator, std::shared_ptr<pcc::BendingActuator>>;

void bind_bending_modulus(py::module_& module);
/// Binds the equations. @param type of the actuator.
void bind_bending_model(BendingActuatorClass& type);
/// Binds simulate(). @param type of the actuator.
void bind_bending_history(BendingActuatorClass& type);
void bind_bending_motion(py::module_& module);

/// Makes motion settings. Throws Error(unknown-choice).
/// @param integrator name. @param spectral_radius of generalized-alpha.
pcc::BendingMotionSettings to_motion_settings(const std::string& integrator,
                                              double spectral_radius);

/// Applies f to every entry of arrays that broadcast against each other. For numbers, the result is
/// a float. Throws Error(wrong-shape), and what to_array() throws.
/// @param place names the arguments. @param values from Python. @param f function of N numbers.
template <std::size_t N, typename F>
py::object for_each(const char* place, const std::array<py::object, N>& values, F&& f) {
  py::list given;
  for (const py::object& value : values) given.append(to_array(value, place, "any shape"));
  py::list same;
  try {
    same = py::module_::import("numpy").attr("broadcast_arrays")(*given);
  } catch (py::error_already_set&) {
    throw Error(ErrorKind::wrong_shape, {.item = place}, "the shapes do not fit each other",
                "give numbers, or arrays that broadcast");
  }
  std::array<Array, N> arrays;
  for (std::size_t k = 0; k < N; ++k) arrays[k] = Array::ensure(same[k]);
  Array result(std::vector<py::ssize_t>(arrays[0].shape(), arrays[0].shape() + arrays[0].ndim()));
  for (py::ssize_t i = 0; i < result.size(); ++i) {
    std::array<double, N> at;
    for (std::size_t k = 0; k < N; ++k) at[k] = arrays[k].data()[i];
    result.mutable_data()[i] = std::apply(f, at);
  }
  return result.attr("__getitem__")(py::tuple());
}

}  // namespace sinew::python
