// Estimators: the robot as each knows it, and whether its sensors can tell what is unknown.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/sim/estimator_model.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {

namespace {

constexpr std::array kTypes = {"marker",   "orientation", "cable-length", "cable-tension",
                               "pressure", "volume",      "motor-current"};
constexpr std::array kAxes = {"x", "y", "z"};
// Of what the compliances of two rows allow: less is rounding.
constexpr double kResponds = 1e-12;

bool reads_shape(const SensorDescription& sensor) {
  return sensor.type == "marker" || sensor.type == "orientation";
}

// An effector where a sensor is, by whose rows the robot's answer is read.
EffectorDescription effector_of(const SensorDescription& sensor) {
  using Kind = EffectorDescription::Kind;
  EffectorDescription effector;
  effector.name = sensor.name;
  effector.place = effector.body_place = effector.set_place = sensor.place;
  effector.body = sensor.body;
  effector.points = sensor.points;
  effector.outside = sensor.outside;
  effector.kind = sensor.type == "orientation"       ? Kind::orientation
                  : sensor.region                    ? Kind::set
                  : sensor.points.points.rows() == 1 ? Kind::point
                                                     : Kind::points;
  if (sensor.region) effector.set = sensor.region->set;
  return effector;
}

std::string actuator_name(const UnknownForceDescription& unknown, std::size_t axis) {
  return fmt::format("{} force {}", unknown.name, kAxes[axis]);
}

void add_forces(SceneDescription& known, const UnknownForceDescription& unknown) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ActuatorDescription force;
    force.name = actuator_name(unknown, axis);
    force.place = unknown.point_place;
    force.type = ActuatorDescription::Type::force;
    force.body = unknown.body;
    force.body_place = unknown.place;
    sim::ForceSettings own;
    own.point = unknown.point;
    own.direction = Vector3::Unit(static_cast<Eigen::Index>(axis));
    own.outside = unknown.outside;
    force.own = std::move(own);
    known.actuators.push_back(std::move(force));
  }
}

// At rest in each step, with exact sensors.
SceneDescription known_robot(const SceneDescription& scene, const EstimatorDescription& estimator) {
  SceneDescription known = scene;
  known.integrator = Integrator::quasi_static;
  known.restitution = 0.0;
  known.solver.method = Method::newton;
  known.solver.adaptive.reset();
  for (BodyDescription& body : known.bodies) body.initial_velocity.reset();
  for (ContactDescription& contact : known.contacts) contact.restitution.reset();
  known.estimators.clear();
  known.controllers.clear();
  known.probes.clear();
  known.effectors.clear();
  known.sensors.clear();
  for (const std::string& name : estimator.sensors) {
    SensorDescription sensor = *std::ranges::find(scene.sensors, name, &SensorDescription::name);
    sensor.channel = {};
    sensor.record.reset();
    if (reads_shape(sensor)) known.effectors.push_back(effector_of(sensor));
    known.sensors.push_back(std::move(sensor));
  }
  std::erase_if(known.loads, [&](const LoadDescription& load) {
    return std::ranges::find(estimator.unknown_loads, load.name) != estimator.unknown_loads.end() ||
           std::ranges::find(estimator.unknowns, load.name, &UnknownForceDescription::name) !=
               estimator.unknowns.end();
  });
  for (const UnknownForceDescription& unknown : estimator.unknowns) add_forces(known, unknown);
  return known;
}

std::shared_ptr<const sim::Model> build_known(const SceneDescription& scene,
                                              const EstimatorDescription& estimator) {
  try {
    return build(known_robot(scene, estimator)).model;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::nothing_fixed) throw;
    throw Error(ErrorKind::nothing_fixed, estimator.place,
                fmt::format("the robot of '{}' is at rest in each step: {}", estimator.name,
                            error.message()),
                "fix a region of every body, or hold it by joints");
  }
}

bool is_driven(const SceneDescription& scene, const std::string& actuator) {
  return std::ranges::any_of(scene.controllers, [&](const ControllerDescription& controller) {
    const auto& own = controller.actuators;
    return own.empty() || std::ranges::find(own, actuator) != own.end();
  });
}

void check_type(const SceneDescription& scene, const SensorDescription& sensor,
                const Location& place) {
  if (std::ranges::find(kTypes, sensor.type) == kTypes.end()) {
    throw Error(
        ErrorKind::wrong_type, place,
        fmt::format("'{}' is of type {}, which estimators do not read", sensor.name, sensor.type),
        fmt::format("name sensors of type {}", fmt::join(kTypes, ", ")));
  }
  if (sensor.type != "cable-length" && sensor.type != "volume") return;
  const auto on = std::ranges::find(scene.actuators, sensor.actuator, &ActuatorDescription::name);
  if (on == scene.actuators.end() || is_driven(scene, on->name)) return;
  if (on->command.kind != sim::CommandKind::motion) return;
  throw Error(ErrorKind::conflicting_keys, place,
              fmt::format("'{}' measures what '{}' is commanded, which no force changes",
                          sensor.name, on->name),
              sensor.type == "volume" ? "measure its pressure" : "measure its tension");
}

/// How much rows of the robot at rest move by unknown forces, whatever else acts on it.
class RestResponse {
 public:
  explicit RestResponse(const std::shared_ptr<const sim::Model>& robot) {
    sim::Simulation simulation(robot);
    at_rest_ = sim::linearise(simulation);
  }

  bool moves(const UnknownForceDescription& unknown) const {
    return std::ranges::any_of(rows_of(unknown),
                               [&](Eigen::Index k) { return at_rest_.compliance(k, k) > 0.0; });
  }

  bool responds(const SensorDescription& sensor, const UnknownForceDescription& unknown) const {
    const MatrixX& w = at_rest_.compliance;
    for (const Eigen::Index row : rows_of(sensor)) {
      for (const Eigen::Index by : rows_of(unknown)) {
        if (std::abs(w(row, by)) > kResponds * std::sqrt(w(row, row) * w(by, by))) return true;
      }
    }
    return false;
  }

 private:
  std::vector<Eigen::Index> rows_named(const std::vector<std::string>& names) const {
    std::vector<Eigen::Index> rows;
    for (const std::string& name : names) {
      const auto found = std::ranges::find(at_rest_.rows, name);
      if (found != at_rest_.rows.end()) rows.push_back(found - at_rest_.rows.begin());
    }
    return rows;
  }
  std::vector<Eigen::Index> rows_of(const UnknownForceDescription& unknown) const {
    return rows_named(
        {actuator_name(unknown, 0), actuator_name(unknown, 1), actuator_name(unknown, 2)});
  }
  std::vector<Eigen::Index> rows_of(const SensorDescription& sensor) const {
    if (!reads_shape(sensor)) return rows_named({sensor.actuator});
    return rows_named({sensor.name + ".x", sensor.name + ".y", sensor.name + ".z"});
  }

  sim::Linearisation at_rest_;
};

// Contacts pass on forces that they do not at rest.
void check_response(const SceneDescription& scene, const EstimatorDescription& estimator,
                    const RestResponse& rest) {
  for (const UnknownForceDescription& unknown : estimator.unknowns) {
    if (rest.moves(unknown)) continue;
    throw Error(ErrorKind::everything_fixed, unknown.point_place,
                fmt::format("nothing moves where the force '{}' acts on the body '{}'",
                            unknown.name, unknown.body),
                "choose a point that can move");
  }
  if (!scene.contacts.empty()) return;
  for (std::size_t k = 0; k < estimator.sensors.size(); ++k) {
    const SensorDescription& sensor =
        *std::ranges::find(scene.sensors, estimator.sensors[k], &SensorDescription::name);
    const bool any = std::ranges::any_of(
        estimator.unknowns, [&](const auto& unknown) { return rest.responds(sensor, unknown); });
    if (any) continue;
    throw Error(ErrorKind::conflicting_keys, estimator.sensor_places[k],
                fmt::format("'{}' answers to none of the unknown forces", sensor.name),
                "leave it out, or put it on a body that they move");
  }
}

}  // namespace

void add_estimator(sim::ModelBuilder& builder, const SceneDescription& scene,
                   const EstimatorDescription& estimator) {
  for (std::size_t k = 0; k < estimator.sensors.size(); ++k) {
    check_type(scene,
               *std::ranges::find(scene.sensors, estimator.sensors[k], &SensorDescription::name),
               estimator.sensor_places[k]);
  }
  sim::EstimatorSettings settings;
  settings.name = estimator.name;
  settings.place = estimator.place;
  settings.robot = build_known(scene, estimator);
  settings.sensors = estimator.sensors;
  settings.sensor_places = estimator.sensor_places;
  auto first = static_cast<int>(scene.actuators.size());
  for (const UnknownForceDescription& unknown : estimator.unknowns) {
    settings.unknowns.push_back({unknown.name, first, unknown.prior, unknown.walk});
    first += 3;
  }
  for (const sim::LoadModel& load : settings.robot->loads()) {
    const auto same = std::ranges::find(scene.loads, load.name, &LoadDescription::name);
    settings.loads.push_back(static_cast<int>(same - scene.loads.begin()));
  }
  builder.add_estimator(settings);
  check_response(scene, estimator, RestResponse(settings.robot));
}

}  // namespace sinew::scene
