/// @file
/// The instruments of one run.
#pragma once

#include <memory>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/run/instrument.hpp"

namespace sinew::run {

struct Run;

/// The instruments of a run, in the order of Model::instruments(), in which they observe.
class Instruments {
 public:
  /// @param run that outlives them; it may still be incomplete.
  explicit Instruments(const Run& run);

  const std::vector<std::unique_ptr<Instrument>>& all() const { return all_; }
  /// The instrument of a type. Throws Error(unknown-name) if the model has none.
  template <class T>
  T& get() {
    return found<T>();
  }
  template <class T>
  const T& get() const {
    return found<T>();
  }

  /// See Instrument.
  void begin();
  void advance();
  void settle(Rest rest);

  /// Writes the memory of each instrument, after the hash of its model.
  /// @param memories (instruments,) lists of finite numbers, overwritten.
  void save(std::vector<std::vector<double>>& memories) const;
  /// Restores the memory of each instrument whose hash is among the lists; the others begin afresh,
  /// as do those whose memory is damaged. @param memories as save() writes them, in any order.
  /// Throws Error(wrong-length) after all have been restored if a memory was damaged.
  void load(const std::vector<std::vector<double>>& memories);

 private:
  template <class T>
  T& found() const {
    for (const auto& one : all_) {
      if (auto* match = dynamic_cast<T*>(one.get())) return *match;
    }
    throw Error(ErrorKind::unknown_name, {}, "the robot has no such instrument",
                "add a sensor or an estimator to the scene");
  }

  std::vector<std::unique_ptr<Instrument>> all_;
  std::vector<double> marks_;  // (instruments,) hashes of their models
};

}  // namespace sinew::run
