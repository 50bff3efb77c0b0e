/// @file
/// What Python knows as sinew.pcc.Arm: the arm and a workspace of its equations.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "sinew/pcc/arm_equations.hpp"

#include "arrays.hpp"

namespace sinew::python {

struct PccArm {
  explicit PccArm(std::shared_ptr<const pcc::Arm> of) : arm(std::move(of)), equations(arm) {}

  /// (coordinates,) from Python. @param value,place,unit see to_list().
  VectorX angles(const py::handle& value, const std::string& place, const std::string& unit) const {
    return to_vector(value, place, arm->coordinates(), unit);
  }
  /// A point of its material. Throws Error(out-of-range).
  pcc::ArmPoint place(int segment, double fraction, const std::pair<double, double>& offset) const;

  std::shared_ptr<const pcc::Arm> arm;
  pcc::ArmEquations equations;
};

}  // namespace sinew::python
