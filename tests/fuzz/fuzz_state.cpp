// For any input, loading a state restores it or throws an Error, and the robot can be stepped
// afterwards; see CMakeLists.txt. The bytes are tried as they are, and again as changes to a valid
// state whose hash is then recomputed, to reach the code after the hash check.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/state_hash.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

namespace {

constexpr std::string_view kScene = R"(sinew: 1
time_step: 10 ms
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 20 mm, height: 20 mm, element_size: 20 mm}
    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
    fixed: [{set: x_min}]
actuators:
  up:
    type: cable
    body: beam
    points: [0 10 16 mm, 30 10 16 mm, 58 10 16 mm]
    command: {displacement: 1 mm}
effectors:
  tip: {body: beam, point: 60 10 10 mm}
)";

sinew::sim::Simulation& simulation() {
  static const auto robot = sinew::scene::build(sinew::scene::parse_scene_text(kScene, "fuzz", {}));
  static sinew::sim::Simulation simulation(robot.model);
  return simulation;
}

void load_and_step(std::string_view bytes) {
  try {
    sinew::sim::parse_state(simulation(), bytes, "fuzz");
    simulation().step();
  } catch (const sinew::Error&) {
    // Expected for invalid input.
  }
}

// Bytes are triples: position (two bytes) and the value added there (one byte).
std::string changed_state(std::span<const std::uint8_t> changes) {
  simulation().reset();
  static const std::string sound = sinew::sim::format_state(simulation());
  std::string bytes = sound;
  for (std::size_t i = 0; i + 2 < changes.size(); i += 3) {
    const std::size_t at = (256U * changes[i] + changes[i + 1]) % (bytes.size() - 8);
    bytes[at] = static_cast<char>(bytes[at] + changes[i + 2]);
  }
  sinew::StateHash hash;
  for (std::size_t at = 0; at + 8 < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    hash.add(word);
  }
  const std::uint64_t value = hash.value();
  std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  load_and_step({reinterpret_cast<const char*>(data), size});
  load_and_step(changed_state({data, size}));
  return 0;
}
