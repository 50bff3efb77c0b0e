/// @file
/// Simulations that are stepped in parallel, by threads in which no Python code runs.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"

#include "session.hpp"

namespace sinew::python {

/// Row-major matrix with one row per simulation.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A batch of simulations. Every thread steps a contiguous block of them. A simulation does the
/// same in every block, so results do not depend on the number of threads.
class Batch {
 public:
  /// @param sessions at least one, all different. @param threads >= 1.
  /// Throws Error(empty-list | bad-argument | out-of-range).
  Batch(std::vector<std::shared_ptr<Session>> sessions, int threads);

  std::size_t size() const { return members_.size(); }
  int threads() const { return pool_.size(); }
  /// The simulation at an index. Throws Error(index-out-of-range).
  const std::shared_ptr<Session>& at(std::size_t index) const;
  /// Commands constants to all actuators of the selected simulations.
  /// @param quantity of every actuator, such as "torque". @param values (size(), actuators).
  /// @param which selected simulations, (size(),); empty: all.
  /// Throws Error(wrong-shape | wrong-actuator-type | out-of-range | not-finite | actuator-owned).
  void command(const std::string& quantity, const Rows& values, std::span<const bool> which);

  /// Advances the selected simulations without the GIL. Errors other than failures of a run are
  /// thrown. Ctrl-C ends the current steps; simulations may then be at different times.
  /// @param count number of steps. @param which selected simulations, (size(),); empty: all.
  /// @return for each simulation, the failure that ended its steps, if any.
  std::vector<std::optional<Error>> step(std::int64_t count, std::span<const bool> which);

  /// Reads observables, (size(), numbers). Throws Error(unknown-name), and Error(wrong-shape) if
  /// their shapes differ between simulations. @param names of observables, see sim::Observables.
  Rows read(const std::vector<std::string>& names);

 private:
  struct Member {
    std::shared_ptr<Session> session;
    std::vector<std::size_t> columns;  // indices of the names read last in its observables
    std::optional<Error> failure;
    std::exception_ptr other;
  };

  void find(Member& member) const;
  static void advance(Member& member, std::int64_t count, const std::function<bool()>& ended);

  std::vector<Member> members_;
  std::vector<std::string> names_;  // names read last
  std::size_t width_ = 0;           // total of their numbers
  ThreadPool pool_;
};

}  // namespace sinew::python
