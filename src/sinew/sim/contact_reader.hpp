/// @file
/// Contacts of a run as a user reads them.
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

/// What the points of contacts do, after the last step.
class ContactReader {
 public:
  /// @param run outlives it.
  explicit ContactReader(const Run& run) : run_(run) {}
  /// @param contact of Model::contacts(). @param point below constraint::Contact::size().
  ContactPoint point(int contact, std::size_t point) const;
  std::vector<ContactPoint> points(int contact) const;
  ContactResultant resultant(int contact) const;
  /// Where the surface stands now, from where the scene puts it.
  Eigen::Isometry3d pose(int contact) const;
  /// The same as point(), of a pose that is known.
  ContactPoint point(int contact, std::size_t point, const Eigen::Isometry3d& pose) const;
  /// The points and where the surface stands.
  ContactSnapshot snapshot(int contact) const;
  /// How the forces were last found.
  const qp::ConeResult& result() const;
  /// What they were found from: the problem of the last step (its last substep, its last
  /// linearisation) or equilibrium. Of the points that took part, in the order of contacts and
  /// their points. Not part of the state: empty before the first step.
  step::ContactProblem problem() const;

 private:
  const Run& run_;
};

}  // namespace sinew::sim
