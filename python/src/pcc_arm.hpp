/// @file
/// The class behind sinew.pcc.Arm: an arm, and a workspace of its equations.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_equations.hpp"

#include "arrays.hpp"

namespace sinew::python {

struct PccArm {
  explicit PccArm(std::shared_ptr<const pcc::Arm> of) : arm(std::move(of)), equations(arm) {}

  /// Converts coordinates (coordinates,). @param value,place,unit as for to_list().
  VectorX angles(const py::handle& value, const std::string& place, const std::string& unit) const {
    return to_vector(value, place, arm->coordinates(), unit);
  }
  /// A material point of the arm. Throws Error(out-of-range).
  pcc::ArmPoint place(int segment, double fraction, const std::pair<double, double>& offset) const;

  std::shared_ptr<const pcc::Arm> arm;
  pcc::ArmEquations equations;
};

using PccArmClass = py::class_<PccArm>;

/// Binds sizes, positions and equations of motion. @param arm class to which they are added.
void bind_arm_equations(PccArmClass& arm);
/// Binds equilibrium() and simulate(). @param arm class to which they are added.
void bind_arm_simulation(PccArmClass& arm);

/// The value of a word. Throws Error(unknown-choice).
/// @param word from Python. @param place names the argument. @param choices all words with values.
template <typename T>
T choose(const std::string& word, const std::string& place,
         std::initializer_list<std::pair<const char*, T>> choices) {
  std::string names;
  for (const auto& [name, value] : choices) {
    if (word == name) return value;
    names += (names.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  throw Error(ErrorKind::unknown_choice, {.item = place}, fmt::format("there is no '{}'", word),
              "use one of " + names);
}

}  // namespace sinew::python
