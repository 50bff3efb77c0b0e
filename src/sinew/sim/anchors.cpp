#include "sinew/sim/anchors.hpp"

#include <memory>

#include "sinew/constraint/effector.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/model_data.hpp"

namespace sinew::sim {

void add_anchors(ModelData& data, int body, std::span<const NodeId> part) {
  mechanics::BodyModel& on = data.body(body);
  const double stiffness = on.stiffness_scale();
  for (const int point : on.attach_anchors(part)) {
    const int constraint = data.declare(std::make_unique<constraint::PointEffector>(
        "anchor", mechanics::MaterialPoint{body, point}));
    data.anchors.push_back({body, constraint, stiffness});
  }
}

}  // namespace sinew::sim
