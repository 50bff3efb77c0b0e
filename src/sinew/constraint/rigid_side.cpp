#include "sinew/constraint/rigid_side.hpp"

#include "sinew/constraint/placement.hpp"

namespace sinew::constraint {

Eigen::Isometry3d RigidSide::pose(const Placement& placement) const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = placement.rotation(turn);
  result.translation() = placement.position(centre) - result.linear() * rest_centre;
  return result;
}

void RigidSide::watch(const Placement& placement, std::size_t entry, const Vector3& at,
                      mechanics::RowValues& values) const {
  const Vector3 lever = at - placement.position(centre);
  values.watched_start[entry] = at;
  values.arm[entry] = placement.rotation(turn).transpose() * lever;
}

Vector3 RigidSide::watched(const Placement& placement, std::size_t entry,
                           const mechanics::RowValues& values) const {
  return placement.position(centre) + placement.rotation(turn) * values.arm[entry];
}

Vector3 RigidSide::displacement(const Placement& placement, std::size_t entry,
                                const mechanics::RowValues& values) const {
  return watched(placement, entry, values) - values.watched_start[entry];
}

Vector3 RigidSide::velocity(const Placement& placement, const Vector3& at) const {
  return placement.velocity(centre) +
         Vector3(placement.velocity(turn)).cross(at - placement.position(centre));
}

void RigidSide::write(const Placement& placement, std::size_t entry, const Vector3& direction,
                      mechanics::RowValues& values) const {
  const Vector3 lever = placement.rotation(turn) * values.arm[entry];
  values.lever[entry] = lever;
  values.direction[entry] = direction;
  values.direction[entry + 1] = lever.cross(direction);
}

}  // namespace sinew::constraint
