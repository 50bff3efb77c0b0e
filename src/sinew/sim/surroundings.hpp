/// @file
/// What acts on the bodies of a run from outside, over time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/signal.hpp"

namespace sinew::sim {

class Bodies;
class Model;

/// The factors of loads, and where bases are asked to be.
class Surroundings {
 public:
  /// Both outlive it. @param model with the loads and motions of bases. @param bodies of the model.
  Surroundings(const Model& model, Bodies& bodies);

  /// (loads,) over time.
  const std::vector<Signal>& factors() const { return factors_; }
  /// @param load index of Model::loads(). @param factor from the next step on.
  void set_factor(int load, Signal factor);
  /// @param factors (loads,).
  void set_factors(const std::vector<Signal>& factors) { factors_ = factors; }
  /// (loads,) factors that acted last; 0 at the start.
  const std::vector<double>& applied() const { return applied_; }

  /// Asks bases that the model moves to be where they are at a time, s.
  void move_bases(double time);
  /// The same in the middle of a step: rigid bodies among them are there at once.
  void put_bases(double time);
  /// Rigid bodies among them get the velocities that the model gives them.
  /// @param time s. @param side of a corner of the motion there.
  void set_base_rates(double time, Signal::Side side);
  /// See Simulation::move_base().
  void move_base(int body, const Vector3& translation, const Vector3& rotation,
                 const Vector3& centre);
  /// Every load by its factor at a time, s.
  void apply(double time);
  /// One load.
  void apply(std::size_t load, double factor);

  /// Factors of the model, none of which has acted.
  void restart();

 private:
  const Model& model_;
  Bodies& bodies_;
  std::vector<Signal> factors_;
  std::vector<double> applied_;
};

}  // namespace sinew::sim
