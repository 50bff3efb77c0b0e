/// @file
/// Maps observables to the datasets and columns of a recorded run. Writers and readers share it.
#pragma once

#include <string>
#include <vector>

#include "sinew/sim/observables.hpp"

namespace sinew::record {

/// The tables of a run.
enum class TableKind {
  run,      ///< run.csv
  probes,   ///< probes.csv
  sensors,  ///< sensors.csv
};

/// Path of the dataset in run.h5, as listed at RunRecorder: "/actuators/long_0/effort". Empty for
/// timings, which would differ from run to run. @param observable any.
std::string dataset_of(const run::Observable& observable);
/// Whether the dataset is part of the states, which `record: {states: false}` omits.
/// @param observable any.
bool is_state(const run::Observable& observable);
/// Whether a table has columns for an observable, one for each component.
/// @param observable,table which.
bool is_in_table(const run::Observable& observable, TableKind table);
/// Headings of the columns: "tip.x [m]". @param observable any.
std::vector<std::string> headings_of(const run::Observable& observable);
/// Meaning of the numbers if they are codes of words: "0 open, 1 stick, 2 slip"; else empty.
/// @param observable any.
std::string meaning_of(const run::Observable& observable);

}  // namespace sinew::record
