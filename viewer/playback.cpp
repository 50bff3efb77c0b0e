#include "playback.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/state.hpp"

namespace sinew::viewer {

void Playback::check(const RecordedState& recorded) const {
  for (const auto& [index, numbers] : recorded.values) {
    const run::Observable& one = observables_.list().at(index);
    const auto refuse = [&](const std::string& what) {
      throw Error(ErrorKind::malformed_file, {.item = one.name}, what,
                  "record the run again with this version");
    };
    if (numbers.size() != one.size()) {
      refuse(fmt::format("{} numbers are recorded, its scene has {}", numbers.size(), one.size()));
    }
    if (one.words.empty()) continue;
    for (const double number : numbers) {
      if (one.word(number).empty())
        refuse(fmt::format("{} is recorded, which does not stand for a word", number));
    }
  }
}

void Playback::put_body(const run::Observable& what, const std::vector<double>& numbers,
                        run::State& state) const {
  const int body = simulation_.model().body_index(what.owner);
  if (mechanics::as<const mechanics::HasPose>(simulation_.body(body)) != nullptr) return;
  const bool of_coordinates =
      mechanics::as<const mechanics::HasCoordinates>(simulation_.body(body)) != nullptr;
  if (what.quantity != (of_coordinates ? "coordinates" : "positions")) return;
  std::vector<double>& own = state.bodies[static_cast<std::size_t>(body)];
  std::ranges::fill(own, 0.0);  // a state at rest
  std::ranges::copy(numbers, own.begin());
}

// Sets the poses of rigid bodies, which are recorded as position and rotation.
void Playback::put_poses(const RecordedState& recorded, run::State& state) const {
  for (int body = 0; body < simulation_.bodies(); ++body) {
    const auto* rigid = mechanics::as<const mechanics::HasPose>(simulation_.body(body));
    if (rigid == nullptr) continue;
    const std::string& name = simulation_.body(body).model().name();
    const std::vector<double>* position = nullptr;
    const std::vector<double>* rotation = nullptr;
    for (const auto& [index, numbers] : recorded.values) {
      const run::Observable& one = observables_.list()[index];
      if (one.kind != run::ObservableKind::body || one.owner != name) continue;
      if (one.quantity == "position") position = &numbers;
      if (one.quantity == "rotation") rotation = &numbers;
    }
    if (position == nullptr || rotation == nullptr) continue;
    const std::vector<double>& q = *rotation;
    rigid->put_pose(Vector3(position->data()), Eigen::Quaterniond(q[0], q[1], q[2], q[3]),
                    state.bodies[static_cast<std::size_t>(body)]);
  }
}

// Sets an actuator. Its command is the recorded one, whether from a controller or the scene.
void Playback::put_actuator(const run::Observable& what, double number, run::State& state) {
  const int index = simulation_.model().actuator_index(what.owner);
  const auto place = static_cast<std::size_t>(index);
  const model::ActuatorModel& actuator = simulation_.model().actuators()[place];
  if (what.quantity == "effort") state.efforts[static_cast<std::size_t>(actuator.row)] = number;
  if (what.quantity == "motion") state.motions[place] = state.setpoints[place] = number;
  for (const model::CommandKind kind : sim::command_kinds(actuator)) {
    if (what.name != sim::command_name(actuator, kind) || !std::isfinite(number)) continue;
    // Older versions recorded pressures below vacuum.
    const bool pressure = kind == model::CommandKind::effort && actuator.vacuum.has_value();
    const double told = pressure ? std::max(number, *actuator.vacuum) : number;
    simulation_.command(index, {kind, model::Signal::constant(told)});
  }
}

void Playback::show(const RecordedState& recorded) {
  check(recorded);
  observables_.release();
  run::State state = simulation_.state();
  for (const auto& [index, numbers] : recorded.values) {
    const run::Observable& one = observables_.list()[index];
    if (one.kind == run::ObservableKind::body) {
      put_body(one, numbers, state);
      continue;
    }
    observables_.hold(index, numbers);
    if (one.kind == run::ObservableKind::actuator) put_actuator(one, numbers.front(), state);
  }
  put_poses(recorded, state);
  state.volume_ratio = 1.0;  // not recorded
  state.steps = recorded.step;
  simulation_.restore(state);
}

}  // namespace sinew::viewer
