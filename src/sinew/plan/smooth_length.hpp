/// @file
/// A norm that is smooth at zero.
#pragma once

#include <cmath>

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// sqrt(|e|^2 + d^2) of a spatial vector e, with its derivatives.
struct SmoothLength {
  double value;
  Vector3 gradient;
  Matrix3 hessian;

  SmoothLength(const Vector3& e, double d)
      : value(std::sqrt(e.squaredNorm() + d * d)),
        gradient(e / value),
        hessian((Matrix3::Identity() - gradient * gradient.transpose()) / value) {}
};

}  // namespace sinew::plan
