#include "sinew/sim/state_io.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/state_hash.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::sim {

namespace {

static_assert(std::endian::native == std::endian::little,
              "states are written as they lie in memory");

constexpr std::string_view kMagic = "SINEWST\n";

struct Header {
  char magic[8];
  std::uint32_t version;
  std::uint32_t reserved;
  std::uint64_t fingerprint;
  std::int64_t steps;
  std::uint64_t count;
};
static_assert(sizeof(Header) == 40);

[[noreturn]] void corrupt(const std::string& name, const std::string& what) {
  throw Error(ErrorKind::state_corrupt, {.file = name}, what,
              "save the state again with save_state");
}

}  // namespace

std::string format_state(const Simulation& simulation) {
  std::vector<double> state(simulation.state_size());
  simulation.save_state(state);
  Header header{};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  header.version = kStateVersion;
  header.fingerprint = simulation.model().fingerprint();
  header.steps = simulation.steps();
  header.count = state.size();
  const std::uint64_t hash = hash_doubles(state);
  std::string bytes(sizeof header + 8 * state.size() + sizeof hash, '\0');
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, state.data(), 8 * state.size());
  std::memcpy(bytes.data() + sizeof header + 8 * state.size(), &hash, sizeof hash);
  return bytes;
}

void parse_state(Simulation& simulation, std::string_view bytes, const std::string& name) {
  Header header;
  if (bytes.size() < sizeof header || bytes.substr(0, kMagic.size()) != kMagic) {
    corrupt(name, "this is not a saved state");
  }
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version != kStateVersion) {
    throw Error(ErrorKind::state_version, {.file = name},
                fmt::format("the state has format version {}, this program reads version {}",
                            header.version, kStateVersion),
                "save it again with this version of Sinew");
  }
  if (header.fingerprint != simulation.model().fingerprint() ||
      header.count != simulation.state_size()) {
    throw Error(ErrorKind::state_mismatch, {.file = name},
                fmt::format("the state is of another robot (fingerprint {:016x}, {} numbers; this "
                            "one has {:016x}, {})",
                            header.fingerprint, header.count, simulation.model().fingerprint(),
                            simulation.state_size()),
                "load it into a simulation of the scene that it was saved from");
  }
  const std::size_t size = simulation.state_size();
  if (bytes.size() != sizeof header + 8 * size + 8) {
    corrupt(name, fmt::format("the file has {} bytes where {} belong", bytes.size(),
                              sizeof header + 8 * size + 8));
  }
  std::vector<double> state(size);
  std::uint64_t hash = 0;
  std::memcpy(state.data(), bytes.data() + sizeof header, 8 * size);
  std::memcpy(&hash, bytes.data() + sizeof header + 8 * size, sizeof hash);
  if (hash != hash_doubles(state)) corrupt(name, "the numbers do not fit their hash");
  if (header.steps < 0) corrupt(name, fmt::format("the step count is {}", header.steps));
  for (const double value : state) {
    if (!std::isfinite(value)) corrupt(name, "a number is not finite");
  }
  simulation.load_state(state, header.steps);
}

void save_state(const Simulation& simulation, const std::filesystem::path& path) {
  mesh::write_file(path, format_state(simulation));
}

void load_state(Simulation& simulation, const std::filesystem::path& path) {
  parse_state(simulation, mesh::read_file(path), path.string());
}

}  // namespace sinew::sim
