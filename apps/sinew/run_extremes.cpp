#include "run_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/quantity.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::cli {

namespace {

constexpr std::size_t kMostEffectors = 4;  // with rows of their own

// "long_0.tension" is a tension.
std::string quantity_of(const run::Observable& observable) {
  return observable.name.substr(observable.name.rfind('.') + 1);
}

// A value in a unit of suitable size, with four digits: "12.5 kPa".
std::string shown(double value, const std::string& unit) {
  // A torque is shown in N m: its dimension is that of an energy, whose unit is J.
  constexpr Dimension kKnown[] = {dimension::kLength, dimension::kForce, dimension::kPressure,
                                  dimension::kVolume};
  for (const Dimension known : kKnown) {
    try {
      if (!unit.empty() && parse_unit(unit, known) == 1.0) return rounded_quantity(value, known);
    } catch (const Error&) {  // it is a unit of something else
    }
  }
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

RunExtremes::RunExtremes(Session& session) : session_(session), observables_(session.simulation()) {
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    const run::Observable& one = observables_.list()[k];
    if (one.kind == run::ObservableKind::actuator && one.quantity == "effort") {
      efforts_.push_back(k);
    } else if (one.kind == run::ObservableKind::effector && effectors_.size() < kMostEffectors) {
      effectors_.push_back(k);
    }
  }
}

void RunExtremes::after_step() {
  const double time = session_.simulation().time();
  observables_.refresh();
  for (const std::size_t k : efforts_) {
    const double effort = observables_.read(k)[0];
    Peak& peak =
        peaks_.try_emplace(quantity_of(observables_.list()[k]), Peak{0.0, 0.0, k}).first->second;
    if (std::abs(effort) > std::abs(peak.value)) peak = {effort, time, k};
  }
  if (session_.controller() == nullptr) return;
  const double error = session_.error();
  ++steps_;
  error_sum_ += error;
  if (error <= error_max_) return;
  error_max_ = error;
  error_time_ = time;
}

// The error is the largest of all tasks, in m if none of them is an orientation.
void RunExtremes::add_errors(std::vector<std::vector<std::string>>& rows) const {
  if (steps_ == 0) return;
  const auto& tasks = session_.controller()->settings().tasks;
  const bool metres = std::ranges::all_of(tasks, [&](const control::EffectorTask& task) {
    return std::string_view(session_.robot().model->effector(task.effector).unit()) == "m";
  });
  const auto text = [&](double error) {
    return metres ? fmt::format("{:.4f} mm", 1e3 * error) : fmt::format("{:.4g} m or rad", error);
  };
  rows.push_back({"mean error of all steps", text(error_sum_ / static_cast<double>(steps_))});
  rows.push_back(
      {"max error of all steps", fmt::format("{} at {:g} s", text(error_max_), error_time_)});
}

void RunExtremes::add_effectors(std::vector<std::vector<std::string>>& rows) {
  observables_.refresh();
  for (const std::size_t k : effectors_) {
    const std::span<const double> v = observables_.read(k);
    const run::Observable& one = observables_.list()[k];
    const bool metres = one.unit == "m";
    const double scale = metres ? 1e3 : 1.0;
    rows.push_back(
        {"final " + one.name, fmt::format("({:.4f}, {:.4f}, {:.4f}) {}", scale * v[0], scale * v[1],
                                          scale * v[2], metres ? "mm" : one.unit)});
  }
}

// Of the last state: those of every step would take longer than the step.
void RunExtremes::add_stresses(std::vector<std::vector<std::string>>& rows) const {
  double stress = 0.0, stretch = 0.0;
  for (int b = 0; b < static_cast<int>(session_.simulation().model().bodies().size()); ++b) {
    const auto* body = mechanics::as<const fem::HasMaterial>(session_.simulation().body(b));
    if (body == nullptr) continue;
    for (const double value : fem::element_field(*body, fem::ElementField::von_mises_stress)) {
      stress = std::max(stress, value);
    }
    for (const double value : fem::element_field(*body, fem::ElementField::max_stretch)) {
      stretch = std::max(stretch, value);
    }
  }
  if (stretch == 0.0) return;
  rows.push_back({"final max von Mises stress", shown(stress, "Pa")});
  rows.push_back({"final max principal strain", fmt::format("{:.2f} %", 100.0 * (stretch - 1.0))});
}

std::vector<std::vector<std::string>> RunExtremes::rows() {
  std::vector<std::vector<std::string>> rows;
  add_errors(rows);
  for (const auto& [quantity, peak] : peaks_) {
    const run::Observable& one = observables_.list()[peak.observable];
    rows.push_back(
        {"peak " + quantity,
         fmt::format("{} of {} at {:g} s", shown(peak.value, one.unit), one.owner, peak.time)});
  }
  add_effectors(rows);
  add_stresses(rows);
  return rows;
}

}  // namespace sinew::cli
