/// @file
/// What every model of a robot is to those who look at it: material points, a state, energies. How
/// it takes part in a step is its StepSystem; what only some bodies can do is in capabilities.hpp.
/// Finite elements, reduced models, rods and constant-curvature arms are Bodies.
#pragma once

#include <cstddef>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/energies.hpp"

namespace sinew::mechanics {

class BodyModel;
class StepSystem;

/// The state of one body in one simulation.
class Body {
 public:
  virtual ~Body() = default;
  virtual const BodyModel& model() const = 0;

  /// Position (3,) m of an attached point.
  virtual Vector3 position(int point) const = 0;
  /// Rate (3,) of a site's motion: m/s; of an orientation, its angular velocity, rad/s; of a
  /// coordinate, (rate, 0, 0).
  virtual Vector3 velocity(int site) const = 0;
  /// Of the nodes of the model's mesh, (n, 3) m and m/s.
  virtual const Points& positions() const = 0;
  virtual const Points& velocities() const = 0;
  /// Evaluates its elements where they are not at the present state.
  virtual Energies energies() = 0;

  /// Back to the start: the model's own q and v. Inputs (outside forces) stay, but for where a base
  /// was asked to be.
  virtual void restart() = 0;
  /// q, v and what the integrator keeps as one array, for hashing and saving.
  virtual std::size_t state_size() const = 0;
  virtual void save_state(std::span<double> state) const = 0;
  virtual void load_state(std::span<const double> state) = 0;

  /// How it takes part in a step.
  virtual StepSystem& system() = 0;
  virtual const StepSystem& system() const = 0;

  /// Bytes of this body's own data, the model not counted.
  virtual std::size_t bytes() const = 0;
};

}  // namespace sinew::mechanics
