/// @file
/// A quantity that can be observed in a run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::run {

/// The kind of part to which an observable belongs. The list is sorted by kind, in this order.
enum class ObservableKind {
  time,
  body,           ///< positions and velocities of all nodes, coordinates of an arm
  actuator,       ///< effort, motion and commands
  effector,       ///< position or rotation
  probe,          ///< measured value
  sensor,         ///< measured and true value
  contact_point,  ///< all points of a contact, and the pose of its surface
  contact,        ///< resultant of a contact
  joint,          ///< force, moment, gap and motion
  estimator,      ///< unknowns, their standard deviations, and its status
  controller,     ///< targets and errors
  energy,         ///< of all bodies; evaluates their elements
  ledger,         ///< work and losses since the first reading; evaluates the elements, too
  report,         ///< numerical results of the last step
  status,         ///< status word of the last step
  timing,         ///< computing time: differs from run to run
};

/// A status word and the number that represents it.
struct StatusWord {
  int code = 0;
  std::string_view word;
};

/// One observable quantity: a scalar, a vector or a table.
struct Observable {
  std::string name;                ///< "long_0.tension", "tip.position", "residual"
  std::string unit;                ///< SI; empty for counts, ratios and words
  std::vector<std::size_t> shape;  ///< at one time; empty for a scalar
  ObservableKind kind = ObservableKind::report;
  std::string owner;     ///< name of the actuator, effector, ...; empty: the whole robot
  std::string quantity;  ///< general name of the quantity: "effort", "position"
  /// Names of the components, as in a table: "tip.x", "tip.y", "tip.z"; empty if there are too
  /// many.
  std::vector<std::string> components;
  std::vector<StatusWord> words;  ///< if its numbers represent words

  /// Number of components.
  std::size_t size() const;
  /// The word that a number represents; empty if there is none.
  std::string_view word(double number) const;
};

/// An observable named after its owner and its quantity: "OWNER.QUANTITY".
/// @param kind,owner,quantity,unit,shape see Observable.
Observable observable_of(ObservableKind kind, const std::string& owner, const std::string& quantity,
                         const char* unit, std::vector<std::size_t> shape = {});

/// Observables that are read together, and how.
struct Reading {
  std::vector<Observable> parts;
  /// Writes the values of `parts`, one after the other.
  std::function<void(std::span<double>)> fill;
};

/// Writes numbers in the order of the observables that share a reading.
class Numbers {
 public:
  explicit Numbers(std::span<double> numbers) : next_(numbers.begin()) {}
  void put(double number) { *next_++ = number; }
  void put(const Vector3& vector) { next_ = std::copy_n(vector.data(), 3, next_); }

 private:
  std::span<double>::iterator next_;
};

}  // namespace sinew::run
