/// @file
/// Contributions to the tangent beyond the stiffness of the bodies.
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
namespace sinew::law {
struct StepProblem;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// The geometric stiffness of loaded constraints, and the anchors of bodies that only joints hold.
/// Terms on points of one body are added to its A. Terms that couple two bodies, and the terms that
/// cancel the anchors, become stiffness blocks of the step's problem.
class GeometricStiffness {
 public:
  /// All must outlive it. @param model with the constraints. @param configuration of its bodies.
  /// @param systems of the bodies.
  /// @param problem receives the stiffness blocks of anchors and couplings.
  GeometricStiffness(const model::Model& model, const constraint::Configuration& configuration,
                     std::span<mechanics::StepSystem* const> systems, law::StepProblem& problem);

  /// Call before the bodies linearise. Anchors act in statics only.
  void begin(const mechanics::LinearisationRequest& request);
  /// Chooses the constraints whose geometric stiffness the next add() adds.
  /// @param effort (rows,) N, copied. @param constraints indices; must stay valid until then.
  void choose(std::span<const double> effort, std::span<const int> constraints);
  /// Adds the geometric stiffness and the anchors to the bodies. If the tangent of the
  /// linearisation is not exact, terms that may soften are replaced by a positive semidefinite
  /// majorant.
  void add();
  /// Whether A contains such a majorant, and is therefore not the derivative.
  bool has_majorant() const { return majorant_; }
  std::size_t bytes() const { return stiffness_pairs_.size() * sizeof(mechanics::StiffnessPair); }

 private:
  void add_constraint(const constraint::Constraint& constraint);
  void add_to(const mechanics::MaterialPoint& point, const Matrix3& hessian);
  void couple(const mechanics::StiffnessPair& pair);
  void add_majorant(const mechanics::StiffnessPair& pair);
  void add_anchors();

  const model::Model& model_;
  const constraint::Configuration& configuration_;
  std::span<mechanics::StepSystem* const> systems_;
  law::StepProblem& problem_;
  std::vector<mechanics::StiffnessPair> stiffness_pairs_;
  std::vector<double> effort_;   // (rows,) N, for the chosen constraints
  std::span<const int> chosen_;  // constraints for the next add()
  mechanics::Tangent tangent_ = mechanics::Tangent::corotated;
  bool majorant_ = false;
  std::size_t anchor_rows_ = 0;  // of problem_.stiffness; those of couplings follow
};

}  // namespace sinew::world
