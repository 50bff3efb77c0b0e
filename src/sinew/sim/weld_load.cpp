#include "sinew/sim/weld_load.hpp"

#include <Eigen/Geometry>

#include "sinew/constraint/placement.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

WeldLoad weld_load(const Simulation& simulation, int weld) {
  const constraint::Tie& tie = simulation.model().weld(weld);
  const constraint::Placement& placement = simulation.placement();
  WeldLoad load;
  load.gap = tie.largest_gap(placement);
  for (const auto& pair : tie.pairs()) load.centre += placement.position(pair.first);
  load.centre /= static_cast<double>(tie.pairs().size());
  for (std::size_t k = 0; k < tie.pairs().size(); ++k) {
    const Eigen::Map<const Vector3> force(simulation.efforts().data() + tie.row(k));
    load.force += force;
    load.moment += (placement.position(tie.pairs()[k].first) - load.centre).cross(Vector3(force));
  }
  return load;
}

}  // namespace sinew::sim
