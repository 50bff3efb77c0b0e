/// @file
/// External loads and base motions of a run.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/model/signal.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::world {
class Bodies;
}

namespace sinew::run {

/// The load factors over time, and the prescribed motions of bases.
class Surroundings {
 public:
  /// Both must outlive it. @param model with the loads and base motions.
  /// @param bodies of the model.
  Surroundings(const model::Model& model, world::Bodies& bodies);

  /// (loads,) factors over time.
  const std::vector<model::Signal>& factors() const { return factors_; }
  /// @param load index of Model::loads(). @param factor from the next step on.
  void set_factor(int load, model::Signal factor);
  /// @param factors (loads,).
  void set_factors(const std::vector<model::Signal>& factors) { factors_ = factors; }
  /// (loads,) factors applied last; 0 at the start.
  const std::vector<double>& applied() const { return applied_; }

  /// Prescribes the base positions that the model defines at a time, s.
  void move_bases(double time);
  /// The same within a step; rigid bases are moved there at once.
  void put_bases(double time);
  /// Sets the velocities of rigid bases to those that the model defines.
  /// @param time s. @param side of a corner of the motion there.
  void set_base_rates(double time, model::Signal::Side side);
  /// See Simulation::move_base().
  void move_base(int body, const Vector3& translation, const Vector3& rotation,
                 const Vector3& centre);
  /// Applies all loads with their factors at a time, s.
  void apply(double time);
  /// Applies one load with a factor.
  void apply(std::size_t load, double factor);

  /// Restores the model's factors; none counts as applied.
  void restart();

 private:
  const model::Model& model_;
  world::Bodies& bodies_;
  std::vector<model::Signal> factors_;
  std::vector<double> applied_;
};

}  // namespace sinew::run
