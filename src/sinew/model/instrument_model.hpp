/// @file
/// What observes a robot: sensors and estimators, as immutable parts of a model.
#pragma once

#include <cstdint>
#include <memory>

namespace sinew::run {
class Instrument;
struct Run;
}  // namespace sinew::run

namespace sinew::model {

/// The immutable part of an Instrument. A model holds its instruments in the order in which they
/// read each other: each may read those before it. They are not part of Model::parts(), since the
/// motion does not depend on them.
class InstrumentModel {
 public:
  InstrumentModel() = default;
  virtual ~InstrumentModel() = default;
  InstrumentModel(const InstrumentModel&) = delete;
  InstrumentModel& operator=(const InstrumentModel&) = delete;

  /// Hash of all that decides what the instrument's memory means, including its kind and name:
  /// states identify it by that, so it differs from those of the model's other instruments.
  virtual std::uint64_t hash() const = 0;
  /// The instrument of one run, before Instrument::begin().
  /// @param run that it observes, which outlives it and may still be incomplete.
  virtual std::unique_ptr<run::Instrument> start(const run::Run& run) const = 0;
};

}  // namespace sinew::model
