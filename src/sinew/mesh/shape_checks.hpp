/// @file
/// Checks of the dimensions of shapes; internal to this folder.
#pragma once

#include <string>

#include "sinew/mesh/shapes.hpp"

namespace sinew::mesh {

/// Throws Error(out-of-range) with `message` at the shape if `holds` is false.
void require(bool holds, const std::string& shape, const std::string& message);
/// Requires a positive, finite length, m. @param value,shape,what the length, the shape, and the
/// name of the length.
void require_length(double value, const std::string& shape, const char* what);
/// Requires a number from `least` to 2000. @param value,shape,what as for require_length(). @param
/// least number of cells or rings.
void require_cells(int value, int least, const std::string& shape, const char* what);
/// Requires enough rings of a disc: two for hexahedra. @param rings,cells,shape of the disc.
void require_rings(int rings, Cells cells, const std::string& shape);

}  // namespace sinew::mesh
