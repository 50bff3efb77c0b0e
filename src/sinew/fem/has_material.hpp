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
  /// See mechanics::ScalesStiffness.
  virtual double stiffness_factor() const = 0;
  /// Adds the force that rows put on each free node, as of the last linearisation.
  /// @param effort (rows,) N of the world's rows. @param forces (n, 3) N, added to.
  virtual void add_row_forces(std::span<const double> effort, Points& forces) const = 0;
};

}  // namespace sinew::fem
