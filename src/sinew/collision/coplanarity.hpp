/// @file
/// When four moving points are coplanar: a cubic function of time with an error bound.
#pragma once

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// A vector that moves linearly while time runs from 0 to 1.
struct MovingVector {
  Vector3 start, end;  ///< (3,) m
};

/// The cubic p(t) = x.(y x z) of three moving vectors between four points, in Bernstein form. Each
/// vector is the rounded difference of two exact points. A vertex at x from a triangle's corner
/// meets the triangle with edges y and z only where p = 0; for two edges y and z, x joins their
/// ends.
class Coplanarity {
 public:
  /// @param x,y,z the vectors of p.
  /// @param separation m, >= 0: |p| <= separation |y x z| counts as p = 0.
  Coplanarity(const MovingVector& x, const MovingVector& y, const MovingVector& z,
              double separation);

  /// A time up to which p is certainly not 0: that of the next zero, minus rounding; more than 1 if
  /// no zero follows; `time` if p may be 0 now. @param time from 0 to 1.
  double apart_until(double time) const;

 private:
  std::array<double, 4> part(double from, double to) const;

  std::array<double, 4> bernstein_;
  double error_;
};

}  // namespace sinew::collision
