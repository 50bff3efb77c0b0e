/// @file
/// Capability of finite-element bodies, in addition to mechanics::Body.
#pragma once

#include <span>

#include "sinew/core/types.hpp"

namespace sinew::fem {

class ElementHistory;
class HasElements;

/// A body that consists of finite elements: mechanics::as<const HasMaterial>(body). Positions and
/// external forces are those of mechanics::Body and TakesForces.
class HasMaterial {
 public:
  virtual ~HasMaterial() = default;
  /// Its model.
  virtual const HasElements& material() const = 0;
  virtual const Points& positions() const = 0;
  virtual const Points& external_forces() const = 0;
  /// (n, 3) N: forces of the loads on all nodes, from the last linearisation.
  virtual Points load_forces() const = 0;
  /// Strain history of its elements.
  virtual const ElementHistory& history() const = 0;
  /// Factor of the stresses of its elements at a given strain, and thus of their stiffness damping.
  /// It does not scale membranes. Like external forces, it is an input and not part of the state;
  /// it is 1 initially.
  virtual double stiffness_factor() const = 0;
  /// Does not count the jump of the strain energy; sim::Simulation::set_stiffness_factor() does.
  /// @param factor > 0, finite.
  virtual void set_stiffness_factor(double factor) = 0;
  /// Adds the force that rows put on each free node, as of the last linearisation.
  /// @param effort (rows,) N of the world's rows. @param forces (n, 3) N, added to.
  virtual void add_row_forces(std::span<const double> effort, Points& forces) const = 0;
};

}  // namespace sinew::fem
