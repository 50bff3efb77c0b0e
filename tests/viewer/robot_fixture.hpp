/// @file
/// A small robot, and a publisher that watches sources.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"

#include "viewer/source.hpp"

namespace sinew::viewer {

using Json = nlohmann::json;

inline constexpr const char* kScene = R"(sinew: 1
time_step: 10 ms
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
    fixed: [{set: x_min}]
actuators:
  up:
    type: cable
    body: beam
    points: [0 10 16 mm, 30 10 16 mm, 58 10 16 mm]
    limits: {tension: {min: 0 N, max: 20 N}}
    command: {displacement: 0 mm}
  push: {type: force, body: beam, point: 60 10 10 mm, direction: 1 0 0}
effectors:
  tip: {body: beam, point: 60 10 10 mm}
probes:
  bend: {body: beam, bend: [{set: x_min}, {set: x_max}]}
  axis: {body: beam, line: [0 10 10 mm, 60 10 10 mm], samples: 4}
controllers:
  hold:
    type: inverse
    actuators: [up]
    effectors:
      tip: {target: {polyline: {points: [60 10 10 mm, 60 10 12 mm], period: 1 s}}}
)";

/// A tube whose pressure has a peak of 10 kPa.
inline constexpr const char* kBalloon = R"(sinew: 1
time_step: 50 ms
bodies:
  tube:
    type: fem
    mesh: {shape: hollow-cylinder, inner_radius: 10 mm, outer_radius: 13 mm, height: 30 mm, element_size: 5 mm}
    element: hex8
    material: {model: neo-hookean, young_modulus: 90 kPa, poisson_ratio: 0.45}
    density: 1000 kg/m^3
    fixed: [{set: bottom}, {set: top}]
actuators:
  air: {type: chamber, body: tube, surface: {set: inner}, cap: true}
)";

inline scene::Robot robot() { return scene::build(scene::parse_scene_text(kScene, "test", {})); }

/// A publisher that keeps the last frame and status.
class Watcher final : public Publisher {
 public:
  void publish(std::shared_ptr<const Frame> next) override {
    const std::lock_guard lock(mutex_);
    frame_ = std::move(next);
    ++frames_;
  }
  void publish_status(std::string next) override {
    const std::lock_guard lock(mutex_);
    status_ = std::move(next);
  }
  bool wants_field(int field) const override { return field == 2; }
  void replace(std::function<std::unique_ptr<Source>()>) override {}

  std::shared_ptr<const Frame> frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
  }
  Json status() const {
    const std::lock_guard lock(mutex_);
    return Json::parse(status_);
  }
  int frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const Frame> frame_;
  std::string status_ = "{}";
  int frames_ = 0;
};

inline std::string kind(const Outcome& outcome) {
  return outcome ? std::string(error_kind_name(outcome->kind())) : "";
}

}  // namespace sinew::viewer
