#include "sinew/scene/watched_cables.hpp"

#include <algorithm>

#include "sinew/model/model.hpp"

namespace sinew::scene {

std::vector<sim::WatchedCable> watched_cables(const Robot& robot) {
  std::vector<sim::WatchedCable> cables;
  for (const ActuatorDescription& actuator : robot.description.actuators) {
    const auto* cable = actuator.as<CableDescription>();
    if (cable == nullptr) continue;
    const bool told = std::ranges::any_of(robot.notices, [&](const Notice& notice) {
      return notice.kind == NoticeKind::bare_points && notice.place.text() == actuator.place.text();
    });
    cables.push_back({robot.model->actuator_index(actuator.name), actuator.place,
                      cable->guide_radius_given || told});
  }
  return cables;
}

}  // namespace sinew::scene
