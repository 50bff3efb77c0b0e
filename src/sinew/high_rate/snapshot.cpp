#include "sinew/high_rate/snapshot.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"

namespace sinew::high_rate {

namespace {

[[noreturn]] void refuse(ErrorKind kind, std::string message, std::string remedy) {
  throw Error(kind, {.item = "snapshot"}, std::move(message), std::move(remedy));
}

void check_shapes(const Snapshot& snapshot, const HighRateSettings& settings) {
  if (snapshot.contacts() > settings.max_contacts) {
    refuse(ErrorKind::out_of_range,
           fmt::format("it has {} contacts, and the loop has memory for {}", snapshot.contacts(),
                       settings.max_contacts),
           "leave out contacts, or raise max_contacts");
  }
  const Eigen::Index rows = settings.first_contact() + 3 * snapshot.contacts();
  if (snapshot.compliance.rows() != rows || snapshot.compliance.cols() != rows ||
      snapshot.free.size() != rows || snapshot.effort.size() != rows) {
    refuse(ErrorKind::wrong_shape,
           fmt::format("compliance ({}, {}), free ({},) and effort ({},) are not of {} rows",
                       snapshot.compliance.rows(), snapshot.compliance.cols(), snapshot.free.size(),
                       snapshot.effort.size(), rows),
           "give driven, unknown, observed and hands' rows, then three of each contact");
  }
}

}  // namespace

void check(const Snapshot& snapshot, const HighRateSettings& settings) {
  check_shapes(snapshot, settings);
  if (!snapshot.compliance.allFinite() || !snapshot.free.allFinite() ||
      !snapshot.effort.allFinite() || !std::isfinite(snapshot.time)) {
    refuse(ErrorKind::not_finite, "it has numbers that are not finite",
           "look at the simulation's step it was taken from");
  }
  if (!(snapshot.size > 0.0) || !std::isfinite(snapshot.size)) {
    refuse(ErrorKind::out_of_range, fmt::format("size is {}", snapshot.size),
           "give the robot's size, m, > 0");
  }
  for (std::size_t k = 0; k < snapshot.friction.size(); ++k) {
    if (snapshot.friction[k] >= 0.0 && std::isfinite(snapshot.friction[k])) continue;
    refuse(ErrorKind::out_of_range,
           fmt::format("friction of contact {} is {}", k, snapshot.friction[k]),
           "give Coulomb's coefficients >= 0");
  }
  for (Eigen::Index row = settings.free_rows(); row < snapshot.rows(); ++row) {
    if (snapshot.compliance(row, row) > 0.0) continue;
    refuse(ErrorKind::out_of_range,
           fmt::format("row {} has a compliance of {} m/N", row, snapshot.compliance(row, row)),
           "leave out contacts and hands that nothing yields to");
  }
}

}  // namespace sinew::high_rate
