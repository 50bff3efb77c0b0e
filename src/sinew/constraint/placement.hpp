/// @file
/// Where the bodies are when constraints are evaluated.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::constraint {

/// Where the material points of all bodies are now.
class Placement {
 public:
  explicit Placement(std::span<const std::unique_ptr<mechanics::Body>> bodies) : bodies_(bodies) {}
  /// (3,) m.
  Vector3 position(const mechanics::MaterialPoint& point) const {
    return bodies_[static_cast<std::size_t>(point.body)]->position(point.point);
  }
  /// (3,) m/s.
  Vector3 velocity(const mechanics::MaterialPoint& point) const {
    return bodies_[static_cast<std::size_t>(point.body)]->velocity(point.point);
  }

 private:
  std::span<const std::unique_ptr<mechanics::Body>> bodies_;
};

}  // namespace sinew::constraint
