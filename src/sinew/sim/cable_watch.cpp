#include "sinew/sim/cable_watch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/cable_path.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

// A straight span that is beside its material by this part of the body's thickness has a lever,
// which is at most half of the thickness, and so a moment, wrong by a tenth or more.
constexpr double kStray = 0.05;
// The part of a pull that may be lost in dents, and pulls that are too small to judge, relative to
// the size of the body.
constexpr double kLost = 0.1, kSmallPull = 1e-3;

bool touches(const constraint::Cable& cable, int body) {
  return std::ranges::any_of(cable.material_points(),
                             [&](const auto& point) { return point.body == body; });
}

double millimetres(double metres) { return 1e3 * metres; }

}  // namespace

CableWatch::CableWatch(const Simulation& simulation, std::span<const WatchedCable> cables)
    : simulation_(simulation) {
  for (const WatchedCable& cable : cables) {
    Watched& one = cables_.emplace_back();
    one.cable = cable;
    one.path = std::make_unique<CablePath>(simulation, *simulation.model().cable(cable.actuator),
                                           embedders_);
  }
  embedders_.clear();
}

CableWatch::~CableWatch() = default;

void CableWatch::after_step() {
  ++steps_;
  const auto& configuration = simulation_.world().configuration();
  for (Watched& one : cables_) {
    const model::ActuatorState& state = simulation_.actuator(one.cable.actuator);
    one.slack = one.slack && state.slack;
    const bool told = state.command.kind == model::CommandKind::motion && !state.chosen;
    one.commanded = one.commanded && told;
    if (told) {
      one.least = std::min(one.least, state.setpoint);
      one.most = std::max(one.most, state.setpoint);
    }
    if (state.slack) continue;
    const Points points = simulation_.model().cable(one.cable.actuator)->points(configuration);
    const CablePath::Stray stray = one.path->stray(simulation_, points);
    if (stray.span != nullptr && stray.distance > kStray * stray.span->thickness &&
        stray.distance > one.stray) {
      one.stray = stray.distance;
      one.span = stray.span->from;
    }
    if (!told || one.cable.radius_given || !(state.motion > one.pulled)) continue;
    one.pulled = state.motion;
    one.lost = one.path->dents(simulation_, points);
  }
}

// Whether another cable of the same bodies pulls.
bool CableWatch::has_taut_neighbour(const Watched& one) const {
  const auto& own = simulation_.model().cable(one.cable.actuator)->material_points();
  return std::ranges::any_of(cables_, [&](const Watched& other) {
    if (&other == &one || other.slack) return false;
    const constraint::Cable& cable = *simulation_.model().cable(other.cable.actuator);
    return std::ranges::any_of(own, [&](const auto& point) { return touches(cable, point.body); });
  });
}

std::vector<Notice> CableWatch::of_slack(const Watched& one) const {
  if (!one.commanded || !one.slack || (one.least == 0.0 && one.most == 0.0)) return {};
  const std::string& name =
      simulation_.model().actuators()[static_cast<std::size_t>(one.cable.actuator)].name;
  const bool out = !(one.most > 0.0);
  return {{has_taut_neighbour(one) ? NoticeLevel::remark : NoticeLevel::warning,
           NoticeKind::slack_cable, one.cable.place,
           fmt::format("cable '{}' is slack in all {} steps: {}", name, steps_,
                       out ? fmt::format("its displacement of {:.3g} mm pays it out, and a cable "
                                         "cannot push",
                                         millimetres(one.least))
                           : fmt::format("it is pulled by {:.3g} mm, and its path shortens by more",
                                         millimetres(one.most))),
           out ? "pull it by a positive displacement" : "pull it farther, or command its tension"}};
}

std::vector<Notice> CableWatch::of_path(const Watched& one) const {
  std::vector<Notice> found;
  const std::string& name =
      simulation_.model().actuators()[static_cast<std::size_t>(one.cable.actuator)].name;
  if (one.stray > 0.0) {
    found.push_back(
        {NoticeLevel::warning, NoticeKind::bowstring, one.cable.place,
         fmt::format("cable '{}' runs straight from its point {} to the next one, like a "
                     "bowstring: where the body bends, it is up to {:.2g} mm beside the material "
                     "that it passes through at rest",
                     name, one.span, millimetres(one.stray)),
         "if it runs in a channel, write the distance of its guides, for instance guide_spacing: "
         "10 mm"});
  }
  if (one.pulled > kSmallPull * one.path->size && one.lost > kLost * one.pulled) {
    found.push_back(
        {NoticeLevel::warning, NoticeKind::bare_points, one.cable.place,
         fmt::format("cable '{}' is pulled by {:.2g} mm, of which {:.2g} mm only dent the material "
                     "at its points, and more on a finer mesh",
                     name, millimetres(one.pulled), millimetres(one.lost)),
         fmt::format("write the radius of its tube, for instance guide_radius: {:.1g} mm",
                     millimetres(0.5 * one.path->edge))});
  }
  return found;
}

std::vector<Notice> CableWatch::notices() const {
  std::vector<Notice> all;
  for (const Watched& one : cables_) {
    for (const auto& some : {of_slack(one), of_path(one)}) {
      all.insert(all.end(), some.begin(), some.end());
    }
  }
  return all;
}

}  // namespace sinew::sim
