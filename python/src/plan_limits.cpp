#include "plan_limits.hpp"

#include <fmt/format.h>

#include "arrays.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

/// Sets limits from a number or (n,), for both directions, or from (2, n), lower and upper ones.
void set_limits(const py::object& value, const std::string& place, Eigen::Index n,
                const std::string& unit, VectorX& lower, VectorX& upper) {
  if (value.is_none()) return;
  const Array array =
      to_array(value, place, fmt::format("({},) either way or (2, {}) {}", n, n, unit));
  if (array.ndim() == 2) {
    const MatrixX both = to_matrix(value, place, fmt::format("(2, {}) {}", n, unit));
    if (both.rows() != 2 || both.cols() != n) {
      throw Error(ErrorKind::wrong_shape, {.item = place},
                  fmt::format("its shape is ({}, {})", both.rows(), both.cols()),
                  fmt::format("give ({},), or (2, {}) with the lower ones first", n, n));
    }
    lower = both.row(0);
    upper = both.row(1);
    return;
  }
  upper = array.ndim() == 0 ? VectorX(VectorX::Constant(n, array.data()[0]))
                            : to_vector(value, place, n, unit);
  lower = -upper;
}

}  // namespace

VectorX to_optional(const py::object& value, const std::string& place, Eigen::Index n,
                    const std::string& unit) {
  if (value.is_none()) return {};
  const Array array = to_array(value, place, fmt::format("({},) {}", n, unit));
  if (array.ndim() == 0) return VectorX::Constant(n, array.data()[0]);
  return to_vector(value, place, n, unit);
}

plan::ArmLimits to_limits(const pcc::Arm& arm, const py::object& torque, const py::object& angle) {
  plan::ArmLimits limits;
  set_limits(torque, "torque_limits", arm.inputs(), "N m", limits.torque_lower,
             limits.torque_upper);
  set_limits(angle, "angle_limits", arm.coordinates(), "rad", limits.angle_lower,
             limits.angle_upper);
  return limits;
}

}  // namespace sinew::python
