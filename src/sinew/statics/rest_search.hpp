/// @file
/// Quasi-static steps of robots that have no tangent, or in which weight, cables or contacts hold
/// what fixed nodes and joints leave free.
#pragma once

#include "sinew/statics/overdamped_motion.hpp"
#include "sinew/statics/settling.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/statics/static_settings.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// Finds a stable equilibrium of a quasi-static step by overdamped motion, which needs no tangent
/// that can be factorised.
class RestSearch {
 public:
  /// @param run in a quasi-static step, which has begun. @param time_step s.
  RestSearch(run::Run& run, double time_step);

  /// Falls from the start of the step into an equilibrium. @param failed report of the search
  /// before. @return that of the equilibrium, or `failed` if none was found.
  run::NewtonReport relax(const run::NewtonReport& failed);
  /// Leaves an unstable equilibrium for a stable one. Throws Error(singular-matrix) in a neutral
  /// one, see Settling::require_held(). @param settings of the step. @param result in and out.
  void settle(const run::NewtonSettings& settings, run::NewtonReport& result);
  StaticSearch& search() { return search_; }

 private:
  run::Run& run_;
  double time_step_;
  StaticSettings settings_;
  StaticSearch search_;
  OverdampedMotion motion_;
};

/// Throws Error(singular-matrix) after a quasi-static step that found no equilibrium, if a motion
/// is free, with its name; also if the matrix is singular for another reason. @param run in
/// the state where the search ended. @param status of the search that failed. @param time_step s.
void fail_if_free(run::Run& run, run::NewtonStatus status, double time_step);

}  // namespace sinew::statics
