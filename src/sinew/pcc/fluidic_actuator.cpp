#include "sinew/pcc/fluidic_actuator.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

void FluidicActuator::check() const {
  const Location place{.item = "fluidic actuator"};
  if (!std::isfinite(linear) || !std::isfinite(cubic) || !std::isfinite(delay)) {
    throw Error(ErrorKind::not_finite, place, "a coefficient is not finite", "give numbers");
  }
  if (linear < 0.0 || cubic < 0.0 || linear + cubic == 0.0) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("its coefficients are {:g} N m/m^3 and {:g} N m/m^9", linear, cubic),
                "give zero or more, and not both zero: torque grows with the volume");
  }
  if (delay < 0.0) {
    throw Error(ErrorKind::out_of_range, place, fmt::format("its delay is {:g} s", delay),
                "give zero or more");
  }
}

double FluidicActuator::volume(double torque) const {
  if (cubic == 0.0 || torque == 0.0) return torque == 0.0 ? 0.0 : torque / linear;
  double root = std::cbrt(torque / cubic);
  if (linear == 0.0) return root;
  // If the linear term is negligible, the quotient a/c would underflow.
  if (linear > 1e-12 * cubic * root * root) {
    const double unit = 2.0 * std::sqrt(linear / (3.0 * cubic));
    root = unit * std::sinh(std::asinh(3.0 * torque / (linear * unit)) / 3.0);
  }
  // One step of Newton's method removes the neglected term, and the rounding of sinh and asinh.
  return root - (this->torque(root) - torque) / slope(root);
}

}  // namespace sinew::pcc
