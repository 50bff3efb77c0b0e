/// @file
/// Coulomb friction of cables at the points that they slide through, around any law.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/sim/law.hpp"

namespace sinew::sim {

struct GuideModel;

/// A guide's range: its cable stays where it is while friction can hold it.
/// @param guide of the model. @param delta (rows,) m, at the start of the step.
ActuatorRange guide_range(const GuideModel& guide, const VectorX& delta);

/// At guide i, which the cable reaches under T_before from the pull point's side and leaves under
/// T_behind, F_i = T_before - T_behind and, after Euler (1762), with e = e^(-mu theta_i),
///   -(1 - e) T_behind <= F_i <= (1 - e) T_before,
/// the cable sticking (no motion of the row) in between, sliding towards the pull point at the
/// upper limit and away from it at the lower one. With limits given, that is the graph of a row
/// held at a motion by a limited effort, which the direct law solves exactly, stick and slip
/// (Tresca's friction); the limits then follow the tensions that came out, until they stay (the
/// fixed point of Necas, Jarusek & Haslinger 1980). For a cable whose length is held the iteration
/// contracts about as A/(2 pi), A = mu times its wrap; one under a given tension ends after as many
/// rounds as guides.
///
/// A controller chooses tensions for the friction forces of the round before; friction then follows
/// from those tensions, exactly. A few such rounds a step leave the controller's prediction behind
/// where cables begin to slide or stick; its next step makes up for it.
class FrictionLaw : public Law {
 public:
  explicit FrictionLaw(const Model& model);

  /// @param direct finds efforts of all ranges, those of guides within their limits.
  /// @param controller chooses those of actuators in its place; may be null.
  FrictionLaw& around(Law& direct, Law* controller) {
    direct_ = &direct;
    controller_ = controller;
    return *this;
  }
  LawStatus solve(const LawProblem& problem, std::span<double> effort) override;
  double violation(const LawProblem& problem, std::span<const double> effort) const override;
  void begin_step() override {}

 private:
  LawStatus slide(const LawProblem& problem, std::span<double> effort);
  LawStatus control(const LawProblem& problem, std::span<double> effort);
  bool follow(std::span<const double> effort, double share);

  const Model& model_;
  Law* direct_ = nullptr;
  Law* controller_ = nullptr;
  std::vector<double> grip_;                 // (guides,) 1 - e^(-mu theta)
  std::vector<std::array<double, 2>> next_;  // (guides,) N, limits that follow from the tensions
  std::vector<ActuatorRange> ranges_;
  std::vector<double> before_, chosen_;  // (rows,) efforts: of the last step, the controller's
  VectorX delta_free_;                   // (rows,) with friction of the round before
};

}  // namespace sinew::sim
