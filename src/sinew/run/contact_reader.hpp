/// @file
/// User-level access to the contacts of a run.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/contact/contact_state.hpp"

namespace sinew::qp {
struct ConeResult;
}
namespace sinew::law {
struct ContactProblem;
}

namespace sinew::run {

struct Run;

/// Reads the state of contact points after the last step.
class ContactReader {
 public:
  /// @param run must outlive it.
  explicit ContactReader(const Run& run) : run_(run) {}
  /// @param contact index of Model::contacts(). @param point below constraint::Contact::size().
  /// Points that the step did not find are not ContactPoint::is_measured().
  contact::ContactPoint point(int contact, std::size_t point) const;
  std::vector<contact::ContactPoint> points(int contact) const;
  /// With the gap(). @param contact index of Model::contacts().
  contact::ContactResultant resultant(int contact) const;
  /// The resultant without a gap of its own: `smallest_gap` is that of the points of the step.
  /// @param contact index of Model::contacts().
  contact::ContactResultant sum(int contact) const;
  /// The present gap. Where bodies touch, it is the smallest gap of the points of the step, for
  /// which the laws hold. Else it is the distance of the two bodies as they stand, since others
  /// than the points of the step may have come nearer; between surfaces, up to the distance of the
  /// search, 1 % of the robot's size. Against a surface of the world, points of a deformable body
  /// are measured at any distance.
  /// @param contact index of Model::contacts(). @param sum of its points.
  contact::ContactGap gap(int contact, const contact::ContactResultant& sum) const;
  /// Present pose of the surface, relative to its pose in the scene.
  Eigen::Isometry3d pose(int contact) const;
  /// The same as point(contact, point), for a known pose of the surface.
  contact::ContactPoint point(int contact, std::size_t point, const Eigen::Isometry3d& pose) const;
  /// All points, and the pose of the surface.
  contact::ContactSnapshot snapshot(int contact) const;
  /// How the forces of the last step were found.
  const qp::ConeResult& result() const;
  /// The contact problem of the last step (its last substep and linearisation) or equilibrium, with
  /// the active points in the order of contacts and their points. Not part of the state: empty
  /// before the first step.
  law::ContactProblem problem() const;

 private:
  bool is_found(int contact, std::size_t point) const;

  const Run& run_;
};

}  // namespace sinew::run
