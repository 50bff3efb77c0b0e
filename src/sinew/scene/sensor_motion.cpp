// Sensors that turn with a body: types orientation, gyroscope and accelerometer.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::vector<Key> frame_keys() {
  return {
      body_key(),
      {.name = "at",
       .forms = {list({vector(length())}, 3, 3), vector(length())},
       .example = "[0 0 190 mm, 10 0 190 mm, 0 10 190 mm]",
       .description = "Three points of a deformable body that define the orientation, or one point "
                      "of a rigid body or of an arm's section. Positions are in the mesh at rest.",
       .required = true},
      outside_key()};
}

std::shared_ptr<const KeyTable> orientation_table() {
  return sensor_table("orientation",
                      "Rotation from rest, (3,) rad: a rotation vector in world axes. "
                      "Errors are added to its components.",
                      frame_keys(), {angle(), "0.5 deg", "0.01 deg", "-180 180 deg"});
}

std::shared_ptr<const KeyTable> gyroscope_table() {
  return sensor_table("gyroscope",
                      "Angular velocity in the sensor's axes, (3,) rad/s, mean over a time "
                      "step. The axes are the world axes at rest and turn with the body.",
                      frame_keys(), {angular_speed(), "0.01 rad/s", "1e-3 rad/s", "-35 35 rad/s"});
}

std::shared_ptr<const KeyTable> accelerometer_table() {
  return sensor_table(
      "accelerometer",
      "Acceleration less gravity in the sensor's axes, (3,) m/s^2, mean over a time step. At "
      "rest it points upwards. A quasi-static robot has no acceleration.",
      frame_keys(), {acceleration(), "0.05 m/s^2", "0.01 m/s^2", "-80 80 m/s^2"});
}

}  // namespace
}  // namespace forms

namespace {

using Motion = sense::SensorMotion::What;

// The points that define the orientation.
void read_frame(const Fields& fields, const ReadContext& context, SensorDescription& sensor) {
  const bool single = fields.form("at").shape == Shape::quantity;
  sensor.own = single ? read_point(fields, "at") : read_points(fields, "at", context);
}

template <Motion what>
sense::MakeSource motion_source(const SensorSite& site) {
  return sense::SensorMotion{what, site.body(), site.sensor.as<PointList>()->points,
                             site.scene.gravity};
}

EffectorDescription turning_effector(const SensorDescription& sensor) {
  EffectorDescription effector;
  effector.kind = EffectorDescription::Kind::orientation;
  effector.points = *sensor.as<PointList>();
  return effector;
}

}  // namespace

const SensorKind& orientation_kind() {
  static const SensorKind kind{.word = "orientation",
                               .description = "Rotation from rest.",
                               .table = forms::orientation_table,
                               .read = read_frame,
                               .source = motion_source<Motion::orientation>,
                               .numbers =
                                   [](const SensorDescription&) {
                                     return std::vector<std::string>{"rx", "ry", "rz"};
                                   },
                               .effector = turning_effector,
                               .in_statics = true};
  return kind;
}

const SensorKind& gyroscope_kind() {
  static const SensorKind kind{.word = "gyroscope",
                               .description = "Angular velocity.",
                               .table = forms::gyroscope_table,
                               .read = read_frame,
                               .source = motion_source<Motion::gyroscope>,
                               .numbers = axis_numbers};
  return kind;
}

const SensorKind& accelerometer_kind() {
  static const SensorKind kind{.word = "accelerometer",
                               .description = "Specific force.",
                               .table = forms::accelerometer_table,
                               .read = read_frame,
                               .source = motion_source<Motion::accelerometer>,
                               .numbers = axis_numbers};
  return kind;
}

}  // namespace sinew::scene
