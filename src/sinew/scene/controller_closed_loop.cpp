// Controllers of type closed-loop: assigns sensors to effectors, and checks whether the loop can
// work.
#include <algorithm>
#include <any>
#include <memory>
#include <ranges>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/control/closed_loop.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/sense/sensor_set.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> closed_loop_table() {
  return make_table(
      {.name = "controller: type closed-loop",
       .description =
           "Feedback on effectors that sensors measure: before each step, it commands motions of "
           "actuators, and pressures of chambers, that move the effectors to their targets.",
       .keys = {tasks_key(true),
                {.name = "sensors",
                 .forms = {list({reference("sensors")})},
                 .example = "[tip]",
                 .description = "Sensors that measure the effectors: for each effector, a marker "
                                "at its point or an orientation at its points.",
                 .required = true},
                driven_key(),
                {.name = "gain",
                 .forms = {quantity(frequency(), positive())},
                 .example = "8 1/s",
                 .default_text = "5 1/s",
                 .description = "Velocity per error: an error decays as exp(-gain t)."},
                {.name = "integral",
                 .forms = {quantity(integral_gain(), non_negative())},
                 .example = "4 1/s^2",
                 .default_text = "0 1/s^2",
                 .description =
                     "Velocity per time integral of the error; gain^2/4 gives critical damping."},
                {.name = "timeout",
                 .forms = {quantity(time(), positive())},
                 .example = "50 ms",
                 .default_text = "100 ms",
                 .description = "All commands are held while the last sample of a sensor is older "
                                "than the sensor's delay plus this time."}}});
}

}  // namespace
}  // namespace forms

namespace {

// Error below which a measured effector counts as on target, m or rad.
constexpr double kMeasuredTolerance = 5e-4;

using Kind = EffectorDescription::Kind;

std::string point_text(const Points& points) {
  std::string text;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    text += fmt::format("{}{:g} {:g} {:g}", k > 0 ? ", " : "", 1e3 * points(k, 0),
                        1e3 * points(k, 1), 1e3 * points(k, 2));
  }
  return text + " mm";
}

bool turns(const EffectorDescription& effector) { return effector.kind == Kind::orientation; }

// A sensor that would measure an effector, as written in a scene.
std::string sensor_for(const EffectorDescription& effector) {
  const std::string spot =
      effector.kind == Kind::set ? "set: " + effector.set
      : effector.points.points.rows() == 1
          ? (turns(effector) ? "at: " : "point: ") + point_text(effector.points.points)
          : (turns(effector) ? "at: [" : "points: [") + point_text(effector.points.points) + "]";
  return fmt::format("{{type: {}, body: {}, {}}}",
                     turns(effector) ? orientation_kind().word : marker_kind().word, effector.body,
                     spot);
}

bool measures(const SensorDescription& sensor, const EffectorDescription& effector) {
  if (sensor.body != effector.body || sensor.kind->effector == nullptr) return false;
  const EffectorDescription own = sensor.kind->effector(sensor);
  const Points &points = own.points.points, &others = effector.points.points;
  return turns(own) == turns(effector) && own.set == effector.set &&
         points.rows() == others.rows() && points == others;
}

const EffectorDescription& effector_of(const SceneDescription& scene, const TaskDescription& task) {
  return *std::ranges::find(scene.effectors, task.effector, &EffectorDescription::name);
}

void check_kind(const SensorDescription& sensor, const Location& place) {
  if (sensor.kind->effector != nullptr) return;
  std::vector<std::string_view> fitting;
  for (const SensorKind* kind : sensor_kinds()) {
    if (kind->effector != nullptr) fitting.emplace_back(kind->word);
  }
  throw Error(ErrorKind::wrong_type, place,
              fmt::format("'{}' is of type {}, and a closed loop goes by what effectors do",
                          sensor.name, sensor.kind->word),
              fmt::format("name sensors of type {}", fmt::join(fitting, " or ")));
}

// Checks the rate, since a sample may be as old as its period before the next one arrives.
void check_rate(const SensorDescription& sensor, double timeout, const Location& timeout_place) {
  if (!(sensor.channel.rate > 0.0) || 1.0 / sensor.channel.rate <= timeout) return;
  throw Error(ErrorKind::out_of_range, timeout_place,
              fmt::format("'{}' takes a sample every {:g} s, and commands are held when one is "
                          "{:g} s late",
                          sensor.name, 1.0 / sensor.channel.rate, timeout),
              "give a longer timeout, or the sensor a higher rate");
}

// The body of a name; for a link ROBOT.LINK of a URDF robot it is ROBOT.
std::string body_of(const std::string& name) { return name.substr(0, name.find('.')); }

/// The bodies that actuators move, directly or through joints and contacts.
class Reach {
 public:
  Reach(const SceneDescription& scene, const ControllerDescription& controller) : scene_(scene) {
    for (const ActuatorDescription& actuator : scene.actuators) {
      const auto& driven = controller.actuators;
      if (driven.empty() || std::ranges::find(driven, actuator.name) != driven.end()) {
        add(actuator);
      }
    }
    while (spread()) continue;
  }

  bool has(const std::string& body) const { return bodies_.contains(body_of(body)); }

 private:
  void add(const ActuatorDescription& actuator) {
    if (!actuator.body.empty()) bodies_.insert(body_of(actuator.body));
    for (const std::string& body : further_bodies(actuator)) bodies_.insert(body_of(body));
    if (const auto* motor = actuator.as<MotorDescription>()) {
      bodies_.insert(body_of(motor->joint));  // of a robot from a file
      const auto joint = std::ranges::find(scene_.joints, motor->joint, &JointDescription::name);
      if (joint != scene_.joints.end())
        bodies_.insert({body_of(joint->first), body_of(joint->second)});
    }
  }

  // Adds bodies connected to those so far. Returns whether there was a new one.
  bool spread() {
    const std::size_t before = bodies_.size();
    for (const JointDescription& joint : scene_.joints) join(joint.first, joint.second);
    for (const ContactDescription& contact : scene_.contacts) {
      if (contact.all) return add_all(before);
      if (!contact.other.empty()) join(contact.body, contact.other);
    }
    return bodies_.size() > before;
  }

  bool add_all(std::size_t before) {
    for (const BodyDescription& body : scene_.bodies) bodies_.insert(body.name);
    return bodies_.size() > before;
  }

  // Connects two bodies. The world transmits no motion.
  void join(const std::string& first, const std::string& second) {
    if (first == kWorldName || second == kWorldName) return;
    if (!has(first) && !has(second)) return;
    bodies_.insert({body_of(first), body_of(second)});
  }

  const SceneDescription& scene_;
  std::set<std::string> bodies_;
};

void check_reach(const SceneDescription& scene, const ControllerDescription& controller) {
  const Reach reach(scene, controller);
  for (const TaskDescription& task : controller.tasks) {
    const EffectorDescription& effector = effector_of(scene, task);
    if (reach.has(effector.body)) continue;
    throw Error(ErrorKind::no_actuators, task.place,
                fmt::format("no actuator of '{}' moves the body '{}' of '{}'", controller.name,
                            effector.body, effector.name),
                "give the controller an actuator of this body, or leave the effector out");
  }
}

/// Assigns a sensor to each task.
class Assignment {
 public:
  Assignment(const SceneDescription& scene, const ControllerDescription& controller)
      : scene_(scene), controller_(controller), sensors_(controller.tasks.size()) {}

  const std::vector<std::string>& sensors() const { return sensors_; }

  void add(const SensorDescription& sensor, const Location& place) {
    check_kind(sensor, place);
    for (std::size_t t = 0; t < controller_.tasks.size(); ++t) {
      if (!measures(sensor, effector_of(scene_, controller_.tasks[t]))) continue;
      std::string& own = sensors_[t];
      if (!own.empty()) {
        throw Error(ErrorKind::duplicate_key, place,
                    fmt::format("'{}' and '{}' measure the same effector, '{}'", own, sensor.name,
                                controller_.tasks[t].effector),
                    "name one of them");
      }
      own = sensor.name;
      return;
    }
    const EffectorDescription& first = effector_of(scene_, controller_.tasks.front());
    throw Error(ErrorKind::conflicting_keys, place,
                fmt::format("'{}' measures none of the controller's effectors", sensor.name),
                fmt::format("put it where an effector is; '{}' is measured by {}", first.name,
                            sensor_for(first)));
  }

  void check_complete(const Location& place) const {
    for (std::size_t t = 0; t < controller_.tasks.size(); ++t) {
      if (!sensors_[t].empty()) continue;
      const EffectorDescription& effector = effector_of(scene_, controller_.tasks[t]);
      throw Error(
          ErrorKind::missing_key, place,
          fmt::format("no sensor here measures the effector '{}'", effector.name),
          fmt::format("add one to the scene's sensors and name it here: {}", sensor_for(effector)));
    }
  }

 private:
  const SceneDescription& scene_;
  const ControllerDescription& controller_;
  std::vector<std::string> sensors_;
};

std::any read_closed_loop(const ControllerEntry& entry) {
  ClosedLoopDescription loop;
  const Fields& fields = entry.fields;
  fields.read("gain", loop.settings.gain);
  fields.read("integral", loop.settings.integral);
  fields.read("timeout", loop.settings.timeout);
  Assignment assignment(entry.scene, entry.controller);
  const Node& sensors = *fields.find("sensors");
  for (const Node& name : sensors.items()) {
    const SensorDescription& sensor =
        *std::ranges::find(entry.scene.sensors, name.spelling(), &SensorDescription::name);
    assignment.add(sensor, name.place());
    check_rate(sensor, loop.settings.timeout,
               fields.find("timeout") != nullptr ? fields.place("timeout") : name.place());
  }
  assignment.check_complete(sensors.place());
  loop.sensors = assignment.sensors();
  check_reach(entry.scene, entry.controller);
  return loop;
}

control::ControllerSettings build_closed_loop(const ControllerSite& site) {
  const auto& loop = *site.controller.as<ClosedLoopDescription>();
  control::ClosedLoopSettings own = loop.settings;
  for (const std::string& name : loop.sensors) {
    own.sensors.push_back(sense::sensor_index(site.model, name));
  }
  control::TargetSettings targets = site.targets;
  targets.tolerance = kMeasuredTolerance;
  return control::settings_for<control::ClosedLoop>(std::move(targets), std::move(own));
}

}  // namespace

const ControllerKind& closed_loop_kind() {
  static const ControllerKind kind{.word = "closed-loop",
                                   .description = "Feedback on measured effectors.",
                                   .table = forms::closed_loop_table,
                                   .read = read_closed_loop,
                                   .build = build_closed_loop};
  return kind;
}

}  // namespace sinew::scene
