/// @file
/// User-level access to the contacts of a run.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/sim/contact_state.hpp"

namespace sinew::qp {
struct ConeResult;
}
namespace sinew::step {
struct ContactProblem;
}

namespace sinew::sim {

struct Run;

/// Reads the state of contact points after the last step.
class ContactReader {
 public:
  /// @param run must outlive it.
  explicit ContactReader(const Run& run) : run_(run) {}
  /// @param contact index of Model::contacts(). @param point below constraint::Contact::size().
  ContactPoint point(int contact, std::size_t point) const;
  std::vector<ContactPoint> points(int contact) const;
  ContactResultant resultant(int contact) const;
  /// Present pose of the surface, relative to its pose in the scene.
  Eigen::Isometry3d pose(int contact) const;
  /// The same as point(contact, point), for a known pose of the surface.
  ContactPoint point(int contact, std::size_t point, const Eigen::Isometry3d& pose) const;
  /// All points, and the pose of the surface.
  ContactSnapshot snapshot(int contact) const;
  /// How the forces of the last step were found.
  const qp::ConeResult& result() const;
  /// The contact problem of the last step (its last substep and linearisation) or equilibrium, with
  /// the active points in the order of contacts and their points. Not part of the state: empty
  /// before the first step.
  step::ContactProblem problem() const;

 private:
  const Run& run_;
};

}  // namespace sinew::sim
