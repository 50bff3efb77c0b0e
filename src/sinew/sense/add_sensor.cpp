#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/attacher.hpp"
#include "sinew/builder/instrument_in.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/electrode_probe.hpp"
#include "sinew/constraint/line_probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/named_hash.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"
#include "sinew/sense/electrodes.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_settings.hpp"
#include "sinew/sense/sensor_source.hpp"

namespace sinew::sense {

namespace {

using mechanics::MaterialPoint;
using SourcePtr = std::unique_ptr<const SensorSource>;

// F/m, of free space (CODATA 2018).
constexpr double kFreeSpace = 8.8541878128e-12;
// Tolerance on the sampling period as a multiple of the time step, relative.
constexpr double kMultiple = 1e-6;

template <class Part, class NameOf>
int named_part(const std::vector<Part>& parts, const std::string& name, const char* what,
               NameOf name_of, const Location& place) {
  const auto found = std::ranges::find(parts, name, name_of);
  if (found != parts.end()) return static_cast<int>(found - parts.begin());
  std::vector<std::string> known;
  known.reserve(parts.size());
  for (const Part& part : parts) known.push_back(part.*name_of);
  throw Error(ErrorKind::unknown_name, place, fmt::format("no {} is called '{}'", what, name),
              known.empty() ? fmt::format("the robot has no {}", what)
                            : fmt::format("there are: {}", fmt::join(known, ", ")));
}

// The point of a polyline at a given arc length.
Vector3 point_along(const Points& corners, double length) {
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    const Vector3 from = corners.row(k - 1).transpose(), to = corners.row(k).transpose();
    const double piece = (to - from).norm();
    if (length <= piece || k + 1 == corners.rows()) {
      return piece > 0.0 ? Vector3(from + (to - from) * std::min(1.0, length / piece)) : from;
    }
    length -= piece;
  }
  return corners.row(0).transpose();
}

/// Makes the source of a sensor, and determines the observable of the same quantity.
class MakeSensor {
 public:
  explicit MakeSensor(const SourceSite& site)
      : data_(site.data), settings_(site.settings), attacher_(site.attacher) {}

  template <class What>
  static MadeSource of(const What& what, const SourceSite& site) {
    MakeSensor make(site);
    SourcePtr source = make.source(what);
    return {std::move(source), std::move(make.observable_)};
  }

 private:
  SourcePtr source(const SensorMarker& marker) {
    return std::make_unique<PositionSource>(
        std::make_unique<constraint::PointProbe>(settings_.name, attacher_.mean(marker.spot)));
  }
  SourcePtr source(const SensorMotion& motion);
  SourcePtr source(const SensorDrive& drive);
  SourcePtr source(const SensorLine& line);
  SourcePtr source(const SensorCurvature& curvature);
  SourcePtr source(const SensorCapacitance& capacitance);
  SourcePtr source(const SensorContact& touch);

  static SourcePtr read(std::unique_ptr<const constraint::Probe> probe) {
    return std::make_unique<ProbeSource>(std::move(probe));
  }
  std::shared_ptr<const constraint::OrientationEffector> orientation(
      const SensorMotion& motion, std::vector<MaterialPoint>& points);
  void require(bool has, const model::ActuatorModel& actuator, const char* measures,
               const char* allowed) const;
  double current_factor(const model::ActuatorModel& actuator, const SensorDrive& drive) const;
  double length_of(const Points& corners) const;
  const constraint::Contact& contact_of(int index) const;
  std::vector<int> contacts_of(int body, const std::vector<int>& contacts) const;

  model::ModelData& data_;
  const SensorSettings& settings_;
  builder::Attacher& attacher_;
  std::string observable_;
};

std::shared_ptr<const constraint::OrientationEffector> MakeSensor::orientation(
    const SensorMotion& motion, std::vector<MaterialPoint>& points) {
  for (Eigen::Index k = 0; k < motion.points.rows(); ++k) {
    points.push_back(attacher_.point(motion.body, motion.points.row(k).transpose()));
  }
  if (points.size() == 3) {
    const Points rest = attacher_.rest(points);
    return std::make_shared<constraint::TriangleOrientation>(
        settings_.name, std::array{points[0], points[1], points[2]},
        std::array<Vector3, 3>{rest.row(0), rest.row(1), rest.row(2)});
  }
  auto* rigid = mechanics::as<mechanics::AttachesOrientations>(attacher_.on(motion.body));
  if (points.size() == 1 && rigid != nullptr) {
    const int site =
        rigid->attach_orientation(motion.points.row(0), settings_.outside, attacher_.what());
    return std::make_shared<constraint::SectionOrientation>(
        settings_.name, mechanics::Orientation{{motion.body, site}});
  }
  throw Error(ErrorKind::wrong_length, settings_.place,
              fmt::format("{} point(s) for the orientation of body '{}'", points.size(),
                          attacher_.on(motion.body).name()),
              "give three points that span a triangle or, of an arm or a rigid body, one");
}

SourcePtr MakeSensor::source(const SensorMotion& motion) {
  std::vector<MaterialPoint> points;
  auto frame = orientation(motion, points);
  switch (motion.what) {
    case SensorMotion::What::orientation:
      return std::make_unique<RotationSource>(std::move(frame));
    case SensorMotion::What::gyroscope:
      return std::make_unique<GyroscopeSource>(std::move(frame));
    case SensorMotion::What::accelerometer:
      break;
  }
  return std::make_unique<AccelerometerSource>(std::move(frame), std::move(points), motion.gravity);
}

// @param has whether the actuator has what the sensor measures. @param allowed types that have it.
void MakeSensor::require(bool has, const model::ActuatorModel& actuator, const char* measures,
                         const char* allowed) const {
  if (has) return;
  throw Error(ErrorKind::wrong_actuator_type, settings_.place,
              fmt::format("'{}' is of type {}, which has no {}", actuator.name, actuator.kind->word,
                          measures),
              fmt::format("name an actuator of type {}", allowed));
}

// A/(N m) or A/N: the motor current is the torque over the motor constant; a drum converts tension
// to torque.
double MakeSensor::current_factor(const model::ActuatorModel& actuator,
                                  const SensorDrive& drive) const {
  const bool winds = actuator.kind->pulls_only;
  if (winds && !(drive.radius > 0.0)) {
    throw Error(ErrorKind::missing_key, settings_.place,
                "the radius of the cable's drum is missing", "add radius: 8 mm");
  }
  if (!winds && drive.radius > 0.0) {
    throw Error(ErrorKind::conflicting_keys, settings_.place,
                fmt::format("'{}' winds no cable on a drum", actuator.name), "leave `radius` out");
  }
  if (drive.turns != (winds || actuator.kind->turns())) {
    throw Error(ErrorKind::conflicting_keys, settings_.place,
                fmt::format("'{}' exerts a {}", actuator.name, drive.turns ? "force" : "torque"),
                drive.turns ? "give force_constant: 10 N/A" : "give torque_constant: 0.05 N m/A");
  }
  return (winds ? drive.radius : 1.0) / drive.motor_constant;
}

SourcePtr MakeSensor::source(const SensorDrive& drive) {
  using What = SensorDrive::What;
  const int index = named_part(data_.actuators, drive.actuator, "actuator",
                               &model::ActuatorModel::name, settings_.place);
  const model::ActuatorModel& actuator = data_.actuators[static_cast<std::size_t>(index)];
  const model::ActuatorKind& kind = *actuator.kind;
  const model::QuantityName &effort = kind.effort, &motion = kind.motion;
  switch (drive.what) {
    case What::cable_length:
      require(kind.is_line, actuator, "length", "cable or spring");
      observable_ = fmt::format("{}.{}", actuator.name, motion.name);
      return std::make_unique<MotionSource>(index, motion.unit);
    case What::cable_tension:
      require(kind.is_line, actuator, "tension", "cable or spring");
      observable_ = fmt::format("{}.{}", actuator.name, effort.name);
      return std::make_unique<EffortSource>(index, 1.0, effort.unit);
    case What::pressure:
      require(kind.swells(), actuator, "pressure", "chamber");
      observable_ = fmt::format("{}.{}", actuator.name, effort.name);
      return std::make_unique<EffortSource>(index, 1.0, effort.unit);
    case What::volume:
      require(kind.swells(), actuator, "volume", "chamber");
      observable_ = fmt::format("{}.{}", actuator.name, motion.name);
      return std::make_unique<MotionSource>(index, motion.unit);
    case What::flow:
      require(kind.swells(), actuator, "flow", "chamber");
      return std::make_unique<FlowSource>(index);
    case What::motor_current:
      break;
  }
  require(actuator.joint >= 0 || kind.pulls_only, actuator, "motor",
          "motor or linear-motor or cable");
  return std::make_unique<EffortSource>(index, current_factor(actuator, drive), "A");
}

double MakeSensor::length_of(const Points& corners) const {
  double length = 0.0;
  for (Eigen::Index k = 1; k < corners.rows(); ++k) {
    length += (corners.row(k) - corners.row(k - 1)).norm();
  }
  if (length > 0.0) return length;
  throw Error(ErrorKind::too_few_points, settings_.place, "the line has no length",
              "give the ends of a line");
}

SourcePtr MakeSensor::source(const SensorLine& line) {
  using What = SensorLine::What;
  const double length = length_of(line.line.corners);
  std::vector<MaterialPoint> points = attacher_.line(line.line);
  switch (line.what) {
    case What::stretch:
      return read(std::make_unique<constraint::StretchProbe>(
          settings_.name, std::move(points), length, constraint::StretchProbe::Law{}));
    case What::resistance:
      return read(std::make_unique<constraint::StretchProbe>(
          settings_.name, std::move(points), length,
          constraint::StretchProbe::Law{line.resistance, line.gauge_factor * line.resistance,
                                        "Ohm"}));
    case What::attenuation:
      break;
  }
  return read(std::make_unique<constraint::AttenuationProbe>(
      settings_.name, std::move(points),
      constraint::AttenuationProbe::Loss{line.loss_per_length, line.loss_per_turn}));
}

SourcePtr MakeSensor::source(const SensorCurvature& curvature) {
  const double length = length_of(curvature.corners);
  const double half = 0.5 * (curvature.gauge > 0.0 ? curvature.gauge : 0.1 * length);
  std::vector<constraint::CurvatureProbe::Triple> places;
  for (const double at : curvature.places) {
    // Lengths from files and unit conversions are rounded.
    if (at - half < -1e-9 * length || at + half > (1.0 + 1e-9) * length) {
      throw Error(ErrorKind::out_of_range, settings_.place,
                  fmt::format("a length of {:g} m at {:g} m does not lie on the line, which is "
                              "{:g} m long",
                              2.0 * half, at, length),
                  "choose places further from the ends, or a shorter `gauge`");
    }
    constraint::CurvatureProbe::Triple place;
    for (std::size_t k = 0; k < 3; ++k) {
      const double s = std::max(0.0, at + (static_cast<double>(k) - 1.0) * half);
      place[k] = attacher_.point(curvature.body, point_along(curvature.corners, s));
    }
    places.push_back(place);
  }
  return read(std::make_unique<constraint::CurvatureProbe>(settings_.name, std::move(places),
                                                           curvature.about));
}

SourcePtr MakeSensor::source(const SensorCapacitance& capacitance) {
  const auto& [first, second] = capacitance.electrodes;
  std::array electrodes{attach_electrode(attacher_, first, second, settings_.place),
                        attach_electrode(attacher_, second, first, settings_.place)};
  return read(std::make_unique<constraint::CapacitanceProbe>(
      settings_.name, std::move(electrodes), capacitance.relative_permittivity * kFreeSpace));
}

// The contacts in which a body takes part. @param contacts indices.
std::vector<int> MakeSensor::contacts_of(int body, const std::vector<int>& contacts) const {
  std::vector<int> own;
  for (const int index : contacts) {
    const constraint::Contact& contact = contact_of(index);
    if (contact.body() == body || contact.other_body() == body) own.push_back(index);
  }
  return own;
}

const constraint::Contact& MakeSensor::contact_of(int index) const {
  const model::ContactModel& contact = data_.contacts[static_cast<std::size_t>(index)];
  return dynamic_cast<const constraint::Contact&>(data_.constraint(contact.constraint));
}

SourcePtr MakeSensor::source(const SensorContact& touch) {
  std::vector<int> contacts;
  for (const std::string& name : touch.contacts) {
    contacts.push_back(
        named_part(data_.contacts, name, "contact", &model::ContactModel::name, settings_.place));
  }
  TouchSource::Patch patch;
  if (!touch.patch.empty()) {
    const int first = contact_of(contacts.front()).body();
    patch.body = touch.body < 0 ? first : touch.body;
    contacts = contacts_of(patch.body, contacts);
    if (contacts.empty()) {
      throw Error(ErrorKind::unknown_name, settings_.place,
                  fmt::format("body '{}' does not take part in {}", attacher_.on(patch.body).name(),
                              touch.contacts.size() == 1
                                  ? fmt::format("contact '{}'", touch.contacts.front())
                                  : fmt::format("any of {} contacts", touch.contacts.size())),
                  fmt::format("name the body '{}'", attacher_.on(first).name()));
    }
    patch.outer = mesh::outer_nodes(attacher_.on(patch.body).mesh());
    for (const NodeId node : patch.outer) {
      patch.within.push_back(std::ranges::binary_search(touch.patch, node) ? 1 : 0);
    }
    if (std::ranges::find(patch.within, char{1}) == patch.within.end()) {
      throw Error(ErrorKind::empty_region, settings_.place,
                  "no node of the surface is in the patch", "choose a region that holds some");
    }
  } else if (!touch.threshold && contacts.size() == 1) {
    observable_ = touch.contacts.front() + ".normal_force";
  }
  return std::make_unique<TouchSource>(std::move(contacts), std::move(patch), touch.threshold);
}

// The sampling period must be a multiple of the time step.
void check_rate(const SensorSettings& settings, double time_step) {
  const double rate = settings.channel.rate;
  if (rate == 0.0 || settings.record) return;
  const double steps = 1.0 / (rate * time_step);
  const double whole = std::round(steps);
  if (whole >= 1.0 && std::abs(steps - whole) <= kMultiple * steps) return;
  const double less = 1.0 / (std::max(1.0, std::ceil(steps)) * time_step);
  throw Error(ErrorKind::out_of_range,
              settings.rate_place.item.empty() ? settings.place : settings.rate_place,
              fmt::format("a rate of {:g} Hz takes a sample every {:g} steps of {:g} s", rate,
                          steps, time_step),
              fmt::format("choose {:g} Hz, or a time_step that divides {:g} s", less, 1.0 / rate));
}

// Sensors with the same seed differ by their names.
std::uint64_t stream_of(const std::string& name) { return ValueHash().add(name).value(); }

}  // namespace

MadeSource SensorMarker::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorMotion::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorDrive::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorLine::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorCurvature::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorCapacitance::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}
MadeSource SensorContact::operator()(const SourceSite& site) const {
  return MakeSensor::of(*this, site);
}

int add_sensor(builder::ModelBuilder& builder, const SensorSettings& settings) {
  model::ModelData& data = builder.data();
  model::check_new_name(sensors_of(data), &SensorModel::name, "sensors", settings.name,
                        settings.place);
  try {
    check_rate(settings, data.step.time_step);
    builder::Attacher attacher(data, "sensor '" + settings.name + "'", settings.place,
                               settings.outside);
    MadeSource made = settings.what({data, settings, attacher});
    SensorModel sensor{settings.name,
                       settings.kind,
                       made.observable.empty() ? settings.name + ".true" : made.observable,
                       std::move(made.source),
                       settings.channel,
                       settings.record};
    sensor.channel.stream = stream_of(settings.name);
    Channel checked(sensor.channel, sensor.source->size());
    builder::instrument_in<SensorSet>(data).sensors.push_back(std::move(sensor));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  return static_cast<int>(sensors_of(data).size()) - 1;
}

}  // namespace sinew::sense
