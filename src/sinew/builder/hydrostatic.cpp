#include "sinew/builder/hydrostatic.hpp"

#include "sinew/mechanics/bears_loads.hpp"

namespace sinew::builder {

mechanics::PressureLoad hydrostatic(const mechanics::BearsLoads& body,
                                    const std::vector<mesh::Face>& faces, double density,
                                    std::optional<double> level) {
  const Vector3& gravity = body.gravity();
  mechanics::PressureLoad load{.faces = faces, .gradient = density * gravity};
  if (level && !gravity.isZero(0.0)) {
    load.level = -*level * gravity.normalized();
    load.only_positive = true;
    return load;
  }
  const Points& nodes = body.load_mesh().nodes;
  double count = 0.0;
  for (const mesh::Face& face : faces) {
    for (const NodeId node : face.nodes()) {
      load.level += nodes.row(node).transpose();
      count += 1.0;
    }
  }
  if (count > 0.0) load.level /= count;
  return load;
}

}  // namespace sinew::builder
