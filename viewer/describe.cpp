#include "describe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/chamber.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"

#include "fields.hpp"

namespace sinew::viewer {

namespace {

using Json = nlohmann::json;

// Ends of sliders of actuators without limits.
constexpr double kFarPull = 0.25;         // relative to the robot's size
constexpr double kStrongPull = 10.0;      // N
constexpr double kFarBend = 1.5;          // rad
constexpr double kStrongTorque = 0.5;     // N m
constexpr double kFastTurn = 10.0;        // rad/s
constexpr double kStrongPressure = 20e3;  // Pa
constexpr double kStrongPower = 5.0;      // W

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Json limit_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json quantity_json(const model::QuantityName& quantity, const model::Limits& limits, double low,
                   double high) {
  return {{"name", quantity.name},
          {"unit", quantity.unit},
          {"min", limit_json(limits.min)},
          {"max", limit_json(limits.max)},
          {"rate", limit_json(limits.rate)},
          {"low", std::isfinite(limits.min) ? limits.min : low},
          {"high", std::isfinite(limits.max) ? limits.max : high}};
}

// Ends of a slider.
struct Ends {
  double low, high;
};

Ends motion_ends(const model::Model& model, int index) {
  if (const auto* chamber = model.chamber(index)) {
    const double volume = std::abs(chamber->rest_volume());
    return {-0.5 * volume, volume};
  }
  const double far = kFarPull * model.size();
  const model::ActuatorKind& kind = *model.actuators()[static_cast<std::size_t>(index)].kind;
  if (kind.turns()) return {-kFarBend, kFarBend};
  return {kind.pulls_only ? 0.0 : -far, far};
}

Ends effort_ends(const model::ActuatorKind& kind) {
  if (kind.swells()) return {-kStrongPressure, kStrongPressure};
  if (kind.turns()) return {-kStrongTorque, kStrongTorque};
  return {kind.pulls_only ? 0.0 : -kStrongPull, kStrongPull};
}

Ends input_ends(const model::Model& model, int index) {
  const model::ActuatorModel& actuator = model.actuators()[static_cast<std::size_t>(index)];
  if (actuator.joint >= 0) {
    const double fast = actuator.kind->turns() ? kFastTurn : model.size();
    return {-fast, fast};
  }
  const std::string_view name = actuator.input_name().name;
  if (name == "power") return {0.0, kStrongPower};
  if (name == "phase") return {0.0, 1.0};
  const auto* chamber = model.chamber(index);
  const double volume = chamber != nullptr ? std::abs(chamber->rest_volume()) : 1.0;
  return {-0.5 * volume, 2.0 * volume};
}

// The quantities that can be commanded. The first is the one that the scene commands.
Json quantities_json(const model::Model& model, int index) {
  const model::ActuatorModel& actuator = model.actuators()[static_cast<std::size_t>(index)];
  Json quantities = Json::array();
  if (actuator.controllable()) {
    const auto [low, high] = motion_ends(model, index);
    quantities.push_back(quantity_json(actuator.kind->motion, actuator.motion, low, high));
    const auto [least, most] = effort_ends(*actuator.kind);
    quantities.push_back(quantity_json(
        actuator.kind->effort, actuator.effort_limits(model::CommandKind::motion), least, most));
    if (actuator.command.kind == model::CommandKind::effort) {
      std::swap(quantities[0], quantities[1]);
    }
  }
  if (*actuator.input_name().name != '\0') {
    const auto [low, high] = input_ends(model, index);
    const Json input = quantity_json(actuator.input_name(), {}, low, high);
    const bool first = actuator.command.kind == model::CommandKind::input;
    quantities.insert(first ? quantities.begin() : quantities.end(), input);
  }
  return quantities;
}

Json actuator_json(const model::Model& model, const scene::Robot& robot, int index) {
  const model::ActuatorModel& actuator = model.actuators()[static_cast<std::size_t>(index)];
  const auto& description = robot.description.actuators[static_cast<std::size_t>(index)];
  const bool wire = model.cable(index) != nullptr;
  // Number of points in frames, including guide points added between those in the scene.
  const auto points = static_cast<std::size_t>(wire ? model.cable(index)->via_count() + 2 : 0);
  return {{"name", actuator.name},
          {"type", actuator.kind->word},
          {"body", description.body},
          {"quantities", quantities_json(model, index)},
          {"points", points}};
}

Json effector_json(const model::Model& model, int index) {
  const constraint::Effector& effector = model.effector(index);
  Json directions = Json::array();
  for (const Vector3& direction : effector.directions())
    directions.push_back(vector_json(direction));
  return {{"name", model.effectors()[static_cast<std::size_t>(index)].name},
          {"kind", constraint::effector_kind_name(effector.kind())},
          {"directions", directions}};
}

std::string plain(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

// Group of signals of one unit that are plotted together.
std::string group_of(const run::Observable& observable) {
  const std::string& unit = observable.unit;
  const std::string_view quantity = observable.quantity;
  switch (observable.kind) {
    case run::ObservableKind::actuator: {
      const std::string named = observable.name.substr(observable.owner.size() + 1);
      if (quantity == "input_command") return plain(named);
      const char* after = quantity.ends_with("_command") ? " command" : "";
      if (quantity.starts_with("effort")) {
        return (unit == "N" ? "effort" : unit == "Pa" ? "pressure" : "torque") + std::string(after);
      }
      return (unit == "m" ? "motion" : unit == "rad" ? "angle" : "volume") + std::string(after);
    }
    case run::ObservableKind::effector:
      return unit == "m" ? "effector" : "rotation";
    case run::ObservableKind::controller:
      return unit == "m" ? "error" : "rotation error";
    case run::ObservableKind::probe:
      return unit == "rad" ? "angle" : "probe";
    case run::ObservableKind::sensor:
      return unit.empty() ? "sensor" : "sensor " + unit;
    case run::ObservableKind::estimator:
      return unit == "N" || unit.empty() ? "estimate" : "estimate " + unit;
    case run::ObservableKind::contact:
      return unit == "N" ? "contact" : unit == "m" ? "gap" : "touching";
    case run::ObservableKind::joint:
      return "joint " + unit;
    case run::ObservableKind::energy:
      return "energy";
    case run::ObservableKind::timing:
      return unit == "s" ? "time" : "solver";
    default:
      return "solver";
  }
}

void add_signals(const run::Observable& observable, std::vector<SignalInfo>& list) {
  if (!is_signal(observable)) return;
  const std::string group = group_of(observable);
  for (const std::string& component : observable.components) {
    SignalInfo signal{component, plain(component), observable.unit, group};
    switch (observable.kind) {
      case run::ObservableKind::actuator:
      case run::ObservableKind::controller:
        signal.label = observable.owner;
        break;
      case run::ObservableKind::probe:  // an effector may have the same name
        if (observable.size() == 1) signal.key = observable.owner;
        signal.label = signal.key;
        signal.key = "probe." + signal.key;
        break;
      case run::ObservableKind::sensor:
        signal.label = component;
        signal.key = "sensor." + signal.key;
        break;
      case run::ObservableKind::effector:
      case run::ObservableKind::contact:
      case run::ObservableKind::joint:
        signal.label = component;
        break;
      case run::ObservableKind::timing:
        if (!observable.owner.empty()) signal.label = observable.quantity;
        break;
      default:
        break;
    }
    list.push_back(std::move(signal));
  }
}

// Index of the signal keys of probes, sensors, contacts and joints, of which there may be
// thousands.
class SignalKeys {
 public:
  explicit SignalKeys(const sim::Observables& observables) {
    for (const run::Observable& one : observables.list()) {
      if (one.quantity == "true") continue;
      std::vector<SignalInfo> signals;
      add_signals(one, signals);
      for (const SignalInfo& signal : signals) keys_[{one.kind, one.owner}].push_back(signal.key);
    }
  }
  Json of(run::ObservableKind kind, const std::string& owner) const {
    const auto found = keys_.find({kind, owner});
    return found == keys_.end() ? Json::array() : found->second;
  }

 private:
  std::map<std::pair<run::ObservableKind, std::string>, Json> keys_;
};

Json probe_json(const SignalKeys& keys, const constraint::Probe& probe) {
  return {{"name", probe.name()},
          {"kind", probe.kind()},
          {"sensor", false},
          {"marks", probe.mark_count()},
          {"signals", keys.of(run::ObservableKind::probe, probe.name())}};
}

// A sensor, which is drawn like a probe.
Json sensor_json(const SignalKeys& keys, const sense::SensorModel& sensor) {
  const constraint::Probe* probe = sensor.source->probe();
  return {{"name", sensor.name},
          {"kind", sensor.kind},
          {"sensor", true},
          {"marks", probe != nullptr ? probe->mark_count() : 0},
          {"signals", keys.of(run::ObservableKind::sensor, sensor.name)}};
}

// The surface of a contact. That of a rigid body is drawn with the body.
Json surface_json(const constraint::Contact& contact) {
  if (contact.other_body() >= 0) return {{"kind", "body"}};
  const collision::Shape& surface =
      dynamic_cast<const constraint::ShapeContact&>(contact).surface();
  if (const auto* plane = std::get_if<constraint::Plane>(&surface)) {
    return {{"kind", "plane"},
            {"point", vector_json(plane->point)},
            {"normal", vector_json(plane->normal)}};
  }
  if (const auto* sphere = std::get_if<constraint::Sphere>(&surface)) {
    return {
        {"kind", "sphere"}, {"centre", vector_json(sphere->centre)}, {"radius", sphere->radius}};
  }
  const auto& capsule = std::get<constraint::Capsule>(surface);
  return {{"kind", "capsule"},
          {"ends", {vector_json(capsule.from), vector_json(capsule.to)}},
          {"radius", capsule.radius}};
}

Json contact_json(const SignalKeys& keys, const model::Model& model, int index) {
  const constraint::Contact& contact = model.contact(index);
  const int body = contact.body();
  return {{"name", contact.name()},
          {"body", model.body(body).name()},
          {"surface", surface_json(contact)},
          {"friction", contact.friction().sticking},
          {"points", contact.size()},
          {"signals", keys.of(run::ObservableKind::contact, contact.name())}};
}

Json joint_json(const SignalKeys& keys, const model::Model& model, int index) {
  const model::JointModel& joint = model.joints()[static_cast<std::size_t>(index)];
  const constraint::Joint* rigid = model.joint(index);
  const auto name_of = [&](int body) {
    return body == model::kWorld ? "world" : model.body(body).name();
  };
  const auto type = rigid != nullptr ? rigid->type() : constraint::JointType::weld;
  return {{"name", joint.name},
          {"type", constraint::joint_type_name(type)},
          {"bodies", {name_of(joint.first), name_of(joint.second)}},
          {"signals", keys.of(run::ObservableKind::joint, joint.name)}};
}

std::string material_text(const fem::MaterialRegion& region) {
  const auto& energy = region.hyperelastic;
  const char* law = energy && energy->saint_venant_shear > 0.0 ? "Saint Venant-Kirchhoff"
                    : energy && energy->has_memory()           ? "hyperelastic with memory"
                    : energy                                   ? "hyperelastic"
                    : region.law == material::Law::linear      ? "linear"
                                                               : "corotational";
  return fmt::format("{}, E = {:.4g} kPa", law, 1e-3 * region.young_modulus());
}

// Materials in the order of regions: that of the body, if any elements have it, then its parts.
Json materials_json(const scene::Robot& robot, const mechanics::BodyModel& model) {
  Json list = Json::array();
  const auto* own = mechanics::as<const fem::HasElements>(model);
  if (own == nullptr) return list;
  const auto& regions = own->settings().elements.regions;
  const auto body =
      std::ranges::find(robot.description.bodies, model.name(), &scene::BodyDescription::name);
  const std::size_t parts =
      body == robot.description.bodies.end() ? 0 : std::min(body->parts.size(), regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::size_t before = regions.size() - parts;
    const std::string part = r < before ? "" : body->parts[r - before].name + ": ";
    list.push_back(part + material_text(regions[r]));
  }
  return list;
}

Json body_json(const scene::Robot& robot, const mechanics::BodyModel& model,
               const DisplaySurface& surface) {
  std::size_t elements = 0;
  if (model.has_mesh()) {
    elements = model.mesh().tetrahedra.size() + model.mesh().hexahedra.size();
  }
  return {{"name", model.name()},
          {"vertices", surface.nodes.size()},
          {"triangles", surface.triangles.size() / 3},
          {"nodes", surface.node_count},
          {"elements", elements},
          {"materials", materials_json(robot, model)}};
}

Json notices_json(const std::vector<Notice>& notices) {
  Json list = Json::array();
  for (const Notice& notice : notices) {
    list.push_back({{"level", notice_level_name(notice.level)},
                    {"kind", notice_kind_name(notice.kind)},
                    {"subject", notice.place.item},
                    {"text", notice.message},
                    {"remedy", notice.remedy}});
  }
  return list;
}

Json bounds_json(const model::Model& model) {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
  for (const auto& body : model.bodies()) {
    if (!body.has_mesh()) continue;
    const Points& nodes = body.mesh().nodes;
    low = low.cwiseMin(nodes.colwise().minCoeff().transpose());
    high = high.cwiseMax(nodes.colwise().maxCoeff().transpose());
  }
  return {vector_json(low), vector_json(high)};
}

Json signals_json(const std::vector<SignalInfo>& signals) {
  Json list = Json::array();
  for (const SignalInfo& signal : signals) {
    list.push_back({{"key", signal.key},
                    {"label", signal.label},
                    {"unit", signal.unit},
                    {"group", signal.group}});
  }
  return list;
}

Json controllers_json(const scene::Robot& robot) {
  Json list = Json::array();
  for (const scene::ControllerDescription& controller : robot.description.controllers) {
    Json effectors = Json::array();
    for (const scene::TaskDescription& task : controller.tasks) effectors.push_back(task.effector);
    list.push_back(
        {{"name", controller.name}, {"type", controller.kind->word}, {"effectors", effectors}});
  }
  return list;
}

}  // namespace

// Vectors of contacts and targets are drawn instead. A replay has no record of the work.
bool is_signal(const run::Observable& observable) {
  switch (observable.kind) {
    case run::ObservableKind::time:
    case run::ObservableKind::body:
    case run::ObservableKind::contact_point:
    case run::ObservableKind::ledger:
    case run::ObservableKind::status:
      return false;
    case run::ObservableKind::controller:
      return !observable.owner.empty() && observable.size() == 1;
    case run::ObservableKind::contact:
      return observable.size() == 1;
    case run::ObservableKind::probe:  // the points of a line are drawn
      return observable.quantity == "value";
    case run::ObservableKind::sensor:
      return observable.quantity != "sample_time";
    case run::ObservableKind::estimator:
      return observable.quantity != "status";
    default:
      return true;
  }
}

DisplaySurface display_surface(const mechanics::BodyModel& body) {
  DisplaySurface result;
  result.body = body.name();
  if (!body.has_mesh()) return result;
  const mesh::Mesh& mesh = body.mesh();
  static_cast<mesh::OuterSurface&>(result) = mesh::outer_surface(mesh);
  result.node_count = mesh.node_count();
  result.element_count = fem::ElementList(mesh).count();
  for (const NodeId node : result.nodes) {
    for (int c = 0; c < 3; ++c) result.rest.push_back(static_cast<float>(mesh.nodes(node, c)));
  }
  result.inside = mesh::interior(mesh, result);
  const auto* own = mechanics::as<const fem::HasElements>(body);
  if (own == nullptr) return result;
  result.materials.assign(mesh.tetrahedra.size() + mesh.hexahedra.size(), 0);
  const auto& regions = own->settings().elements.regions;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const NodeId element : regions[r].elements) {
      result.materials[static_cast<std::size_t>(element)] = static_cast<int>(r);
    }
  }
  return result;
}

Description describe(const scene::Robot& robot, const sim::Observables& observables) {
  const model::Model& model = *robot.model;
  Description result;
  Json bodies = Json::array();
  for (const auto& body : model.bodies()) {
    result.surfaces.push_back(display_surface(body));
    bodies.push_back(body_json(robot, body, result.surfaces.back()));
  }
  Json actuators = Json::array(), effectors = Json::array(), probes = Json::array();
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    actuators.push_back(actuator_json(model, robot, static_cast<int>(i)));
    const std::size_t points = actuators.back()["points"];
    if (points > 0) result.cables.push_back({model.actuators()[i].name, points});
  }
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    effectors.push_back(effector_json(model, static_cast<int>(i)));
    result.effectors.push_back(model.effectors()[i].name);
  }
  const SignalKeys keys(observables);
  for (const auto& probe : model.probes()) probes.push_back(probe_json(keys, probe));
  for (const sense::SensorModel& sensor : sense::sensors_of(model)) {
    probes.push_back(sensor_json(keys, sensor));
  }
  Json contacts = Json::array();
  for (std::size_t c = 0; c < model.contacts().size(); ++c) {
    contacts.push_back(contact_json(keys, model, static_cast<int>(c)));
  }
  Json joints = Json::array();
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    joints.push_back(joint_json(keys, model, static_cast<int>(j)));
  }
  for (const run::Observable& one : observables.list()) add_signals(one, result.signals);
  Json fields = Json::array();
  for (const FieldInfo& field : list_fields()) {
    result.fields.push_back(field.name);
    fields.push_back({{"name", field.name},
                      {"label", field.label},
                      {"unit", field.unit},
                      {"description", field.description}});
  }
  const Json scene = {{"name", robot.description.name},
                      {"time_step", model.step().time_step},
                      {"gravity", vector_json(robot.description.gravity)},
                      {"bounds", bounds_json(model)},
                      {"bodies", bodies},
                      {"fields", fields},
                      {"actuators", actuators},
                      {"effectors", effectors},
                      {"probes", probes},
                      {"contacts", contacts},
                      {"joints", joints},
                      {"controllers", controllers_json(robot)},
                      {"notices", notices_json(robot.notices)},
                      {"signals", signals_json(result.signals)}};
  result.scene = scene.dump();
  return result;
}

}  // namespace sinew::viewer
