#include "sinew/sim/state_io.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <span>
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

std::uint64_t hash_of(const Header& header, std::span<const double> numbers) {
  StateHash hash;
  hash.add(header.fingerprint);
  hash.add(static_cast<std::uint64_t>(header.steps));
  hash.add(header.count);
  hash.add(numbers);
  return hash.value();
}

// The numbers between header and hash, whose count was checked.
std::vector<double> numbers_of(std::string_view bytes) {
  std::vector<double> numbers((bytes.size() - sizeof(Header)) / 8 - 1);
  std::memcpy(numbers.data(), bytes.data() + sizeof(Header), 8 * numbers.size());
  return numbers;
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
  const std::uint64_t hash = hash_of(header, state);
  std::string bytes(sizeof header + 8 * state.size() + sizeof hash, '\0');
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, state.data(), 8 * state.size());
  std::memcpy(bytes.data() + sizeof header + 8 * state.size(), &hash, sizeof hash);
  return bytes;
}

bool is_state(std::string_view bytes) { return bytes.starts_with(kMagic); }

StateHeader read_state_header(std::string_view bytes, const std::string& name) {
  Header header;
  if (bytes.size() < sizeof header || !is_state(bytes)) corrupt(name, "this is not a saved state");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.version != kStateVersion) {
    throw Error(ErrorKind::state_version, {.file = name},
                fmt::format("the state has format version {}, this program reads version {}",
                            header.version, kStateVersion),
                "save it again with this version of Sinew");
  }
  if (header.reserved != 0) corrupt(name, "bytes that must be zero are not");
  const std::size_t rest = bytes.size() - sizeof header;
  if (rest < 8 || rest % 8 != 0 || header.count != rest / 8 - 1) {
    corrupt(name, fmt::format("{} bytes follow where {} numbers and their hash belong", rest,
                              header.count));
  }
  if (header.steps < 0) corrupt(name, fmt::format("the step count is {}", header.steps));
  const std::vector<double> state = numbers_of(bytes);
  std::uint64_t hash = 0;
  std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
  if (hash != hash_of(header, state)) corrupt(name, "the numbers do not fit their hash");
  for (const double value : state) {
    if (!std::isfinite(value)) corrupt(name, "a number is not finite");
  }
  return {header.version, header.fingerprint, header.steps, header.count};
}

void parse_state(Simulation& simulation, std::string_view bytes, const std::string& name) {
  const StateHeader header = read_state_header(bytes, name);
  if (header.fingerprint != simulation.model().fingerprint() ||
      header.count != simulation.state_size()) {
    throw Error(ErrorKind::state_mismatch, {.file = name},
                fmt::format("the state is of another robot (fingerprint {:016x}, {} numbers; this "
                            "one has {:016x}, {})",
                            header.fingerprint, header.count, simulation.model().fingerprint(),
                            simulation.state_size()),
                "load it into a simulation of the scene that it was saved from");
  }
  simulation.load_state(numbers_of(bytes), header.steps);
}

void save_state(const Simulation& simulation, const std::filesystem::path& path) {
  mesh::write_file(path, format_state(simulation));
}

void load_state(Simulation& simulation, const std::filesystem::path& path) {
  parse_state(simulation, mesh::read_file(path), path.string());
}

}  // namespace sinew::sim
