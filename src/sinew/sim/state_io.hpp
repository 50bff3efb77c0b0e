/// @file
/// States of simulations as files: versioned, checked, and of one model only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/named_hash.hpp"

namespace sinew::sim {

class Model;
class Simulation;
struct State;

/// The layout, in little-endian words of 8 bytes: "SINEWST\n"; format version (uint32) and 4 bytes
/// of zeros; the model's fingerprint (uint64); step count (int64); the model's parts, see
/// Model::parts(): how many (uint64), and of each its hash (uint64), the length of its name
/// (uint64) and the name, filled up with zeros; the count of bodies (uint64); all that
/// State::visit() comes to, float64, a list behind its count (uint64); a hash of all words before
/// it (uint64). Commands are inputs, not state, and are not part of it.
///
/// Whoever changes the layout, what the fingerprint hashes or what State::visit() comes to raises
/// kStateVersion and reads states of all versions from kOldestStateVersion on, of which files are
/// kept (python/tests/states).
/// States without estimators, and without sensors, are those of the versions before these, and are
/// written as such.
inline constexpr std::uint32_t kStateVersion = 10, kVersionWithoutEstimators = 9,
                               kVersionWithoutSensors = 8, kOldestStateVersion = 6;

/// What a saved state says of itself.
struct StateHeader {
  std::uint32_t version = 0;
  std::uint64_t fingerprint = 0;  ///< of the model
  std::int64_t steps = 0;
  std::vector<NamedHash> parts;  ///< of the model
  std::uint64_t count = 0;       ///< numbers
};

/// Reads and checks a saved state without a simulation to put it into.
/// @param bytes the whole file. @param name its name, for messages.
/// Throws Error(state-corrupt), Error(state-version).
StateHeader read_state_header(std::string_view bytes, const std::string& name);

/// Whether bytes start as saved states do. @param bytes at least the first eight of a file.
bool is_state(std::string_view bytes);

/// A state of a model as bytes.
std::string format_state(const State& state, const Model& model);
/// The present state as bytes.
std::string format_state(const Simulation& simulation);

/// The state that bytes hold, for simulations of a model.
/// @param bytes the whole file. @param model must be the one that it was saved from.
/// @param name of the file, for messages. Throws as parse_state() does.
State read_state(std::string_view bytes, const Model& model, const std::string& name);

/// Puts a state back, after which the run goes on bit for bit as it would have. How steps are
/// solved (tolerances, tangent, factorisation) may differ; then it goes on by that.
/// @param simulation,bytes what is set, and the whole file. @param name its name, for messages.
/// Throws Error: state-corrupt (no state, truncated, damaged, not finite), state-version,
/// state-mismatch, which names what differs; the simulation is then unchanged.
void parse_state(Simulation& simulation, std::string_view bytes, const std::string& name);

/// Writes the state; the file appears whole or not at all. Throws Error(file-unwritable).
void save_state(const Simulation& simulation, const std::filesystem::path& path);

/// Reads it back. Throws as parse_state(), and Error(file-not-found, file-unreadable).
void load_state(Simulation& simulation, const std::filesystem::path& path);

}  // namespace sinew::sim
