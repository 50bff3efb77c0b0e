#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/scale.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

namespace {

// Reads a closed surface in the frame of the body's mesh file, with the same scale and pose.
mesh::Surface read_closed(const SurfaceDescription& surface, const BodyDescription& body) {
  try {
    mesh::SurfaceOptions options;
    options.unit = surface.unit;
    mesh::Surface read = mesh::read_surface(surface.file, options);
    mesh::require_closed(read);
    mesh::scale(read, body.mesh.scale);
    place_in_world(body, read.nodes);
    return read;
  } catch (const Error& error) {
    throw error.at(surface.place);
  }
}

// Counts the pressures of a chamber from that of the water that wets its faces.
void add_head(builder::ChamberSettings& chamber, double head) {
  if (head <= 0.0) return;
  const double air = chamber.gas ? chamber.gas->ambient_pressure : model::kAtmosphere;
  chamber.ambient_pressure = chamber.ambient_pressure.value_or(air) + head;
}

// Adds an actuator according to the settings of its type.
class Adder {
 public:
  Adder(builder::ModelBuilder& builder, const SceneDescription& scene,
        const ActuatorDescription& actuator, const BodyOf& body_of, const JointOf& joint_of)
      : builder_(builder),
        scene_(scene),
        actuator_(actuator),
        body_of_(body_of),
        joint_of_(joint_of) {}

  void operator()(const CableDescription& cable) const {
    builder::CableSettings settings = on_body(cable.settings);
    for (const std::string& name : cable.point_bodies) {
      settings.point_bodies.push_back(name.empty() ? settings.body : body_of_(name).number);
    }
    builder_.add_cable(settings);
  }

  void operator()(const builder::ForceSettings& force) const { builder_.add_force(on_body(force)); }

  void operator()(const ChamberDescription& chamber) const {
    builder::ChamberSettings settings = on_body(chamber.settings);
    if (chamber.surface.kind == SurfaceDescription::Kind::file) {
      settings.surface =
          read_closed(chamber.surface,
                      *std::ranges::find(scene_.bodies, actuator_.body, &BodyDescription::name));
    } else {
      const mechanics::BodyModel& body = *body_of_(actuator_.body).model;
      std::vector<mesh::Face> faces = faces_of(chamber.surface, body.mesh());
      add_head(settings, water_head(scene_, actuator_.body, body, faces));
      settings.surface = std::move(faces);
    }
    builder_.add_chamber(settings);
  }

  void operator()(const builder::SpringLineSettings& line) const {
    builder_.add_spring(on_body(line));
  }

  void operator()(const builder::TorqueSettings& torque) const {
    builder_.add_torque(on_body(torque));
  }

  void operator()(const MotorDescription& motor) const {
    builder::MotorSettings settings = complete(motor.settings);
    settings.joint = joint_of_(motor.joint);
    builder_.add_motor(settings);
  }

 private:
  template <class Settings>
  Settings complete(Settings settings) const {
    settings.name = actuator_.name;
    settings.place = actuator_.place;
    settings.command = actuator_.command;
    return settings;
  }

  template <class Settings>
  Settings on_body(const Settings& own) const {
    Settings settings = complete(own);
    settings.body = body_of_(actuator_.body).number;
    return settings;
  }

  builder::ModelBuilder& builder_;
  const SceneDescription& scene_;
  const ActuatorDescription& actuator_;
  const BodyOf& body_of_;
  const JointOf& joint_of_;
};

}  // namespace

void add_actuator(builder::ModelBuilder& builder, const SceneDescription& scene,
                  const ActuatorDescription& actuator, const BodyOf& body_of,
                  const JointOf& joint_of) {
  std::visit(Adder(builder, scene, actuator, body_of, joint_of), actuator.own);
}

}  // namespace sinew::scene
