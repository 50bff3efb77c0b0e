/// @file
/// Settings for add_sensor(). Each is a function that makes the source, for SensorSettings::what.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/builder/probe_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"

namespace sinew::builder {
class Attacher;
}

namespace sinew::model {
struct ModelData;
}

namespace sinew::sense {

struct SensorSettings;

/// The source of a sensor.
struct MadeSource {
  std::unique_ptr<const SensorSource> source;
  std::string observable = {};  ///< of the same quantity; empty: there is none
};
/// A sensor whose source is made.
struct SourceSite {
  model::ModelData& data;  ///< with the actuators and contacts
  const SensorSettings& settings;
  builder::Attacher& attacher;  ///< to the bodies that it measures
};
using MakeSource = std::function<MadeSource(const SourceSite& site)>;

/// The position of a point, of the mean of several, or of nodes.
struct SensorMarker {
  builder::ProbeSpot spot;
  MadeSource operator()(const SourceSite& site) const;
};

/// Rotation since rest, angular velocity or specific force, of the frame through three points or of
/// the rigid section in which one point lies.
struct SensorMotion {
  enum class What { orientation, gyroscope, accelerometer };
  What what = What::orientation;
  int body = 0;
  Points points = Points(0, 3);       ///< (3, 3) or (1, 3) m
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
  MadeSource operator()(const SourceSite& site) const;
};

/// A quantity of an actuator.
struct SensorDrive {
  enum class What { cable_length, cable_tension, pressure, volume, flow, motor_current };
  What what = What::cable_length;
  std::string actuator;
  double motor_constant = 0.0;  ///< for motor_current: N m/A, or N/A
  bool turns = true;            ///< for motor_current: whether the constant refers to a torque
  double radius = 0.0;          ///< for motor_current of a cable: radius of the drum, m; 0: none
  MadeSource operator()(const SourceSite& site) const;
};

/// A sensor along a polyline of a body at rest.
struct SensorLine {
  enum class What { stretch, resistance, attenuation };
  What what = What::stretch;
  builder::ProbeLine line;
  double gauge_factor = 0.0;                          ///< for resistance
  double resistance = 0.0;                            ///< for resistance: ohm, at rest
  double loss_per_length = 0.0, loss_per_turn = 0.0;  ///< for attenuation: dB/m, dB/rad
  MadeSource operator()(const SourceSite& site) const;
};

/// Curvature at given positions along a polyline.
struct SensorCurvature {
  int body = 0;
  Points corners;              ///< (n, 3) m, n >= 2
  std::vector<double> places;  ///< m along the line at rest
  double gauge = 0.0;          ///< m, length over which it is measured; 0: a tenth of the line
  std::optional<Vector3> about;
  MadeSource operator()(const SourceSite& site) const;
};

/// Capacitance between two electrodes.
struct SensorCapacitance {
  struct Electrode {
    int body = 0;
    std::vector<mesh::Face> faces;
  };
  std::array<Electrode, 2> electrodes;
  double relative_permittivity = 1.0;
  MadeSource operator()(const SourceSite& site) const;
};

/// Normal force of contacts.
struct SensorContact {
  std::vector<std::string> contacts;  ///< one or more
  int body = -1;                      ///< of the patch; -1: the first body of the first contact
  std::vector<NodeId> patch;          ///< of its mesh; empty: no restriction
  std::optional<double> threshold;    ///< N, for a switch
  MadeSource operator()(const SourceSite& site) const;
};

struct SensorSettings {
  std::string name;
  Location place, rate_place;
  std::string kind;  ///< name of its type
  mesh::Outside outside = mesh::Outside::error;
  ChannelSettings channel;  ///< the stream is replaced by a hash of the sensor's name
  std::shared_ptr<const SensorRecord> record;
  MakeSource what = SensorMarker{};  ///< one of the above, or a function from outside
};

}  // namespace sinew::sense
