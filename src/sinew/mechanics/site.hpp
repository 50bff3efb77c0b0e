/// @file
/// Sites: where on a body rows act. A body gives each a number when it is attached.
///
/// | site | its motion | a row's direction there | conjugate |
/// |---|---|---|---|
/// | MaterialPoint | displacement, m | of the displacement | force, N |
/// | Orientation | turn about the world's axes, rad | the axis of the turn | moment, N m |
/// | SurfaceSite | displacement, m | of the displacement | force, N |
/// | Coordinate | change of q, rad or m | (factor, 0, 0) | generalised force, N m or N |
#pragma once

#include <cstdint>

namespace sinew::mechanics {

/// A place on a body, of whatever kind.
struct Site {
  std::int32_t body = -1;    ///< position in the world's list of bodies
  std::int32_t number = -1;  ///< what the body calls it

  bool operator==(const Site&) const = default;
};

/// A point fixed in a body's material.
struct MaterialPoint : Site {};

/// Any point of a body's surface: which one, RowValues::patch says in every step anew.
struct SurfaceSite : Site {};

/// The rotation of a part of a body that stays rigid: a section of an arm.
struct Orientation : Site {};

/// One of the coordinates of a body of few.
struct Coordinate : Site {};

}  // namespace sinew::mechanics
