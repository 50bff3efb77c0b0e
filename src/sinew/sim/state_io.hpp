/// @file
/// State files of simulations: versioned, checked, and tied to one model.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/named_hash.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::run {
struct State;
}

namespace sinew::sim {

class Simulation;

/// Version of the layout. A file consists of little-endian words of 8 bytes: "SINEWST\n"; format
/// version (uint32) and 4 zero bytes; the model's fingerprint (uint64); step count (int64); the
/// model's parts, see Model::parts(): their number (uint64), and for each its hash (uint64), the
/// length of its name (uint64) and the name, padded with zeros; the number of bodies (uint64);
/// everything that State::visit() visits, as float64, each list after its length (uint64); a hash
/// of all words before it (uint64). Commands are inputs and therefore not part of it.
///
/// A change of the layout, of what the fingerprint hashes or of what State::visit() visits requires
/// a new kStateVersion. States of all versions from kOldestStateVersion on can be read; sample
/// files are kept in python/tests/states.
inline constexpr std::uint32_t kStateVersion = 16, kOldestStateVersion = 6;

/// Metadata of a saved state.
struct StateHeader {
  std::uint32_t version = 0;
  std::uint64_t fingerprint = 0;  ///< of the model
  std::int64_t steps = 0;
  std::vector<NamedHash> parts;  ///< of the model
  std::uint64_t count = 0;       ///< numbers in the state
};

/// Reads and checks a saved state without restoring it.
/// @param bytes the whole file. @param name its name, for messages.
/// Throws Error(state-corrupt), Error(state-version).
StateHeader read_state_header(std::string_view bytes, const std::string& name);

/// Whether bytes begin like a saved state. @param bytes at least the first eight of a file.
bool is_state(std::string_view bytes);

/// Formats a state of a model as bytes.
std::string format_state(const run::State& state, const model::Model& model);
/// Formats the present state as bytes.
std::string format_state(const Simulation& simulation);

/// Parses a state for simulations of a model.
/// @param bytes the whole file. @param model must be the one that was saved.
/// @param name of the file, for messages. Throws as parse_state() does.
run::State read_state(std::string_view bytes, const model::Model& model, const std::string& name);

/// Restores a state, after which the run continues bit for bit as it would have. Solver settings
/// (tolerances, tangent, factorisation) may differ from those of the saved run; the simulation's
/// own then apply.
/// @param simulation whose state is set. @param bytes the whole file. @param name its name, for
///   messages.
/// Throws Error: state-corrupt (no state, truncated, damaged, not finite), state-version,
/// state-mismatch, whose text names the differences; the simulation is then unchanged.
void parse_state(Simulation& simulation, std::string_view bytes, const std::string& name);

/// Writes the state to a file, which appears complete or not at all. Throws Error(file-unwritable).
void save_state(const Simulation& simulation, const std::filesystem::path& path);

/// Reads the state from a file. Throws as parse_state() does, and Error(file-not-found,
/// file-unreadable).
void load_state(Simulation& simulation, const std::filesystem::path& path);

}  // namespace sinew::sim
