/// @file
/// Simulations that are stepped side by side, by threads that no Python code runs in.
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

/// Row-major, a row for each simulation.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// See the file. Every thread has a contiguous block of the simulations, and a simulation does the
/// same in any block: results do not depend on the number of threads.
class Batch {
 public:
  /// @param sessions at least one, none twice. @param threads >= 1.
  /// Throws Error(empty-list | bad-argument | out-of-range).
  Batch(std::vector<std::shared_ptr<Session>> sessions, int threads);

  std::size_t size() const { return members_.size(); }
  int threads() const { return pool_.size(); }
  /// Throws Error(index-out-of-range).
  const std::shared_ptr<Session>& at(std::size_t index) const;
  /// Tells all actuators of those that `which` chooses a constant.
  /// @param quantity of every actuator, such as "torque". @param values (size(), actuators).
  /// @param which (size(),); empty: all.
  /// Throws Error(wrong-shape | wrong-actuator-type | out-of-range | not-finite | actuator-owned).
  void command(const std::string& quantity, const Rows& values, std::span<const bool> which);

  /// Advances those that `which` chooses, without the interpreter's lock. @param which see
  /// command(). @return for each, the failure that ended its steps. What is no failure of a run is
  /// thrown. Ctrl-C ends the steps at hand; simulations may then be at different times.
  std::vector<std::optional<Error>> step(std::int64_t count, std::span<const bool> which);

  /// (size(), numbers): observables side by side. @param names see sim::Observables.
  /// Throws Error(unknown-name); wrong-shape where one has more numbers in some simulation.
  Rows read(const std::vector<std::string>& names);

 private:
  struct Member {
    std::shared_ptr<Session> session;
    std::vector<std::size_t> columns;  // where the names read last are among its observables
    std::optional<Error> failure;
    std::exception_ptr other;
  };

  void find(Member& member) const;
  static void advance(Member& member, std::int64_t count, const std::function<bool()>& ended);

  std::vector<Member> members_;
  std::vector<std::string> names_;  // read last
  std::size_t width_ = 0;           // numbers of them all
  ThreadPool pool_;
};

}  // namespace sinew::python
