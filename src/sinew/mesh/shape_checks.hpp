/// @file
/// What the measures of shapes must be; internal to this folder.
#pragma once

#include <string>

#include "sinew/mesh/shapes.hpp"

namespace sinew::mesh {

/// Throws Error(out-of-range) with `message` at the shape where `holds` is false.
void require(bool holds, const std::string& shape, const std::string& message);
/// A positive, finite number of metres. @param value,shape,what as for require(), and its name.
void require_length(double value, const std::string& shape, const char* what);
/// From `least` to 2000. @param value,shape,what as for require_length(). @param least cells or
/// rings.
void require_cells(int value, int least, const std::string& shape, const char* what);
/// Of a disc: hexahedra need two. @param rings,cells,shape of it.
void require_rings(int rings, Cells cells, const std::string& shape);

}  // namespace sinew::mesh
