/// @file
/// What observes a run without changing it: sensors and estimators.
#pragma once

#include <span>
#include <vector>

#include "sinew/run/observable.hpp"

namespace sinew::run {

/// How an equilibrium was reached.
enum class Rest {
  found,        ///< by a search
  on_path,      ///< a point of a path, on which loads and commands act partially
  end_of_path,  ///< the last of these points, after it was observed as such
};

/// Observes a run. It only observes: the run is the same, bit for bit, with and without it. It may
/// have a memory, which is part of the state of a simulation but not of the states between which a
/// step, a search or a path goes back and forth: these never change it.
class Instrument {
 public:
  Instrument() = default;
  virtual ~Instrument() = default;
  Instrument(const Instrument&) = delete;
  Instrument& operator=(const Instrument&) = delete;

  /// Starts afresh, as if the run began now.
  virtual void begin() = 0;
  /// Observes after a step.
  virtual void advance() = 0;
  /// Observes an equilibrium, as if the robot had rested there for long. Time does not advance.
  virtual void settle(Rest rest) = 0;

  /// Appends its memory as finite numbers.
  virtual void save(std::vector<double>& memory) const = 0;
  /// Restores its memory. @param memory that an instrument of the same InstrumentModel::hash()
  ///   saved.
  /// Throws Error(wrong-length) if it is incomplete; begin() must then be called, which resets all
  /// that may have changed.
  virtual void load(std::span<const double> memory) = 0;

  /// What can be read of it. The readings are valid as long as it is.
  virtual std::vector<Reading> readings() const = 0;
};

}  // namespace sinew::run
