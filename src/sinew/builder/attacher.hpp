/// @file
/// Attachment of the points of a probe or sensor.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/site.hpp"

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

struct ProbeLine;
struct ProbeSpot;

/// Attaches the points of a probe or sensor to the bodies.
class Attacher {
 public:
  /// @param data with the bodies. @param what name of the part in messages: "probe 'bend'".
  /// @param place its source location. @param outside for points given by position.
  Attacher(model::ModelData& data, std::string what, Location place, mesh::Outside outside)
      : data_(data), what_(std::move(what)), place_(std::move(place)), outside_(outside) {}

  /// Attaches a point at rest. Throws Error(point-outside-mesh). @param body index.
  /// @param rest (3,) m.
  mechanics::MaterialPoint point(int body, const Vector3& rest);
  /// Attaches every node. Throws Error(empty-region). @param body index. @param list of its nodes.
  std::vector<mechanics::MaterialPoint> nodes(int body, const std::vector<NodeId>& list);
  /// Attaches the mean of a spot. Throws Error: point-outside-mesh, too-few-points.
  /// @param spot nodes or points of a body.
  mechanics::MaterialPoint mean(const ProbeSpot& spot);
  /// Attaches the samples of a line. Throws Error: point-outside-mesh, too-few-points.
  /// @param line through points of a body.
  std::vector<mechanics::MaterialPoint> line(const ProbeLine& line);
  /// (n, 3) m, rest positions. @param points that are attached.
  Points rest(const std::vector<mechanics::MaterialPoint>& points) const;
  /// A body. Throws Error(unknown-name). @param body index.
  mechanics::BodyModel& on(int body) const;
  const std::string& what() const { return what_; }

 private:
  model::ModelData& data_;
  std::string what_;
  Location place_;
  mesh::Outside outside_;
  int count_ = 0;
};

}  // namespace sinew::builder
