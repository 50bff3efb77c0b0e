// Arms shared by tests.
#pragma once

#include <memory>
#include <random>

#include <Eigen/Geometry>

#include "sinew/pcc/published.hpp"

namespace sinew::pcc::testing {

inline ArmSettings fluidic(MassCentre centre = MassCentre::arc) { return published_arm(centre); }

/// An arm with all features: rotated and extensible segments, dead lengths, a skew base and a load.
inline ArmSettings mixed(MassCentre centre = MassCentre::distributed) {
  ArmSettings settings = fluidic(centre);
  settings.segments.resize(3);
  settings.segments[0].gamma = 0.4;
  settings.segments[0].dead_length = 0.02;
  settings.segments[1].bending = Bending::spatial;
  settings.segments[1].gamma = -1.1;
  settings.segments[2].bending = Bending::spatial;
  settings.segments[2].extensible = true;
  settings.segments[2].axial_stiffness = 150.0;
  settings.segments[2].axial_damping = 0.3;
  settings.segments[2].dead_length = 0.01;
  settings.gravity = {1.0, -2.0, -9.0};
  settings.base = {0.1, 0.2, 0.3};
  settings.loads.push_back({1, 0.7, {0.1, -0.2, 0.05}});
  return settings;
}

/// A planar arm with dead lengths, loads, and a base and gravity that are skew to its plane.
inline ArmSettings planar(MassCentre centre = MassCentre::distributed) {
  ArmSettings settings = fluidic(centre);
  settings.segments[0].dead_length = 0.02;
  settings.segments[2].dead_length = 0.01;
  settings.frame = Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -0.5).normalized()).matrix();
  settings.gravity = {1.0, -2.0, -9.0};
  settings.base = {0.1, 0.2, 0.3};
  settings.loads.push_back({1, 0.7, {0.1, -0.2, 0.05}});
  settings.loads.push_back({3, 1.0, {-0.1, 0.3, 0.2}});
  return settings;
}

inline std::shared_ptr<const Arm> make(ArmSettings settings) {
  return std::make_shared<const Arm>(std::move(settings));
}

/// A vector (n,) with components uniform in [-size, size].
inline VectorX random_vector(std::mt19937& random, Eigen::Index n, double size) {
  std::uniform_real_distribution<double> spread(-size, size);
  VectorX result(n);
  for (Eigen::Index i = 0; i < n; ++i) result[i] = spread(random);
  return result;
}

}  // namespace sinew::pcc::testing
