/// @file
/// Settings of loads on bodies. Each is a function that makes the load, for LoadSettings::load.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/law/drive.hpp"
#include "sinew/mechanics/loads.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/model/signal.hpp"

namespace sinew::mechanics {
class BearsLoads;
}

namespace sinew::builder {

struct LoadSettings;

/// A load that is made, and the body on which it acts.
struct LoadSite {
  mechanics::BearsLoads& body;
  const LoadSettings& settings;
};
/// Makes the parts of a load at a factor of 1, which all have its signal as their factor.
using MakeLoad = std::function<std::vector<mechanics::Load>(const LoadSite& site)>;

/// A force of fixed direction on a point.
struct PointLoadSettings {
  Vector3 point = Vector3::Zero();  ///< m, at rest
  Vector3 force = Vector3::Zero();  ///< N
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

/// A uniform force per length along a polyline.
struct LineLoadSettings {
  Points points;                               ///< (n, 3) m, at rest, n >= 2
  Vector3 force_per_length = Vector3::Zero();  ///< N/m, of the length at rest
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

/// A traction of fixed direction on faces.
struct SurfaceLoadSettings {
  std::vector<mesh::Face> faces;
  Vector3 traction = Vector3::Zero();  ///< Pa, of the area at rest
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

/// A force proportional to mass, such as that of a turntable or shaker.
struct BodyLoadSettings {
  Vector3 acceleration = Vector3::Zero();  ///< m/s^2
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

/// A follower pressure on faces, 1 Pa at a factor of 1.
struct PressureLoadSettings {
  std::vector<mesh::Face> faces;
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

/// Water around a body: buoyancy under the body's gravity, drag and added mass, see
/// mechanics::WaterLoad.
struct WaterSettings {
  std::vector<mesh::Face> faces;
  double density = 1000.0;             ///< kg/m^3, > 0
  std::optional<double> level;         ///< m, height against gravity; none: far above the body
  double normal_drag = 0.9;            ///< >= 0
  double tangential_drag = 0.01;       ///< >= 0
  double added_mass = 1.0;             ///< >= 0
  Vector3 velocity = Vector3::Zero();  ///< m/s
  std::vector<mechanics::Load> operator()(const LoadSite& site) const;
};

struct LoadSettings {
  std::string name;
  Location place;
  int body = 0;
  mesh::Outside outside = mesh::Outside::error;
  MakeLoad load = PointLoadSettings{};  ///< one of the above, or a function from outside
  model::Signal factor = model::Signal::constant(1.0);
  /// Name and unit of the factor where it is a quantity: {"pressure", "Pa"}.
  law::QuantityName factor_name{"factor", ""};
};

}  // namespace sinew::builder
