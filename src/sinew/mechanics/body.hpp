/// @file
/// Interface of all bodies: attached points, state and energies. The equation of a step is in the
/// StepSystem of a body, and what only some bodies can do is in capabilities.hpp.
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
  /// Velocity (3,) of a site: m/s; for an orientation the angular velocity, rad/s; for a coordinate
  /// (rate, 0, 0).
  virtual Vector3 velocity(int site) const = 0;
  /// Positions and velocities, (n, 3) m and m/s, of the points that show the body: the nodes of the
  /// model's mesh, if it has one.
  virtual const Points& positions() const = 0;
  virtual const Points& velocities() const = 0;
  /// Energies of the current state. Evaluates the elements if necessary.
  virtual Energies energies() = 0;

  /// Returns to the initial q and v of the model. Inputs (such as external forces) are kept, except
  /// the requested displacement of the base.
  virtual void restart() = 0;
  /// The state (q, v, history of the integrator, ...) as one array, for hashing and saving.
  virtual std::size_t state_size() const = 0;
  virtual void save_state(std::span<double> state) const = 0;
  virtual void load_state(std::span<const double> state) = 0;

  /// The equations of the body in a step.
  virtual StepSystem& system() = 0;
  virtual const StepSystem& system() const = 0;

  /// Memory of this body in bytes, without the model.
  virtual std::size_t bytes() const = 0;
};

}  // namespace sinew::mechanics
