#include "sinew/world/geometric_stiffness.hpp"

#include <algorithm>

#include "sinew/constraint/constraint.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/positive_part.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

namespace {

// Part of an anchor that is not cancelled where joints leave bodies free: a neutral motion (a door
// on a vertical hinge) has no other stiffness, and rounding would choose it. Efforts of anchors are
// part of no equilibrium, so it changes only the way to the solution. The laws of contacts would
// get its inverse as a compliance; they take efforts of least norm in its place.
constexpr double kKept = 1e-8;

}  // namespace

GeometricStiffness::GeometricStiffness(const model::Model& model,
                                       const constraint::Configuration& configuration,
                                       std::span<mechanics::StepSystem* const> systems,
                                       law::StepProblem& problem)
    : model_(model),
      configuration_(configuration),
      systems_(systems),
      problem_(problem),
      stiffness_pairs_(model.stiffness_pairs()),
      effort_(static_cast<std::size_t>(model.rows().rows())) {
  const auto add_rows = [&](int constraint, int count) {
    const int row = model.constraint(constraint).first_row();
    for (int k = 0; k < count; ++k) problem_.stiffness.push_back({row + k});
  };
  for (const model::AnchorModel& anchor : model.anchors()) add_rows(anchor.constraint, 3);
  anchor_rows_ = problem_.stiffness.size();
  for (const model::CouplingModel& coupling : model.couplings()) add_rows(coupling.constraint, 2);
}

void GeometricStiffness::begin(const mechanics::LinearisationRequest& request) {
  tangent_ = request.tangent;
  // In dynamics, inertia makes anchors unnecessary.
  const double kept = model_.is_loose() && model_.contacts().empty() ? kKept : 0.0;
  const double cancelled = request.weights.dynamic() ? 0.0 : 1.0 - kept;
  for (std::size_t k = 0; k < anchor_rows_; ++k) {
    problem_.stiffness[k].stiffness = -cancelled * model_.anchors()[k / 3].stiffness;
  }
}

void GeometricStiffness::choose(std::span<const double> effort, std::span<const int> constraints) {
  chosen_ = constraints;
  if (!constraints.empty()) std::ranges::copy(effort, effort_.begin());
}

void GeometricStiffness::add() {
  majorant_ = false;
  for (std::size_t k = anchor_rows_; k < problem_.stiffness.size(); ++k) {
    problem_.stiffness[k].stiffness = 0.0;
  }
  for (const int index : chosen_) {
    add_constraint(model_.constraint(index));
  }
  chosen_ = {};
  add_anchors();
}

void GeometricStiffness::add_constraint(const constraint::Constraint& constraint) {
  const std::span<const double> effort(effort_);
  const std::span<mechanics::StiffnessPair> pairs(
      stiffness_pairs_.data() + constraint.first_stiffness_pair(),
      static_cast<std::size_t>(constraint.stiffness_pair_count()));
  const auto own = effort.subspan(static_cast<std::size_t>(constraint.first_row()),
                                  static_cast<std::size_t>(constraint.row_count()));
  if (std::ranges::all_of(own, [](double lambda) { return lambda == 0.0; })) return;
  constraint.geometric_stiffness(configuration_, effort, pairs);
  const bool exact = tangent_ == mechanics::Tangent::exact || constraint.stiffens(effort);
  for (const auto& pair : pairs) {
    if (exact && pair.first.body == pair.second.body) {
      systems_[static_cast<std::size_t>(pair.first.body)]->add_geometric_stiffness(pair);
    } else if (exact) {
      couple(pair);
    } else {
      majorant_ = true;
      add_majorant(pair);
    }
  }
}

void GeometricStiffness::add_to(const mechanics::MaterialPoint& point, const Matrix3& hessian) {
  systems_[static_cast<std::size_t>(point.body)]->add_geometric_stiffness({point, point, hessian});
}

// A cable segment between two bodies: its C = T/l (I - n n^T), which the pairs of each point with
// itself have added to the bodies, becomes a spring T/l along the rows of its coupling.
void GeometricStiffness::couple(const mechanics::StiffnessPair& pair) {
  for (const mechanics::MaterialPoint& point : {pair.first, pair.second}) {
    add_to(point, pair.hessian);
  }
  const auto index = static_cast<int>(&pair - stiffness_pairs_.data());
  const auto& couplings = model_.couplings();
  const auto found = std::ranges::find(couplings, index, &model::CouplingModel::pair);
  const auto first = anchor_rows_ + 2 * static_cast<std::size_t>(found - couplings.begin());
  for (std::size_t k = first; k < first + 2; ++k) {
    problem_.stiffness[k].stiffness = 0.5 * pair.hessian.trace();
  }
}

// A pair (x_i, x_j) with block C adds -C at (i, j) and -C^T at (j, i) to A. Its majorant is |C| I
// at (i, i) and (j, j), which bounds the off-diagonal blocks; a pair of one point contributes its
// positive part. Only the points' diagonal blocks change.
void GeometricStiffness::add_majorant(const mechanics::StiffnessPair& pair) {
  if (pair.first == pair.second) {
    return add_to(pair.first, -linalg::positive_part(Matrix3(-pair.hessian)));
  }
  const Matrix3 bound = pair.hessian.norm() * Matrix3::Identity();
  add_to(pair.first, -bound);
  add_to(pair.second, -bound);
}

void GeometricStiffness::add_anchors() {
  for (std::size_t k = 0; k < anchor_rows_; k += 3) {
    const auto& [row, stiffness] = problem_.stiffness[k];
    if (stiffness == 0.0) continue;
    const auto entry = model_.rows().row_start[static_cast<std::size_t>(row)];
    add_to({model_.rows().site[static_cast<std::size_t>(entry)]},
           -model_.anchors()[k / 3].stiffness * Matrix3::Identity());
  }
}

}  // namespace sinew::world
