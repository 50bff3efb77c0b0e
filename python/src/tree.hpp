/// @file
/// A Python dict as a scene tree.
#pragma once

#include <pybind11/pybind11.h>

#include "sinew/scene/node.hpp"

namespace sinew::python {

/// Dicts become maps; lists, tuples and arrays become lists; numbers, text, paths, booleans and
/// None become scalars.
/// Throws Error(wrong-type) for anything else, with the dotted path of where it stands, and
/// Error(size-limit) when it is nested too deeply (as a dict that holds itself).
/// @param value from Python.
scene::Node to_tree(const pybind11::handle& value);

}  // namespace sinew::python
