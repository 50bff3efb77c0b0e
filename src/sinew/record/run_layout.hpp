/// @file
/// Where an observable stands in what a run leaves behind. Writers and readers ask here.
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

/// The dataset of run.h5, as RunRecorder lists them: "/actuators/long_0/effort"; empty for what
/// would differ from run to run. @param observable any.
std::string dataset_of(const sim::Observable& observable);
/// Whether its dataset is part of a state, which `record: {states: false}` leaves out.
/// @param observable any.
bool is_state(const sim::Observable& observable);
/// Whether a table has columns of it: one for each of its components. @param observable,table
/// which.
bool is_in_table(const sim::Observable& observable, TableKind table);
/// Headings of its columns: "tip.x [m]". @param observable any.
std::vector<std::string> headings_of(const sim::Observable& observable);
/// What its numbers mean, where they stand for words: "0 open, 1 stick, 2 slip"; else empty.
/// @param observable any.
std::string meaning_of(const sim::Observable& observable);

}  // namespace sinew::record
