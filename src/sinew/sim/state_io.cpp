#include "sinew/sim/state_io.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/state_hash.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/model_parts.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

static_assert(std::endian::native == std::endian::little,
              "states are written as they lie in memory");

constexpr std::string_view kMagic = "SINEWST\n";
constexpr std::size_t kWord = 8;

// What older versions lack, and the first version with it.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 13> kIntroduced = {
    {{"joints", 7},
     {"points", 8},
     {"outside power", 11},
     {"damping power", 11},
     {"energy through", 11},
     {"energy settled", 11},
     {"energy gained", 11},
     {"failure", 11},
     {"afresh", 11},
     {"correction", 12},
     {"kept factors", 13},
     {"end efforts", 14},
     {"doubtful dissipation", 14}}};

bool lacks(std::uint32_t version, std::string_view part) {
  return std::ranges::any_of(kIntroduced, [&](const auto& introduced) {
    return introduced.first == part && version < introduced.second;
  });
}

// Older versions count no instruments: they have one list of the sensors, and one of the
// estimators, which are empty without any.
constexpr std::uint32_t kSensors = 9, kEstimators = 10, kInstruments = 16;

constexpr std::size_t kPreamble = 2 * kWord;  // magic and version

[[noreturn]] void corrupt(const std::string& name, const std::string& what) {
  throw Error(ErrorKind::state_corrupt, {.file = name}, what,
              "save the state again with save_state");
}

std::uint64_t hash_of(std::string_view bytes) {
  StateHash hash;
  for (std::size_t at = 0; at + kWord <= bytes.size(); at += kWord) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, kWord);
    hash.add(word);
  }
  return hash.value();
}

class Writer {
 public:
  void word(std::uint64_t value) { append(&value, kWord); }
  void text(std::string_view text) {
    word(text.size());
    append(text.data(), text.size());
    bytes_.resize((bytes_.size() + kWord - 1) / kWord * kWord, '\0');
  }
  void number(double number) { append(&number, kWord); }
  void number(const std::vector<double>& numbers) {
    word(numbers.size());
    append(numbers.data(), kWord * numbers.size());
  }
  void append(const void* from, std::size_t size) {
    bytes_.append(static_cast<const char*>(from), size);
  }
  std::string finish() {
    word(hash_of(bytes_));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

// Reads with bounds checks.
class Reader {
 public:
  // @param bytes between the preamble and the hash.
  Reader(std::string_view bytes, std::string name) : rest_(bytes), name_(std::move(name)) {}

  std::uint64_t word() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(kWord).data(), kWord);
    return value;
  }
  // Number of items that take at least one word each.
  std::size_t count() {
    const std::uint64_t value = word();
    if (value > rest_.size() / kWord) corrupt(name_, "a count is larger than the file");
    return static_cast<std::size_t>(value);
  }
  std::string text() {
    const std::uint64_t size = word();
    if (size > rest_.size()) corrupt(name_, "a name is longer than the file");
    const std::size_t filled = (static_cast<std::size_t>(size) + kWord - 1) / kWord * kWord;
    return std::string(take(filled).substr(0, static_cast<std::size_t>(size)));
  }
  void number(double& number) {
    number = std::bit_cast<double>(word());
    if (!std::isfinite(number)) corrupt(name_, "a number is not finite");
  }
  void number(std::vector<double>& numbers) {
    numbers.resize(count());
    for (double& x : numbers) number(x);
  }
  bool done() const { return rest_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) corrupt(name_, "the file ends too early");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::string_view rest_;
  std::string name_;
};

struct SavedState {
  StateHeader header;
  run::State state;
};

SavedState read(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kPreamble || !is_state(bytes)) corrupt(name, "this is not a saved state");
  SavedState saved;
  std::uint32_t version[2];
  std::memcpy(version, bytes.data() + kMagic.size(), sizeof version);
  saved.header.version = version[0];
  if (version[0] < kOldestStateVersion || version[0] > kStateVersion) {
    throw Error(ErrorKind::state_version, {.file = name},
                fmt::format("the state has format version {}, this program reads versions {} to {}",
                            version[0], kOldestStateVersion, kStateVersion),
                version[0] > kStateVersion ? "load it with the version of Sinew that saved it"
                                           : "save it again with this version of Sinew");
  }
  if (version[1] != 0) corrupt(name, "bytes that must be zero are not");
  if (bytes.size() % kWord != 0 || bytes.size() < kPreamble + kWord) {
    corrupt(name, "the file is not of whole words");
  }
  const std::string_view body = bytes.substr(0, bytes.size() - kWord);
  std::uint64_t hash = 0;
  std::memcpy(&hash, bytes.data() + body.size(), kWord);
  if (hash != hash_of(body)) corrupt(name, "the content does not fit its hash");
  Reader reader(body.substr(kPreamble), name);
  saved.header.fingerprint = reader.word();
  saved.header.steps = static_cast<std::int64_t>(reader.word());
  if (saved.header.steps < 0) {
    corrupt(name, fmt::format("the step count is {}", saved.header.steps));
  }
  saved.header.parts.resize(reader.count());
  for (NamedHash& part : saved.header.parts) {
    part.hash = reader.word();
    part.name = reader.text();
  }
  run::State& state = saved.state;
  state.steps = saved.header.steps;
  state.bodies.resize(reader.count());
  const std::uint32_t from = saved.header.version;
  state.instruments.resize(from >= kInstruments  ? reader.count()
                           : from >= kEstimators ? 2
                           : from >= kSensors    ? 1
                                                 : 0);
  run::State::visit(state, [&](std::string_view part, auto& numbers) {
    if (!lacks(saved.header.version, part)) reader.number(numbers);
  });
  std::erase_if(state.instruments, [](const auto& memory) { return memory.empty(); });
  if (!reader.done()) corrupt(name, "something follows the last number");
  saved.header.count = state.size();
  return saved;
}

}  // namespace

std::string format_state(const Simulation& simulation) {
  return format_state(simulation.state(), simulation.model());
}

std::string format_state(const run::State& state, const model::Model& model) {
  Writer writer;
  writer.append(kMagic.data(), kMagic.size());
  const std::uint32_t version[2] = {kStateVersion, 0};
  writer.append(version, sizeof version);
  writer.word(model.fingerprint());
  writer.word(static_cast<std::uint64_t>(state.steps));
  writer.word(model.parts().size());
  for (const NamedHash& part : model.parts()) {
    writer.word(part.hash);
    writer.text(part.name);
  }
  writer.word(state.bodies.size());
  writer.word(state.instruments.size());
  run::State::visit(state, [&](std::string_view, const auto& numbers) { writer.number(numbers); });
  return writer.finish();
}

bool is_state(std::string_view bytes) { return bytes.starts_with(kMagic); }

StateHeader read_state_header(std::string_view bytes, const std::string& name) {
  return read(bytes, name).header;
}

run::State read_state(std::string_view bytes, const model::Model& model, const std::string& name) {
  SavedState saved = read(bytes, name);
  if (saved.header.fingerprint != model.fingerprint()) {
    throw Error(ErrorKind::state_mismatch, {.file = name},
                "the state is of another robot, which differs in: " +
                    model::describe_difference(saved.header.parts, model.parts()),
                "load it into a simulation of the scene that it was saved from");
  }
  return std::move(saved.state);
}

void parse_state(Simulation& simulation, std::string_view bytes, const std::string& name) {
  const run::State state = read_state(bytes, simulation.model(), name);
  try {
    simulation.restore(state);
  } catch (const Error& error) {
    throw Error(ErrorKind::state_mismatch, {.file = name}, error.what(),
                "save the state again with save_state");
  }
}

void save_state(const Simulation& simulation, const std::filesystem::path& path) {
  write_file(path, format_state(simulation));
}

void load_state(Simulation& simulation, const std::filesystem::path& path) {
  parse_state(simulation, read_file(path), path.string());
}

}  // namespace sinew::sim
