// Builds the model of an estimator, and checks that its sensors respond to the unknowns.
#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/axis_names.hpp"
#include "sinew/core/error.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {

namespace {

// Of what the compliances of two rows allow: less is rounding.
constexpr double kResponds = 1e-12;

// An effector at a sensor, whose rows give the response of the robot.
EffectorDescription effector_of(const SensorDescription& sensor) {
  EffectorDescription effector = sensor.kind->effector(sensor);
  effector.name = sensor.name;
  effector.place = effector.body_place = effector.set_place = sensor.place;
  effector.body = sensor.body;
  effector.outside = sensor.outside;
  return effector;
}

std::string force_name(const UnknownDescription& unknown, std::size_t axis) {
  return fmt::format("{} force {}", unknown.name, kAxisNames[axis]);
}

void add_forces(SceneDescription& known, const UnknownDescription& unknown) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ActuatorDescription force;
    force.name = force_name(unknown, axis);
    force.place = unknown.where_place;
    force.kind = &force_kind();
    force.body = unknown.body;
    force.body_place = unknown.place;
    builder::ForceSettings own;
    own.point = unknown.point;
    own.direction = Vector3::Unit(static_cast<Eigen::Index>(axis));
    own.outside = unknown.outside;
    force.own = own;
    known.actuators.push_back(std::move(force));
  }
}

// Makes the effort of an actuator free: removes command, limits and supply.
void free_effort(SceneDescription& known, const UnknownDescription& unknown) {
  ActuatorDescription& actuator =
      *std::ranges::find(known.actuators, unknown.actuator, &ActuatorDescription::name);
  actuator.command = {};
  actuator.kind->free_effort(actuator.own);
}

bool has_inertia(const SceneDescription& scene, const EstimatorDescription& estimator) {
  return estimator.inertia && scene.integrator != Integrator::quasi_static;
}

void take_inertia(SceneDescription& known) {
  known.integrator = Integrator::quasi_static;
  known.restitution = 0.0;
  for (BodyDescription& body : known.bodies) body.velocity.reset();
  for (ContactDescription& contact : known.contacts) contact.restitution.reset();
}

// The scene of the estimator's model. It has exact sensors, and Newton steps that are never
// subdivided.
SceneDescription known_robot(const SceneDescription& scene, const EstimatorDescription& estimator) {
  SceneDescription known = scene;
  if (!has_inertia(scene, estimator)) take_inertia(known);
  known.solver.method = Method::newton;
  known.solver.adaptive.reset();
  known.estimators.clear();
  known.controllers.clear();
  known.probes.clear();
  known.effectors.clear();
  known.sensors.clear();
  for (const std::string& name : estimator.sensors) {
    SensorDescription sensor = *std::ranges::find(scene.sensors, name, &SensorDescription::name);
    sensor.channel = {};
    sensor.record.reset();
    if (sensor.kind->effector != nullptr) known.effectors.push_back(effector_of(sensor));
    known.sensors.push_back(std::move(sensor));
  }
  std::erase_if(known.loads, [&](const LoadDescription& load) {
    return std::ranges::find(estimator.unknown_loads, load.name) != estimator.unknown_loads.end() ||
           std::ranges::find(estimator.unknowns, load.name, &UnknownDescription::name) !=
               estimator.unknowns.end();
  });
  for (const UnknownDescription& unknown : estimator.unknowns) {
    if (unknown.is_force()) {
      add_forces(known, unknown);
    } else if (!unknown.is_stiffness()) {
      free_effort(known, unknown);
    }
  }
  return known;
}

SharedMeshes meshes_of(const builder::ModelBuilder& builder, const SceneDescription& scene) {
  SharedMeshes meshes;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const auto* made =
        mechanics::as<const fem::HasElements>(builder.added_body(static_cast<int>(k)));
    if (made == nullptr) continue;
    meshes[scene.bodies[k].name] = {made->settings().mesh, made->settings().embedder};
  }
  return meshes;
}

std::shared_ptr<const model::Model> build_known(const SceneDescription& known,
                                                const EstimatorDescription& estimator,
                                                const SharedMeshes& meshes) {
  try {
    return build(known, meshes).model;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::nothing_fixed) throw;
    throw Error(ErrorKind::nothing_fixed, estimator.place,
                fmt::format("the robot of '{}' is at rest in each step: {}", estimator.name,
                            error.message()),
                "fix a region of every body, hold it by joints, or leave `inertia` out in a "
                "dynamic scene");
  }
}

bool is_driven(const SceneDescription& scene, const std::string& actuator) {
  return std::ranges::any_of(scene.controllers, [&](const ControllerDescription& controller) {
    const auto& own = controller.actuators;
    return own.empty() || std::ranges::find(own, actuator) != own.end();
  });
}

bool is_unknown(const EstimatorDescription& estimator, const std::string& actuator) {
  return std::ranges::find(estimator.unknowns, actuator, &UnknownDescription::actuator) !=
         estimator.unknowns.end();
}

std::vector<std::string_view> words_in_statics() {
  std::vector<std::string_view> words;
  for (const SensorKind* kind : sensor_kinds()) {
    if (kind->in_statics) words.emplace_back(kind->word);
  }
  return words;
}

void check_type(const SceneDescription& scene, const EstimatorDescription& estimator,
                const SensorDescription& sensor, const Location& place) {
  const bool moves = has_inertia(scene, estimator);
  const SensorKind& kind = *sensor.kind;
  if (moves ? kind.is_switch : !kind.in_statics) {
    throw Error(ErrorKind::wrong_type, place,
                fmt::format("'{}' is of type {}, which {} do not read", sensor.name, kind.word,
                            moves ? "estimators" : "estimators with a quasi-static robot"),
                moves
                    ? "measure the force of the contact"
                    : fmt::format("name sensors of type {}", fmt::join(words_in_statics(), ", ")));
  }
  if (!kind.reads_motion) return;
  const auto on = std::ranges::find(scene.actuators, sensor.actuator, &ActuatorDescription::name);
  if (on == scene.actuators.end() || is_driven(scene, on->name)) return;
  if (is_unknown(estimator, on->name)) return;
  if (on->command.kind != model::CommandKind::motion) return;
  throw Error(ErrorKind::conflicting_keys, place,
              fmt::format("'{}' measures what '{}' is commanded, which nothing unknown changes",
                          sensor.name, on->name),
              fmt::format("measure its {}", on->kind->words->effort.name));
}

// The bodies on which an actuator acts.
std::set<std::string> bodies_of(const ActuatorDescription& actuator) {
  std::set<std::string> bodies;
  if (!actuator.body.empty()) bodies.insert(actuator.body);
  for (const std::string& name : further_bodies(actuator)) {
    if (!name.empty()) bodies.insert(name);
  }
  return bodies;
}

// The bodies that cables tie to a body, and itself.
std::set<std::string> tied_to(const SceneDescription& scene, const std::string& body) {
  std::set<std::string> all = {body};
  for (std::size_t before = 0; before < all.size();) {
    before = all.size();
    for (const ActuatorDescription& actuator : scene.actuators) {
      const std::set<std::string> own = bodies_of(actuator);
      const bool joins =
          std::ranges::any_of(own, [&](const std::string& name) { return all.contains(name); });
      if (joins) all.insert(own.begin(), own.end());
    }
  }
  return all;
}

// Whether a force acts on the robot that the estimator knows or measures, including inertia.
// Otherwise the shape does not depend on the stiffness. Anything that may exert such a force
// counts: also another body on the same cable, whose shape tells the tension.
bool has_known_force(const SceneDescription& scene, const EstimatorDescription& estimator,
                     const SceneDescription& known) {
  const bool weighs = !scene.gravity.isZero(0.0);
  const bool measures = std::ranges::any_of(estimator.sensors, [&](const std::string& name) {
    const auto& of = *std::ranges::find(scene.sensors, name, &SensorDescription::name);
    return of.kind->reads_force;
  });
  const bool pulled = std::ranges::any_of(known.actuators, [&](const ActuatorDescription& one) {
    const bool unknown = std::ranges::find(scene.actuators, one.name, &ActuatorDescription::name) ==
                         scene.actuators.end();
    return !unknown && !is_unknown(estimator, one.name) &&
           (one.command.kind != model::CommandKind::motion || is_driven(scene, one.name));
  });
  const bool tied = std::ranges::any_of(
      scene.actuators, [](const ActuatorDescription& one) { return bodies_of(one).size() > 1; });
  return weighs || measures || pulled || tied || !known.loads.empty() || !scene.membranes.empty() ||
         !scene.contacts.empty() || !scene.joints.empty() || has_inertia(scene, estimator);
}

// Checks unknown stiffnesses: the body has finite elements, its stiffness is unknown only once, and
// a known or measured force makes it observable.
void check_stiffness(const SceneDescription& scene, const EstimatorDescription& estimator,
                     const SceneDescription& known) {
  std::set<std::string> taken;
  for (const UnknownDescription& unknown : estimator.unknowns) {
    if (!unknown.is_stiffness()) continue;
    const auto body = std::ranges::find(scene.bodies, unknown.body, &BodyDescription::name);
    if (!body->kind->has_elements) {
      throw Error(ErrorKind::wrong_type, unknown.where_place,
                  fmt::format("'{}' is of type {}, whose stiffness is not estimated", body->name,
                              body->kind->word),
                  "name a body of type fem");
    }
    if (!taken.insert(unknown.body).second) {
      throw Error(ErrorKind::conflicting_keys, unknown.where_place,
                  fmt::format("the stiffness of '{}' is unknown twice", unknown.body),
                  "keep one of the two");
    }
    if (has_known_force(scene, estimator, known)) continue;
    throw Error(ErrorKind::conflicting_keys, unknown.where_place,
                fmt::format("no force that '{}' knows or measures acts on '{}', and the sensors "
                            "read the same at any stiffness",
                            estimator.name, unknown.body),
                "measure a tension, a pressure or the current of a motor, or let a known load act");
  }
}

// Of an effort: the actuator has it, and no other unknown.
void check_efforts(const SceneDescription& scene, const EstimatorDescription& estimator) {
  std::set<std::string> taken;
  for (const UnknownDescription& unknown : estimator.unknowns) {
    if (unknown.is_force() || unknown.is_stiffness()) continue;
    const auto on =
        std::ranges::find(scene.actuators, unknown.actuator, &ActuatorDescription::name);
    const model::ActuatorKind& words = *on->kind->words;
    if (unknown.quantity != words.effort.name || on->kind->free_effort == nullptr) {
      throw Error(ErrorKind::wrong_type, unknown.where_place,
                  fmt::format("'{}' is of type {}, whose {} is not estimated", on->name, words.word,
                              unknown.quantity),
                  unknown.quantity == "pressure" ? "name an actuator of type chamber"
                                                 : "name an actuator of type cable");
    }
    if (taken.insert(unknown.actuator).second) continue;
    throw Error(ErrorKind::conflicting_keys, unknown.where_place,
                fmt::format("the {} of '{}' is unknown twice", unknown.quantity, on->name),
                "keep one of the two");
  }
}

/// The linear response of rows to unknowns, for the robot at rest.
class RestResponse {
 public:
  explicit RestResponse(const std::shared_ptr<const model::Model>& robot) {
    sim::Simulation simulation(robot);
    const bool statics = robot->step().integrator == mechanics::Integrator::quasi_static;
    at_rest_ = sim::linearise(simulation, {.of_statics = statics});
  }

  bool moves(const UnknownDescription& unknown) const {
    return std::ranges::any_of(rows_of(unknown),
                               [&](Eigen::Index k) { return at_rest_.compliance(k, k) > 0.0; });
  }

  bool responds(const SensorDescription& sensor, const UnknownDescription& unknown) const {
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
  std::vector<Eigen::Index> rows_of(const UnknownDescription& unknown) const {
    if (!unknown.is_force()) return rows_named({unknown.actuator});
    return rows_named({force_name(unknown, 0), force_name(unknown, 1), force_name(unknown, 2)});
  }
  std::vector<Eigen::Index> rows_of(const SensorDescription& sensor) const {
    if (sensor.kind->effector == nullptr) return rows_named({sensor.actuator});
    return rows_named({sensor.name + ".x", sensor.name + ".y", sensor.name + ".z"});
  }

  sim::Linearisation at_rest_;
};

// Whether a sensor may respond to a stiffness: it is on the body or on a body that cables tie to
// it, on an actuator of such a body, or the scene has joints. W cannot show it, since a stiffness
// has no effect on the unloaded robot.
bool may_tell(const SceneDescription& scene, const SensorDescription& sensor,
              const UnknownDescription& unknown) {
  const std::set<std::string> tied = tied_to(scene, unknown.body);
  if (!scene.joints.empty() || tied.contains(sensor.body)) return true;
  const auto on = std::ranges::find(scene.actuators, sensor.actuator, &ActuatorDescription::name);
  return on != scene.actuators.end() &&
         std::ranges::any_of(bodies_of(*on),
                             [&](const std::string& body) { return tied.contains(body); });
}

// Contacts pass on forces that they do not at rest, and motion forces that one step does not.
void check_response(const SceneDescription& scene, const EstimatorDescription& estimator,
                    const RestResponse& rest) {
  for (const UnknownDescription& unknown : estimator.unknowns) {
    if (unknown.is_stiffness() || rest.moves(unknown)) continue;
    throw Error(
        ErrorKind::everything_fixed, unknown.where_place,
        unknown.is_force()
            ? fmt::format("nothing moves where the force '{}' acts on the body '{}'", unknown.name,
                          unknown.body)
            : fmt::format("the {} of '{}' moves nothing", unknown.quantity, unknown.actuator),
        unknown.is_force() ? "choose a point that can move" : "leave it out");
  }
  if (!scene.contacts.empty() || has_inertia(scene, estimator)) return;
  for (std::size_t k = 0; k < estimator.sensors.size(); ++k) {
    const SensorDescription& sensor =
        *std::ranges::find(scene.sensors, estimator.sensors[k], &SensorDescription::name);
    const bool any = std::ranges::any_of(estimator.unknowns, [&](const auto& unknown) {
      return unknown.is_stiffness() ? may_tell(scene, sensor, unknown)
                                    : rest.responds(sensor, unknown);
    });
    if (any) continue;
    throw Error(ErrorKind::conflicting_keys, estimator.sensor_places[k],
                fmt::format("'{}' answers to nothing that is unknown", sensor.name),
                "leave it out, or put it on a body that the unknowns move");
  }
}

// The unknowns. Actuators of unknown forces follow those of the scene, see add_forces().
std::vector<estimate::Unknown> unknowns_of(const SceneDescription& scene,
                                           const EstimatorDescription& estimator) {
  std::vector<estimate::Unknown> all;
  auto next = static_cast<int>(scene.actuators.size());
  for (const UnknownDescription& unknown : estimator.unknowns) {
    estimate::Unknown& one = all.emplace_back();
    one.name = unknown.name;
    one.prior = unknown.prior;
    one.walk = unknown.walk;
    if (unknown.is_force()) {
      one.first_actuator = std::exchange(next, next + 3);
      continue;
    }
    if (unknown.is_stiffness()) {
      const auto body = std::ranges::find(scene.bodies, unknown.body, &BodyDescription::name);
      one.kind = estimate::Unknown::Kind::stiffness;
      one.body = static_cast<int>(body - scene.bodies.begin());
      one.unit = "";
      continue;
    }
    const auto on =
        std::ranges::find(scene.actuators, unknown.actuator, &ActuatorDescription::name);
    one.kind = estimate::Unknown::Kind::effort;
    one.first_actuator = static_cast<int>(on - scene.actuators.begin());
    one.command_known = unknown.command_known;
    one.unit = on->kind->words->effort.unit;
  }
  return all;
}

}  // namespace

void add_estimator(builder::ModelBuilder& builder, const SceneDescription& scene,
                   const EstimatorDescription& estimator) {
  for (std::size_t k = 0; k < estimator.sensors.size(); ++k) {
    check_type(scene, estimator,
               *std::ranges::find(scene.sensors, estimator.sensors[k], &SensorDescription::name),
               estimator.sensor_places[k]);
  }
  check_efforts(scene, estimator);
  const SceneDescription known = known_robot(scene, estimator);
  check_stiffness(scene, estimator, known);
  estimate::EstimatorSettings settings;
  settings.name = estimator.name;
  settings.place = estimator.place;
  settings.robot = build_known(known, estimator, meshes_of(builder, scene));
  settings.sensors = estimator.sensors;
  settings.sensor_places = estimator.sensor_places;
  settings.unknowns = unknowns_of(scene, estimator);
  settings.rank = estimator.rank;
  for (const model::LoadModel& load : settings.robot->loads()) {
    const auto same = std::ranges::find(scene.loads, load.name, &LoadDescription::name);
    settings.loads.push_back(static_cast<int>(same - scene.loads.begin()));
  }
  estimate::add_estimator(builder, settings);
  check_response(scene, estimator, RestResponse(settings.robot));
}

}  // namespace sinew::scene
