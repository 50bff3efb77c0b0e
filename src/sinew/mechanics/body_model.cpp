#include "sinew/mechanics/body_model.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

std::vector<HeldDirection> held_as_a_whole(const Vector3& at) {
  std::vector<HeldDirection> held;
  for (const bool turn : {false, true}) {
    for (int axis = 0; axis < 3; ++axis) held.push_back({at, Vector3::Unit(axis), turn});
  }
  return held;
}

const mesh::Mesh& BodyModel::mesh() const {
  throw Error(ErrorKind::wrong_type, {.item = fmt::format("body '{}'", name())},
              "this body has no mesh", "name a body with nodes");
}

}  // namespace sinew::mechanics
