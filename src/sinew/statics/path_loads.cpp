#include "sinew/statics/path_loads.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/run/run.hpp"

namespace sinew::statics {

PathLoads::PathLoads(run::Run& run) : run_(run) {
  run_.read_commands(run_.time(), kInfinity);
  const std::vector<model::ActuatorState>& actuators = run_.actuation.states();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const law::ActuatorBlock& range = run_.world.problem().actuators[i];
    const bool fixed = range.owned || range.drive != nullptr;
    const double told = range.owned ? actuators[i].effort : range.value;
    if (!range.owned && (fixed || range.kind != model::CommandKind::effort)) {
      throw Error(
          ErrorKind::bad_argument,
          {.item = fmt::format("actuator '{}'", run_.model->actuators()[i].name)},
          "a path grows loads and commanded efforts; this actuator has a drive or is told a "
          "motion",
          "command its effort; what is held at a motion needs no path: solve_static() "
          "passes limit points by itself");
    }
    efforts_.push_back({actuators[i].effort, told});
  }
  const run::Surroundings& loads = run_.surroundings;
  for (std::size_t k = 0; k < loads.applied().size(); ++k) {
    loads_.push_back({loads.applied()[k], loads.factors()[k].value(run_.time())});
  }
}

void PathLoads::set_fraction(double fraction) {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    const auto [from, to] = loads_[k];
    run_.surroundings.apply(k, from + fraction * (to - from));
  }
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    const auto [from, to] = efforts_[i];
    const int row = run_.model->actuators()[i].row;
    run_.effort[static_cast<std::size_t>(row)] = from + fraction * (to - from);
  }
}

}  // namespace sinew::statics
