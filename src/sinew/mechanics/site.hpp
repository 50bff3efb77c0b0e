/// @file
/// Sites: the places on a body where rows act. A body numbers its sites when they are attached.
///
/// | site | its motion | direction of a row there | conjugate |
/// |---|---|---|---|
/// | MaterialPoint | displacement, m | of the displacement | force, N |
/// | Orientation | rotation in world axes, rad | axis of the rotation | moment, N m |
/// | SurfaceSite | displacement, m | of the displacement | force, N |
/// | Coordinate | change of q, rad or m | (factor, 0, 0) | generalised force, N m or N |
#pragma once

#include <cstdint>

namespace sinew::mechanics {

/// A site of any kind.
struct Site {
  std::int32_t body = -1;    ///< position of the body in the world
  std::int32_t number = -1;  ///< number of the site on the body

  bool operator==(const Site&) const = default;
};

/// A point that moves with the material of a body.
struct MaterialPoint : Site {};

/// A point of the surface of a body, given in every step by RowValues::patch.
struct SurfaceSite : Site {};

/// The rotation of a rigid part of a body, such as a section of an arm.
struct Orientation : Site {};

/// A generalised coordinate of a body with few coordinates.
struct Coordinate : Site {};

}  // namespace sinew::mechanics
