/// @file
/// Points of one part that measures, on the bodies.
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

namespace sinew::sim {

struct ModelData;
struct ProbeLine;
struct ProbeSpot;

/// Attaches points of a probe or a sensor to the bodies.
class Attacher {
 public:
  /// @param data with the bodies. @param what names the part: "probe 'bend'". @param place where it
  /// is written. @param outside for points given by position.
  Attacher(ModelData& data, std::string what, Location place, mesh::Outside outside)
      : data_(data), what_(std::move(what)), place_(std::move(place)), outside_(outside) {}

  /// A point at rest. Throws Error(point-outside-mesh). @param body its number. @param rest (3,) m.
  mechanics::MaterialPoint point(int body, const Vector3& rest);
  /// Each node. Throws Error(empty-region). @param body its number. @param list of its nodes.
  std::vector<mechanics::MaterialPoint> nodes(int body, const std::vector<NodeId>& list);
  /// Throws Error: point-outside-mesh, too-few-points. @param spot see there.
  mechanics::MaterialPoint mean(const ProbeSpot& spot);
  /// The samples of a line. Throws Error: point-outside-mesh, too-few-points. @param line see
  /// there.
  std::vector<mechanics::MaterialPoint> line(const ProbeLine& line);
  /// (n, 3) m. @param points that are attached.
  Points rest(const std::vector<mechanics::MaterialPoint>& points) const;
  /// A body. Throws Error(unknown-name). @param body its number.
  mechanics::BodyModel& on(int body) const;
  const std::string& what() const { return what_; }

 private:
  ModelData& data_;
  std::string what_;
  Location place_;
  mesh::Outside outside_;
  int count_ = 0;
};

}  // namespace sinew::sim
