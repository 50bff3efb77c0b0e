#include <algorithm>
#include <map>
#include <numeric>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sense/sensor_settings.hpp"

namespace sinew::scene {

namespace {

using What = decltype(sense::SensorSettings::what);

/// Builds the measured quantity of a sensor on the bodies of a scene.
class Measured {
 public:
  Measured(const SensorSurroundings& surroundings, const SensorDescription& sensor)
      : scene_(surroundings.scene),
        contacts_(surroundings.contacts),
        sensor_(sensor),
        body_of_(surroundings.body_of) {}

  What what() const {
    static const std::map<std::string, What (Measured::*)() const> kinds = {
        {"marker", &Measured::marker},
        {"orientation", &Measured::motion},
        {"gyroscope", &Measured::motion},
        {"accelerometer", &Measured::motion},
        {"stretch", &Measured::line},
        {"resistance", &Measured::line},
        {"attenuation", &Measured::line},
        {"curvature", &Measured::curvature},
        {"capacitance", &Measured::capacitance},
        {"contact-force", &Measured::contact},
        {"touch", &Measured::contact}};
    const auto found = kinds.find(sensor_.type);
    return found == kinds.end() ? drive() : (this->*found->second)();
  }

 private:
  std::vector<NodeId> nodes(const std::string& body) const {
    const Location& place = sensor_.region->place;
    return at_place(place, [&] {
      return mesh::select_nodes(body_of_(body).model->mesh(), region_of(*sensor_.region),
                                place.item);
    });
  }
  int body() const { return body_of_(sensor_.body).number; }

  What marker() const {
    builder::ProbeSpot spot;
    spot.body = body();
    spot.points = sensor_.points.points;
    if (sensor_.region) spot.nodes = nodes(sensor_.body);
    return spot;
  }

  What motion() const {
    using Kind = sense::SensorMotion::What;
    const Kind kind = sensor_.type == "orientation" ? Kind::orientation
                      : sensor_.type == "gyroscope" ? Kind::gyroscope
                                                    : Kind::accelerometer;
    return sense::SensorMotion{kind, body(), sensor_.points.points, scene_.gravity};
  }

  What drive() const {
    using Kind = sense::SensorDrive::What;
    static const std::map<std::string, Kind> kinds = {{"cable-length", Kind::cable_length},
                                                      {"cable-tension", Kind::cable_tension},
                                                      {"pressure", Kind::pressure},
                                                      {"volume", Kind::volume},
                                                      {"flow", Kind::flow},
                                                      {"motor-current", Kind::motor_current}};
    return sense::SensorDrive{kinds.at(sensor_.type), sensor_.actuator, sensor_.motor_constant,
                              sensor_.turns, sensor_.radius};
  }

  What line() const {
    using Kind = sense::SensorLine::What;
    const Kind kind = sensor_.type == "stretch"      ? Kind::stretch
                      : sensor_.type == "resistance" ? Kind::resistance
                                                     : Kind::attenuation;
    return sense::SensorLine{kind,
                             {body(), sensor_.points.points, sensor_.samples},
                             sensor_.gauge_factor,
                             sensor_.resistance,
                             sensor_.loss_per_length,
                             sensor_.loss_per_turn};
  }

  What curvature() const {
    return sense::SensorCurvature{body(), sensor_.points.points, sensor_.places, sensor_.gauge,
                                  sensor_.about};
  }

  What capacitance() const {
    sense::SensorCapacitance capacitance;
    capacitance.relative_permittivity = sensor_.permittivity;
    for (std::size_t k = 0; k < 2; ++k) {
      const BuiltBody on = body_of_(sensor_.electrode_bodies[k]);
      capacitance.electrodes[k] = {on.number, faces_of(sensor_.electrodes[k], on.model->mesh())};
    }
    return capacitance;
  }

  What contact() const {
    sense::SensorContact touch{contacts(), -1, {}, {}};
    if (sensor_.type == "touch") touch.threshold = sensor_.threshold;
    if (!sensor_.region) return touch;
    const std::string name = sensor_.patch_body.empty() ? first_body() : sensor_.patch_body;
    touch.body = body_of_(name).number;
    touch.patch = nodes(name);
    return touch;
  }

  // The contact of that name, or all pairs of an entry.
  std::vector<std::string> contacts() const {
    std::vector<std::string> names;
    for (const auto& [contact, entry] : contacts_) {
      const bool meant = contact.name == sensor_.contact || entry == sensor_.contact;
      if (meant) names.push_back(contact.name);
    }
    if (names.empty()) names.push_back(sensor_.contact);  // which is refused
    return names;
  }

  std::string first_body() const {
    const auto found = std::ranges::find_if(
        contacts_, [&](const SceneContact& one) { return one.contact.name == sensor_.contact; });
    if (found != contacts_.end()) return found->contact.body;
    throw Error(ErrorKind::missing_key, sensor_.region->place, "the patch names no body",
                "add body: followed by the body that has the patch");
  }

  const SceneDescription& scene_;
  const std::vector<SceneContact>& contacts_;
  const SensorDescription& sensor_;
  const BodyOf& body_of_;
};

}  // namespace

void add_sensor(builder::ModelBuilder& builder, const SensorSurroundings& surroundings,
                const SensorDescription& sensor) {
  sense::SensorSettings settings;
  settings.name = sensor.name;
  settings.place = sensor.place;
  settings.rate_place = sensor.rate_place;
  settings.kind = sensor.type;
  settings.outside = sensor.outside;
  settings.channel = sensor.channel;
  settings.record = sensor.record;
  settings.what = Measured(surroundings, sensor).what();
  sense::add_sensor(builder, settings);
}

}  // namespace sinew::scene
