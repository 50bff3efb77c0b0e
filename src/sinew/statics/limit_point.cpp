#include "sinew/statics/limit_point.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/run/run.hpp"

namespace sinew::statics {

namespace {

// A chamber is near its limit point if its pressure increases per volume by less than the inverse
// of this, relative to its mean increase so far.
constexpr double kFlat = 5.0;

}  // namespace

std::string describe_limit_point(const run::Run& run, std::span<const law::ActuatorBlock> goal) {
  for (std::size_t i = 0; i < run.model->actuators().size(); ++i) {
    const model::ActuatorModel& model = run.model->actuators()[i];
    if (!model.kind->swells() || goal[i].kind != model::CommandKind::effort) continue;
    const double reached = run.effort[static_cast<std::size_t>(model.row)];
    const double grown = run.world.delta()[model.row];
    const double compliance = run.world.problem().compliance(model.row, model.row);
    const bool flat = compliance < 0.0 || compliance * reached > kFlat * grown;
    const bool short_of = std::abs(reached) < std::abs(goal[i].value);
    if (!(reached * grown > 0.0) || !flat || !short_of) continue;
    return fmt::format(
        "chamber '{}' has no equilibrium at {:.4g} kPa: about {:.4g} kPa its pressure reaches a "
        "peak (limit point), where it has grown by {:.4g} ml",
        model.name, 1e-3 * goal[i].value, 1e-3 * reached, 1e6 * grown);
  }
  return {};
}

}  // namespace sinew::statics
