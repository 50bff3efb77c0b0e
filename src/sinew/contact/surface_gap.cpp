#include "sinew/contact/surface_gap.hpp"

#include <algorithm>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/surface_contact.hpp"

namespace sinew::contact {

namespace {

// The smallest distance is one of the local minima. The tolerance is for rounding: neighbours in
// parallel faces are equally near.
constexpr double kEquallyNear = 1e-9;

}  // namespace

SurfaceGap::SurfaceGap(const constraint::SurfaceContact& contact,
                       const constraint::Configuration& configuration, ThreadPool& pool)
    : contact_(contact),
      configuration_(configuration),
      pool_(pool),
      proximity_(pool),
      first_(contact.first().surface),
      second_(contact.second().surface) {}

double SurfaceGap::measure(double distance) {
  first_.move(configuration_.surface_nodes(contact_.body()), pool_);
  const collision::ProximitySettings settings{
      .distance = distance, .depth = contact_.depth(), .slack = kEquallyNear};
  if (!contact_.is_within()) {
    second_.move(configuration_.surface_nodes(contact_.other_body()), pool_);
  }
  const auto pairs = contact_.is_within() ? proximity_.within(first_, settings)
                                          : proximity_.between(first_, second_, settings);
  double least = kInfinity;
  for (const collision::ProximityPair& pair : pairs) {
    if (contact_.first().holds(pair.first) && contact_.second().holds(pair.second)) continue;
    least = std::min(least, pair.distance);
  }
  return least - contact_.separation();
}

}  // namespace sinew::contact
