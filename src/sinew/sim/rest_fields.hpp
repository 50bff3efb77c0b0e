/// @file
/// Linear response of one body at rest to everything that acts on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::sim {

/// Displacements for a unit of one cause.
struct RestField {
  std::string cause;  ///< name of an actuator or load, or "gravity"
  Points nodes;       ///< (n, 3) m per N, Pa or unit of the load factor; for gravity m
};

/// Solves K u = f at rest for one finite-element body and every force f that acts on it: a unit
/// effort of each actuator, each load at a factor of 1, and gravity (not of a free body). Other
/// bodies do not move, and joints and contacts exert no forces. A body that is free gets the part
/// of f that deforms it,
///   f - M R (R^T M R)^-1 R^T f   with the rigid motions R
/// (inertia relief), and K + M/h^2 in place of K, with h a hundred times as long as sound takes
/// through the body.
/// @param model,body with elements; its index.
/// @return one field per cause, in the order above, without those that exert no force; empty if K
///   is not positive definite.
std::vector<RestField> rest_fields(const std::shared_ptr<const model::Model>& model, int body);

}  // namespace sinew::sim
