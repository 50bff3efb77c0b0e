/// @file
/// What the body of an arm carries from step to step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/own_rows.hpp"

namespace sinew::pcc {

/// One for a body, which its parts look at.
struct ArmState {
  /// At rest. @param coordinates,own of the model. @param histories see
  /// mechanics::history_count().
  ArmState(Eigen::Index coordinates, const mechanics::OwnRows& own, int histories);

  void restart();
  /// Of all but the start of the step in hand.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// (coordinates,): a combination of the motion in the step and of what was before it.
  void combine(const mechanics::Combination& weights, VectorX& result) const;

  VectorX q, rate;               ///< (coordinates,) rad and rad/s; extensions: m and m/s
  std::vector<VectorX> history;  ///< what the integrator keeps, (coordinates,) each
  mechanics::RowMemory memory;
  VectorX start;  ///< q at the start of the step; the rate stays that of its start until it ends
};

}  // namespace sinew::pcc
