#include "sinew/record/motion_recorder.hpp"

#include <algorithm>
#include <utility>

#include "sinew/constraint/cable.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/outer_surface.hpp"
#include "sinew/model/model.hpp"

namespace sinew::record {

namespace {

constexpr double kMotionInterval = 1.0 / 30.0;  // s
constexpr std::size_t kMinMotionFrames = 8;
/// Tolerance of times, larger than the rounding of steps.
constexpr double kMotionTimeTolerance = 1e-9;

std::vector<float> single_precision(const Points& points) {
  std::vector<float> result;
  result.reserve(static_cast<std::size_t>(points.size()));
  for (Eigen::Index k = 0; k < points.size(); ++k) {
    result.push_back(static_cast<float>(points.data()[k]));
  }
  return result;
}

}  // namespace

MotionRecorder::MotionRecorder(Motion parts, std::size_t frame_floats)
    : motion_(std::move(parts)),
      frame_bytes_(frame_floats * sizeof(float)),
      max_frames_(std::clamp(kMotionBytes / std::max<std::size_t>(frame_bytes_, 1),
                             kMinMotionFrames, kMotionFrames)),
      interval_(kMotionInterval) {}

bool MotionRecorder::is_due(double time) const {
  return motion_.times.empty() || time > next_time_ - kMotionTimeTolerance;
}

void MotionRecorder::add(double time, std::vector<std::vector<float>> surfaces,
                         std::vector<std::vector<float>> lines) {
  if (motion_.times.empty()) first_time_ = time;
  motion_.times.push_back(static_cast<float>(time - first_time_));
  for (std::size_t k = 0; k < motion_.surfaces.size(); ++k) {
    motion_.surfaces[k].frames.push_back(std::move(surfaces[k]));
  }
  for (std::size_t k = 0; k < motion_.lines.size(); ++k) {
    motion_.lines[k].frames.push_back(std::move(lines[k]));
  }
  next_time_ = time + interval_;
  if (motion_.times.size() >= max_frames_) thin_out();
}

void MotionRecorder::thin_out() {
  const auto thin = [](auto& list) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < list.size(); k += 2) {
      if (kept != k) list[kept] = std::move(list[k]);
      ++kept;
    }
    list.resize(kept);
  };
  thin(motion_.times);
  for (MovingSurface& surface : motion_.surfaces) thin(surface.frames);
  for (MovingLine& line : motion_.lines) thin(line.frames);
  interval_ *= 2.0;
  next_time_ = first_time_ + static_cast<double>(motion_.times.back()) + interval_;
}

struct RunMotion::Parts {
  Motion motion;
  std::vector<std::vector<NodeId>> nodes;
  std::vector<int> cables;
  std::size_t floats = 0;

  Parts(const model::Model& model, const std::string& name) {
    motion.name = name;
    for (const auto& body : model.bodies()) {
      mesh::OuterSurface surface;
      if (body.has_mesh()) surface = mesh::outer_surface(body.mesh());
      motion.surfaces.push_back({body.name(), std::move(surface.triangles), {}});
      floats += 3 * surface.nodes.size();
      nodes.push_back(std::move(surface.nodes));
    }
    for (std::size_t i = 0; i < model.actuators().size(); ++i) {
      const constraint::Cable* cable = model.cable(static_cast<int>(i));
      if (cable == nullptr) continue;
      cables.push_back(static_cast<int>(i));
      motion.lines.push_back({model.actuators()[i].name, {}});
      floats += 3 * static_cast<std::size_t>(cable->via_count() + 2);
    }
  }
};

RunMotion::RunMotion(const sim::Simulation& simulation, const std::string& name)
    : RunMotion(simulation, Parts(simulation.model(), name)) {}

RunMotion::RunMotion(const sim::Simulation& simulation, Parts parts)
    : simulation_(simulation),
      nodes_(std::move(parts.nodes)),
      cables_(std::move(parts.cables)),
      recorder_(std::move(parts.motion), parts.floats) {
  after_step();
}

void RunMotion::after_step() {
  const double time = simulation_.time();
  if (!recorder_.is_due(time)) return;
  std::vector<std::vector<float>> surfaces, lines;
  for (std::size_t b = 0; b < nodes_.size(); ++b) {
    const Points& positions = simulation_.body(static_cast<int>(b)).positions();
    std::vector<float>& list = surfaces.emplace_back();
    list.reserve(3 * nodes_[b].size());
    for (const NodeId node : nodes_[b]) {
      for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(positions(node, c)));
    }
  }
  for (const int cable : cables_) {
    lines.push_back(
        single_precision(simulation_.model().cable(cable)->points(simulation_.configuration())));
  }
  recorder_.add(time, std::move(surfaces), std::move(lines));
}

}  // namespace sinew::record
