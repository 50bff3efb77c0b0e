// Scenes for the tests of this folder: the documented example and edits of it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "sinew/scene/scene.hpp"

namespace sinew::scene {

/// The example of the documentation, verbatim.
inline const std::string kExample = R"(sinew: 1
gravity: 0 0 0 m/s^2            # this slender trunk would buckle under its weight if it stood upright; hang robots along +z or -z
time_step: 10 ms
integrator: quasi-static        # quasi-static | backward-euler | bdf2 | {type: generalized-alpha, spectral_radius: 0.8}
bodies:
  trunk:
    type: fem
    mesh: {file: trunk.vtk, unit: mm}
    element: tet4               # tet4 | tet10 | hex8
    material: {model: corotational, young_modulus: 450 kPa, poisson_ratio: 0.45}   # or: material: ecoflex-00-30
    mass: 42 g                  # or density: 1070 kg/m^3
    damping: {mass: 0.1 1/s, stiffness: 0.01 s}
    fixed: {box: -20 -20 0 20 20 20 mm}
actuators:
  long_0:
    type: cable                 # cable | chamber | spring | force
    body: trunk
    points: {file: long_0.csv, unit: mm}      # or an inline list of "x y z mm"; the first is the pull point
    pull: world                               # world | body: what the pull point is fixed to
    outside: nearest                          # a via point outside the mesh: error (default) | nearest
    limits: {tension: {min: 0 N, max: 20 N}, displacement: {min: 0 mm, max: 70 mm, rate: 100 mm/s}}
    command: {displacement: 0 mm}             # or tension; a value or a signal: {ramp: ..} {sine: ..} {steps: ..} {file: pull.csv}
effectors:
  tip: {body: trunk, point: 0 0 195 mm}
controllers:
  follow:
    type: inverse
    effectors:
      tip: {target: {circle: {centre: 0 0 190 mm, radius: 30 mm, normal: 0 0 1, period: 10 s}}}
record: {every: 1, states: true}
)";

using Edits = std::vector<std::pair<std::string, std::string>>;

/// The example after edits: each replaces the first occurrence of its first text by its second.
inline std::string edited(const Edits& edits) {
  std::string text = kExample;
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "the example has no '" << from << "'";
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

inline SceneDescription parse(const std::string& text) {
  return parse_scene_text(text, "scene.yaml", {}, Files::ignore);
}

inline SceneDescription parse_edited(const Edits& edits) { return parse(edited(edits)); }

/// A temporary folder, removed at the end.
class SceneFolder {
 public:
  SceneFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "." + test->name();
    for (char& c : name) c = c == '/' ? '_' : c;
    path_ = std::filesystem::temp_directory_path() /
            ("sinew_scene_" + std::to_string(getpid()) + "_" + name);
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~SceneFolder() { std::filesystem::remove_all(path_); }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace sinew::scene
