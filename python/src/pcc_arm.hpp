/// @file
/// What Python knows as sinew.pcc.Arm: the arm and a workspace of its equations.
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

  /// (coordinates,) from Python. @param value,place,unit see to_list().
  VectorX angles(const py::handle& value, const std::string& place, const std::string& unit) const {
    return to_vector(value, place, arm->coordinates(), unit);
  }
  /// A point of its material. Throws Error(out-of-range).
  pcc::ArmPoint place(int segment, double fraction, const std::pair<double, double>& offset) const;

  std::shared_ptr<const pcc::Arm> arm;
  pcc::ArmEquations equations;
};

using PccArmClass = py::class_<PccArm>;

/// Sizes, places and equations of motion. @param arm where they go.
void bind_arm_equations(PccArmClass& arm);
/// equilibrium() and simulate(). @param arm where they go.
void bind_arm_simulation(PccArmClass& arm);

/// What a word means. @param word,place from Python, and the argument. @param choices all words.
/// Throws Error(unknown-choice).
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
