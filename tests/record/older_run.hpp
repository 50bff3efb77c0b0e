// Writes run.h5 in format 2, in which commands were not recorded.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/hdf5_writer.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record::testing {

/// A writer for quasi-static runs of tetrahedral robots without probes and contacts.
class OlderRun {
 public:
  OlderRun(const std::filesystem::path& path, const sim::Simulation& simulation,
           const std::string& scene)
      : simulation_(simulation), file_(path) {
    const model::Model& model = simulation.model();
    file_.attribute("/", "format", std::string_view("sinew-run"));
    file_.attribute("/", "format_version", std::int64_t{2});
    file_.attribute("/", "sinew_version", std::string_view("0.1.0"));
    file_.attribute("/", "scene_name", std::string_view("older"));
    file_.attribute("/", "time_step", model.step().time_step);
    file_.text("/scene", scene);
    time_ = file_.series("/time", {});
    for (const auto& body : model.bodies()) {
      const mesh::Mesh& mesh = body.mesh();
      const auto nodes = static_cast<std::uint64_t>(mesh.node_count());
      const std::string folder = "/mesh/" + body.name();
      file_.dataset(folder + "/nodes", {nodes, 3},
                    {mesh.nodes.data(), static_cast<std::size_t>(mesh.nodes.size())});
      const std::span<const std::int32_t> corners(mesh.tetrahedra[0].data(),
                                                  4 * mesh.tetrahedra.size());
      file_.dataset(folder + "/tetrahedra", {mesh.tetrahedra.size(), 4}, corners);
      file_.dataset(folder + "/hexahedra", {0, 8}, std::span<const std::int32_t>());
      positions_.push_back(file_.series("/positions/" + body.name(), {nodes, 3}));
    }
    for (const model::ActuatorModel& actuator : model.actuators()) {
      const std::string folder = "/actuators/" + actuator.name;
      actuators_.push_back(
          {file_.series(folder + "/effort", {}), file_.series(folder + "/motion", {})});
    }
    for (const model::EffectorModel& effector : model.effectors()) {
      effectors_.push_back(file_.series("/effectors/" + effector.name + "/position", {3}));
    }
    for (const char* name : {"residual", "relative_residual", "iterations", "scale",
                             "smallest_volume_ratio", "status"}) {
      report_.push_back(file_.series("/report/" + std::string(name), {}));
    }
  }

  /// Appends the current state.
  void write() {
    const auto append = [this](int series, double value) { file_.append(series, {&value, 1}); };
    append(time_, simulation_.time());
    for (std::size_t b = 0; b < positions_.size(); ++b) {
      const Points& points = simulation_.body(static_cast<int>(b)).positions();
      file_.append(positions_[b], {points.data(), static_cast<std::size_t>(points.size())});
    }
    for (std::size_t a = 0; a < actuators_.size(); ++a) {
      append(actuators_[a][0], simulation_.actuator(static_cast<int>(a)).effort);
      append(actuators_[a][1], simulation_.actuator(static_cast<int>(a)).motion);
    }
    for (std::size_t e = 0; e < effectors_.size(); ++e) {
      const Vector3 value = simulation_.effector_value(static_cast<int>(e));
      file_.append(effectors_[e], {value.data(), 3});
    }
    const run::StepReport& report = simulation_.report();
    const std::array<double, 6> numbers = {
        report.residual, report.relative_residual,     static_cast<double>(report.iterations),
        report.scale,    report.smallest_volume_ratio, static_cast<double>(report.status)};
    for (std::size_t k = 0; k < numbers.size(); ++k) append(report_[k], numbers[k]);
  }
  void finish() { file_.flush(); }

 private:
  const sim::Simulation& simulation_;
  Hdf5Writer file_;
  int time_;
  std::vector<int> positions_, effectors_, report_;
  std::vector<std::array<int, 2>> actuators_;
};

}  // namespace sinew::record::testing
