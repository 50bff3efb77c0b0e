/// @file
/// What a run came to, for the table at its end: errors along the path, peak efforts, the final
/// effectors, and the largest stress and strain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sinew/sim/observables.hpp"

#include "session.hpp"

namespace sinew::cli {

/// Collects the figures of a run step by step.
class RunExtremes {
 public:
  /// @param session of the run, which outlives this.
  explicit RunExtremes(Session& session);
  /// Takes the present state. Call it after every step.
  void after_step();
  /// Rows of name and value, with the final state of the session.
  std::vector<std::vector<std::string>> rows();

 private:
  struct Peak {
    double value = 0.0;  ///< SI, with its sign
    double time = 0.0;   ///< s
    std::size_t observable = 0;
  };
  void add_errors(std::vector<std::vector<std::string>>& rows) const;
  void add_effectors(std::vector<std::vector<std::string>>& rows);
  void add_stresses(std::vector<std::vector<std::string>>& rows) const;

  Session& session_;
  sim::Observables observables_;
  std::vector<std::size_t> efforts_, effectors_;  ///< observables
  std::map<std::string, Peak> peaks_;             ///< by quantity, such as "tension"
  std::int64_t steps_ = 0;
  double error_sum_ = 0.0, error_max_ = 0.0, error_time_ = 0.0;
};

}  // namespace sinew::cli
