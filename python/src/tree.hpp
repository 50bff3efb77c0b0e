/// @file
/// Converts a Python dict to a scene tree.
#pragma once

#include <pybind11/pybind11.h>

#include "sinew/scene/node.hpp"

namespace sinew::python {

/// Converts a Python value. Dicts become maps; lists, tuples and arrays become lists; numbers,
/// text, paths, booleans and None become scalars. Throws Error(wrong-type) with the dotted path for
/// anything else, and Error(size-limit) for excessive nesting, such as a dict that contains itself.
/// @param value from Python.
scene::Node to_tree(const pybind11::handle& value);

}  // namespace sinew::python
