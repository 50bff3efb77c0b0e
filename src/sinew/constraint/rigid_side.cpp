#include "sinew/constraint/rigid_side.hpp"

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

Eigen::Isometry3d RigidSide::pose(const Configuration& configuration) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = configuration.rotation(turn);
  result.translation() = configuration.position(centre) - result.linear() * rest_centre;
  return result;
}

void RigidSide::watch(const Configuration& configuration, std::size_t entry, const Vector3& at,
                      mechanics::RowValues& values) const {
  const Vector3 lever = at - configuration.position(centre);
  values.watched_start[entry] = at;
  values.arm[entry] = configuration.rotation(turn).transpose() * lever;
}

Vector3 RigidSide::watched(const Configuration& configuration, std::size_t entry,
                           const mechanics::RowValues& values) const {
  return configuration.position(centre) + configuration.rotation(turn) * values.arm[entry];
}

Vector3 RigidSide::displacement(const Configuration& configuration, std::size_t entry,
                                const mechanics::RowValues& values) const {
  return watched(configuration, entry, values) - values.watched_start[entry];
}

Vector3 RigidSide::velocity(const Configuration& configuration, const Vector3& at) const {
  return configuration.velocity(centre) +
         Vector3(configuration.velocity(turn)).cross(at - configuration.position(centre));
}

void RigidSide::write(const Configuration& configuration, std::size_t entry,
                      const Vector3& direction, mechanics::RowValues& values) const {
  const Vector3 lever = configuration.rotation(turn) * values.arm[entry];
  values.lever[entry] = lever;
  values.direction[entry] = direction;
  values.direction[entry + 1] = lever.cross(direction);
}

}  // namespace sinew::constraint
