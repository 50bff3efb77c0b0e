#include "sinew/builder/anchors.hpp"

#include <memory>

#include "sinew/constraint/effector.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

void add_anchors(model::ModelData& data, int body, std::span<const NodeId> part) {
  mechanics::BodyModel& on = data.body(body);
  const double stiffness = on.stiffness_scale();
  for (const int point : on.attach_anchors(part)) {
    const int constraint = data.declare(std::make_unique<constraint::PointEffector>(
        "anchor", mechanics::MaterialPoint{body, point}));
    data.anchors.push_back({body, constraint, stiffness});
  }
}

}  // namespace sinew::builder
