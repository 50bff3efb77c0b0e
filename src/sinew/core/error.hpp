/// @file
/// The exception for wrong input and failed runs. It carries the kind, the place, the offending
/// value and a remedy.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace sinew {

/// Kinds of wrong input and failed runs. The kebab-case name (`error_kind_name`) is part of the
/// interface: it is printed, and is `.kind` in Python.
enum class ErrorKind {
  // clang-format off
  file_not_found, file_unreadable, file_unwritable, unknown_format, truncated_file, malformed_file,
  size_limit, bad_encoding,
  // scene structure
  syntax_error, unknown_key, missing_key, duplicate_key, wrong_type, unknown_choice, unknown_name,
  not_in_this_version, unsupported_version, empty_list, conflicting_keys,
  // quantities
  wrong_dimension, unknown_unit, not_a_number, not_finite, out_of_range, contradictory_limits,
  wrong_length, bad_signal, non_monotonic_time,
  // meshes
  index_out_of_range, duplicate_node, zero_volume, inverted_element, repeated_node_in_element,
  disconnected_mesh, no_volume_elements, non_finite_node, suspicious_unit, point_outside_mesh,
  unknown_set, empty_region, everything_fixed, nothing_fixed, surface_not_closed,
  self_crossing, unsupported_element,
  // materials and bodies
  invalid_material, missing_mass, wrong_element,
  // actuators, effectors, controllers
  too_few_points, degenerate_cable, wrong_actuator_type, actuator_owned, no_actuators, no_effectors,
  degenerate_orientation, infeasible_limits,
  // tables
  malformed_table, wrong_columns,
  // runs
  diverged, inverted_in_run, not_converged, singular_matrix, recording_failed,
  // states
  state_version, state_mismatch, state_corrupt,
  // command line and Python
  unknown_option, bad_argument, wrong_shape, tool_missing, tool_failed,
  // browser view
  address_in_use, not_driving,
  // clang-format on
  internal,
};

/// Printed name of a kind, such as "unknown-key" or "point-outside-mesh".
std::string_view error_kind_name(ErrorKind kind);

/// The number of kinds, for tests that enumerate them.
int error_kind_count();

/// Location of an item in the input: a file position, and an argument or scene path such as
/// `bodies.trunk.mass`; either may be missing. Lines and columns start at 1; 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
  std::string item;

  /// Text such as "trunk.yaml:12:5: bodies.trunk.mass", without the parts that are unknown.
  std::string text() const;
};

/// Thrown for wrong input, and for runs that cannot continue.
/// `what()` reads "PLACE: MESSAGE; REMEDY [kind]".
class Error : public std::runtime_error {
 public:
  /// @param kind,place,message what is wrong, where, and a description with the offending value.
  /// @param remedy what to write or do instead; may be empty.
  Error(ErrorKind kind, Location place, std::string message, std::string remedy = {});

  ErrorKind kind() const { return kind_; }
  const Location& place() const { return place_; }
  const std::string& message() const { return message_; }
  const std::string& remedy() const { return remedy_; }

  /// A copy of this error whose unknown parts of the place are taken from `outer`.
  Error at(const Location& outer) const;

  /// True for a run that failed (exit code 1), false for wrong input (exit code 2).
  bool is_run_failure() const;

 private:
  ErrorKind kind_;
  Location place_;
  std::string message_;
  std::string remedy_;
};

/// The candidate nearest to `word` by edit distance, if it is near enough to be a likely typing
/// error; otherwise empty. For "did you mean" remedies.
template <typename Range>
std::string nearest_word(std::string_view word, const Range& candidates);

/// Damerau-Levenshtein distance (optimal string alignment), case-insensitive.
int edit_distance(std::string_view a, std::string_view b);

template <typename Range>
std::string nearest_word(std::string_view word, const Range& candidates) {
  std::string best;
  int best_distance = static_cast<int>(word.size()) / 3 + 2;
  for (const auto& candidate : candidates) {
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = std::string(candidate);
    }
  }
  return best;
}

}  // namespace sinew
