// Random snapshots with rows of a stiff and a soft robot, hands and contacts.
#pragma once

#include <Eigen/QR>

#include "sinew/core/random.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"
#include "sinew/high_rate/snapshot.hpp"

namespace sinew::testing {

inline double spread(Random& random) { return random.uniform(-1.0, 1.0); }

/// Settings with eight driven rows, three unknown forces, six effector rows and `hands` hands.
inline high_rate::HighRateSettings robot_settings(int hands = 1, int contacts = 12) {
  high_rate::HighRateSettings settings;
  settings.driven.assign(8, {.effort_min = 0.0, .effort_max = 20.0});
  settings.unknown.assign(3, {.prior = 2.0});
  settings.observed = 6;
  settings.hands.assign(static_cast<std::size_t>(hands), {.min = 0.0});
  for (int row = 11; row < 14; ++row) settings.tasks.push_back({row});
  settings.max_contacts = contacts;
  return settings;
}

/// Adds sensors for the lengths of all driven rows and all effectors, with micrometre deviations.
inline void add_sensors(high_rate::HighRateSettings& settings) {
  for (int row = 0; row < 8; ++row) settings.sensors.push_back({row, 1e-6});
  for (int row = 11; row < 17; ++row) settings.sensors.push_back({row, 1e-6});
}

/// A random snapshot. Its W is that of a random body with more coordinates than rows: positive
/// definite, of about 1 mm/N. Gaps are about a millimetre, of either sign.
inline high_rate::Snapshot random_snapshot(const high_rate::HighRateSettings& settings,
                                           Random& random, double friction = 0.3) {
  const Eigen::Index rows = settings.first_contact() + 3 * Eigen::Index{settings.max_contacts};
  const Eigen::Index coordinates = rows + 10;
  MatrixX h(rows, coordinates);
  for (double& entry : h.reshaped()) entry = spread(random);
  high_rate::Snapshot snapshot;
  snapshot.compliance = 1e-3 * h * h.transpose() / static_cast<double>(coordinates);
  snapshot.free.resize(rows);
  for (double& entry : snapshot.free) entry = 1e-3 * spread(random);
  snapshot.effort = VectorX::Zero(rows);
  snapshot.friction.assign(static_cast<std::size_t>(settings.max_contacts), friction);
  snapshot.size = 0.2;
  snapshot.number = 1;
  return snapshot;
}

}  // namespace sinew::testing
