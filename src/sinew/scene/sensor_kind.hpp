/// @file
/// The kinds of sensors in scenes. Each is a file, sensor_NAME.cpp, with its words, keys, reader
/// and builder, and a line in sensor_kind.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/description.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sense/sensor_settings.hpp"

namespace sinew::scene {

/// A sensor that is built, and what it may measure.
struct SensorSite {
  const SceneDescription& scene;
  const std::vector<SceneContact>& contacts;  ///< see contact_pairs()
  const BodyOf& body_of;
  const SensorDescription& sensor;

  /// The number of its body.
  int body() const { return body_of(sensor.body).number; }
};

/// A kind of sensor. Its functions have no state.
struct SensorKind {
  const char* word = "";         ///< in scenes
  const char* description = "";  ///< in the reference: "Position of a point."
  std::shared_ptr<const KeyTable> (*table)() = nullptr;  ///< its keys, see forms::sensor_table()
  /// Reads what a sensor measures: SensorDescription::own and further_bodies. Its body, actuator
  /// and `outside` are set if the kind has these keys, and its channel is read after. Null: nothing
  /// more.
  void (*read)(const Fields& fields, const ReadContext& context,
               SensorDescription& sensor) = nullptr;
  /// Makes what it measures.
  sense::MakeSource (*source)(const SensorSite& site) = nullptr;
  /// The names of its numbers, which columns of files end in. Null, or empty: one without a name.
  std::vector<std::string> (*numbers)(const SensorDescription& sensor) = nullptr;
  /// The effector at the same place, of which closed loops and estimators ask: its kind, points and
  /// set. Null: none has the same value.
  EffectorDescription (*effector)(const SensorDescription& sensor) = nullptr;
  bool reads_motion = false;  ///< whether it measures the motion of its actuator
  bool is_switch = false;     ///< whether it only tells yes or no, which estimators do not read
  /// Whether estimators with a quasi-static robot read it. It needs an actuator or an effector, by
  /// which they tell what it responds to.
  bool in_statics = false;
  /// Whether it measures a force, by which estimators tell stiffness.
  bool reads_force = false;
};

/// The kinds, in the order of the reference.
const std::vector<const SensorKind*>& sensor_kinds();
/// Adds a kind from outside the library. Call it before the grammar is first used, from one thread.
/// @param kind must outlive the program. Throws Error: duplicate-key (its word is taken),
/// bad-argument (the grammar is in use).
void register_sensor_kind(const SensorKind& kind);
/// The kind with a word. Throws Error(internal) if there is none.
const SensorKind& sensor_kind(std::string_view word);

/// SensorKind::numbers of a vector: x, y, z. @param sensor any.
std::vector<std::string> axis_numbers(const SensorDescription& sensor);

const SensorKind& marker_kind();
const SensorKind& orientation_kind();
const SensorKind& gyroscope_kind();
const SensorKind& accelerometer_kind();
const SensorKind& cable_length_kind();
const SensorKind& cable_tension_kind();
const SensorKind& pressure_sensor_kind();
const SensorKind& volume_sensor_kind();
const SensorKind& flow_kind();
const SensorKind& motor_current_kind();
const SensorKind& stretch_kind();
const SensorKind& resistance_kind();
const SensorKind& curvature_kind();
const SensorKind& attenuation_kind();
const SensorKind& capacitance_kind();
const SensorKind& contact_force_kind();
const SensorKind& touch_kind();

}  // namespace sinew::scene
