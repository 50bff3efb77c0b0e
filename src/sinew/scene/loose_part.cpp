// Notices about parts of a mesh that hang on the others by a node or an edge.
#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/rigid_parts.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

// Parts that are held each for itself cannot move.
std::optional<Notice> loose_part_notice(const Location& place, const mechanics::BodyModel& body) {
  const auto* parts = mechanics::as<const mechanics::MovesByNodes>(body);
  if (parts == nullptr) return {};
  const std::vector<mesh::HeldAxis> held = parts->held_axes();
  const mesh::Mesh& mesh = body.mesh();
  const std::vector<mesh::LooseJoint> loose = mesh::loose_joints(mesh);
  if (loose.empty() || (!held.empty() && mesh::loose_joints(mesh, held).empty())) return {};
  const std::string more =
      loose.size() > 1 ? fmt::format("; {} parts in all are joined so", loose.size()) : "";
  return Notice{NoticeLevel::warning, NoticeKind::loose_part, place,
                fmt::format("a part of the mesh can move without deforming: {}{}",
                            mesh::describe(loose.front(), mesh), more),
                "remove the loose elements, or join them by whole faces"};
}

}  // namespace sinew::scene
