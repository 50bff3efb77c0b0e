/// @file
/// Attachment of points and nodes to bodies.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew {
struct Location;
}
namespace sinew::mechanics {
class BodyModel;
}
namespace sinew::mesh {
enum class Outside;
}

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// Attaches the mean of points given by position. @return the index of the attached point.
/// @param body to attach to. @param points (n, 3) m, at rest.
/// @param outside treatment of points outside the mesh. @param what name of the point in messages.
/// @param place source location. Throws Error: too-few-points, point-outside-mesh, wrong-type.
int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Location& place);

/// Attaches the mean of one or more nodes. @return the index of the attached point.
int attach_mean(mechanics::BodyModel& body, std::span<const NodeId> nodes);

/// Attaches a node. @return the index of the attached point.
int attach_node(mechanics::BodyModel& body, NodeId node);

/// (n, 3) m, rest positions of attached points.
Points rest_positions(const model::ModelData& data,
                      const std::vector<mechanics::MaterialPoint>& points);

}  // namespace sinew::builder
