/// @file
/// Where the bodies are when constraints are evaluated.
#pragma once

#include <memory>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::mechanics {
class Body;
}

namespace sinew::constraint {

/// Where the material points of all bodies are now.
class Placement {
 public:
  explicit Placement(std::span<const std::unique_ptr<mechanics::Body>> bodies) : bodies_(bodies) {}
  /// (3,) m.
  Vector3 position(const mechanics::MaterialPoint& point) const;
  /// (3,) m/s.
  Vector3 velocity(const mechanics::MaterialPoint& point) const;

 private:
  std::span<const std::unique_ptr<mechanics::Body>> bodies_;
};

}  // namespace sinew::constraint
