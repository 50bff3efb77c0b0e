/// @file
/// Contacts of a run as a user reads them.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/sim/contact_state.hpp"

namespace sinew::qp {
struct ConeResult;
}

namespace sinew::sim {

struct Run;

/// What the points of contacts do, after the last step.
class ContactReader {
 public:
  /// @param run outlives it.
  explicit ContactReader(const Run& run) : run_(run) {}
  /// @param contact of Model::contacts(). @param point of constraint::Contact::points().
  ContactPoint point(int contact, std::size_t point) const;
  std::vector<ContactPoint> points(int contact) const;
  ContactSum sum(int contact) const;
  /// The points and where the surface stands.
  ContactSnapshot snapshot(int contact) const;
  /// How the forces were last found.
  const qp::ConeResult& result() const;

 private:
  const Run& run_;
};

}  // namespace sinew::sim
