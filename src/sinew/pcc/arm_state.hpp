/// @file
/// The state of an arm's body between steps.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/own_rows.hpp"

namespace sinew::pcc {

/// The state vector of an arm's body, shared by the parts of the body.
struct ArmState {
  /// Starts at rest. @param coordinates number of coordinates. @param own rows of the body.
  /// @param histories see mechanics::history_count().
  ArmState(Eigen::Index coordinates, const mechanics::OwnRows& own, int histories);

  void restart();
  /// Length of a saved state, which has everything except `start`.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// Computes a linear combination of the motion in the step, the rate at its start and the
  /// history.
  /// @param weights of the combination. @param result (coordinates,).
  void combine(const mechanics::Combination& weights, VectorX& result) const;

  VectorX q, rate;               ///< (coordinates,) rad and rad/s; extensions: m and m/s
  std::vector<VectorX> history;  ///< of the integrator, (coordinates,) each
  mechanics::RowMemory memory;
  VectorX start;  ///< q at the start of the step; `rate` is kept until its end
};

}  // namespace sinew::pcc
