/// @file
/// What the robot's tangent has beside that of its bodies.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::constraint {
class Constraint;
class Configuration;
}  // namespace sinew::constraint
namespace sinew::mechanics {
struct LinearisationRequest;
class StepSystem;
}  // namespace sinew::mechanics
namespace sinew::step {
struct StepProblem;
}

namespace sinew::sim {

class Model;

/// The geometric stiffness of constraints under load, and the anchors of bodies that
/// only joints hold. What stands on the points of one body is added to its A; what couples two, and
/// what anchors must not add to the robot, goes into the step's problem as blocks of stiffness.
class GeometricStiffness {
 public:
  /// All must outlive it. @param model whose constraints they are. @param configuration of its
  /// bodies. @param systems of the bodies. @param problem gets the blocks of stiffness of anchors
  /// and couplings.
  GeometricStiffness(const Model& model, const constraint::Configuration& configuration,
                     std::span<mechanics::StepSystem* const> systems, step::StepProblem& problem);

  /// Before the bodies linearise: anchors stand in statics alone.
  void begin(const mechanics::LinearisationRequest& request);
  /// Of which constraints the next add() takes it. @param effort (rows,) N, at which it does; is
  /// copied. @param constraints indices; must last until then.
  void choose(std::span<const double> effort, std::span<const int> constraints);
  /// Adds it to the bodies: as it is, or, where the linearisation's tangent is not
  /// exact, what is never less and positive semi-definite; and the anchors.
  void add();
  /// Whether a majorant of it stands in A, which is then no derivative.
  bool has_majorant() const { return majorant_; }
  std::size_t bytes() const { return stiffness_pairs_.size() * sizeof(mechanics::StiffnessPair); }

 private:
  void add_constraint(const constraint::Constraint& constraint);
  void add_to(const mechanics::MaterialPoint& point, const Matrix3& hessian);
  void couple(const mechanics::StiffnessPair& pair);
  void add_majorant(const mechanics::StiffnessPair& pair);
  void add_anchors();

  const Model& model_;
  const constraint::Configuration& configuration_;
  std::span<mechanics::StepSystem* const> systems_;
  step::StepProblem& problem_;
  std::vector<mechanics::StiffnessPair> stiffness_pairs_;
  std::vector<double> effort_;   // (rows,) N, of the chosen
  std::span<const int> chosen_;  // constraints whose geometric stiffness add() adds
  mechanics::Tangent tangent_ = mechanics::Tangent::corotated;
  bool majorant_ = false;
  std::size_t anchor_rows_ = 0;  // of problem_.stiffness; behind them those of couplings
};

}  // namespace sinew::sim
