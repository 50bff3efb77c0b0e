/// @file
/// Points and nodes of bodies as attached points.
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

namespace sinew::sim {

struct ModelData;

/// The mean of points given by position, as one attached point. @return its number.
/// @param body,points,outside (n, 3) m on it, at rest. @param what names it in messages.
/// @param place of what is declared. Throws Error: too-few-points, point-outside-mesh, wrong-type.
int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Location& place);

/// The mean of nodes, one or more, as one attached point. @return its number.
int attach_mean(mechanics::BodyModel& body, std::span<const NodeId> nodes);

/// @return the number of the attached point.
int attach_node(mechanics::BodyModel& body, NodeId node);

/// (n, 3) m.
Points rest_positions(const ModelData& data, const std::vector<mechanics::MaterialPoint>& points);

}  // namespace sinew::sim
