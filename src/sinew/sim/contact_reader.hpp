/// @file
/// Contacts of a run as a user reads them.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/sim/contact_state.hpp"

namespace sinew::sim {

struct Run;

/// What the points of contacts do, after the last step. See Simulation.
class ContactReader {
 public:
  /// @param run outlives it.
  explicit ContactReader(const Run& run) : run_(run) {}
  /// @param contact of Model::contacts(). @param point of constraint::Contact::points().
  ContactPoint point(int contact, std::size_t point) const;
  std::vector<ContactPoint> points(int contact) const;
  ContactSum sum(int contact) const;
  ContactMoment moment(int contact) const;

 private:
  const Run& run_;
};

}  // namespace sinew::sim
