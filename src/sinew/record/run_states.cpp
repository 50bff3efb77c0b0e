#include "sinew/record/run_states.hpp"

#include <chrono>
#include <tuple>

#include <fmt/format.h>

#include "sinew/constraint/probe.hpp"
#include "sinew/core/build_info.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

namespace {

constexpr std::chrono::milliseconds kFlushInterval{500};

}  // namespace

RunStates::RunStates(const std::filesystem::path& path, sim::Observables& observables,
                     const RecordSettings& settings)
    : observables_(observables), file_(path) {
  describe(settings);
  write_meshes();
  declare_series(settings.states);
  describe_owners();
}

void RunStates::describe(const RecordSettings& settings) {
  const model::Model& model = observables_.simulation().model();
  file_.attribute("/", "format", std::string_view("sinew-run"));
  file_.attribute("/", "format_version", kRunFormatVersion);
  file_.attribute("/", "sinew_version", version());
  file_.attribute("/", "scene_name", settings.scene_name);
  file_.attribute("/", "units", std::string_view("SI; every series names its own"));
  file_.attribute("/", "time_step", model.step().time_step);
  file_.attribute("/", "record_every", static_cast<std::int64_t>(settings.every));
  file_.attribute("/", "fingerprint", fmt::format("{:016x}", model.fingerprint()));
  file_.text("/scene", settings.scene);
}

void RunStates::write_meshes() {
  const sim::Simulation& simulation = observables_.simulation();
  for (int k = 0; k < static_cast<int>(simulation.model().bodies().size()); ++k) {
    const mechanics::BodyModel& body = simulation.model().body(k);
    mesh::Mesh points;  // of a body without a mesh
    if (!body.has_mesh()) points.nodes = simulation.body(k).positions();
    const mesh::Mesh& mesh = body.has_mesh() ? body.mesh() : points;
    const auto nodes = static_cast<std::uint64_t>(mesh.node_count());
    const std::string folder = "/mesh/" + body.name();
    file_.dataset(folder + "/nodes", {nodes, 3},
                  {mesh.nodes.data(), static_cast<std::size_t>(mesh.nodes.size())});
    file_.attribute(folder + "/nodes", "unit", std::string_view("m"));
    const auto elements = [&](const char* kind, const auto& list) {
      const std::size_t corners = std::tuple_size_v<std::decay_t<decltype(list[0])>>;
      const NodeId* first = list.empty() ? nullptr : list[0].data();
      file_.dataset(folder + kind, {list.size(), corners},
                    std::span<const std::int32_t>(first, corners * list.size()));
    };
    elements("/tetrahedra", mesh.tetrahedra);
    if (!mesh.quadratic.empty()) elements("/quadratic", mesh.quadratic);
    elements("/hexahedra", mesh.hexahedra);
  }
}

void RunStates::declare_series(bool states) {
  const std::vector<run::Observable>& list = observables_.list();
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string path = dataset_of(list[k]);
    if (path.empty() || (is_state(list[k]) && !states)) continue;
    series_.push_back({k, file_.series(path, {list[k].shape.begin(), list[k].shape.end()})});
    file_.attribute(path, "unit", list[k].unit.empty() ? std::string_view("1") : list[k].unit);
    file_.attribute(path, "name", list[k].name);
    if (!list[k].words.empty()) file_.attribute(path, "meaning", meaning_of(list[k]));
  }
}

void RunStates::describe_owners() {
  const model::Model& model = observables_.simulation().model();
  if (model.actuators().empty()) file_.group("/actuators");
  if (model.effectors().empty()) file_.group("/effectors");
  for (const model::ActuatorModel& actuator : model.actuators()) {
    file_.attribute("/actuators/" + actuator.name, "type", std::string_view(actuator.kind->word));
  }
  for (const auto& probe : model.probes()) {
    file_.attribute("/probes/" + probe.name(), "kind", std::string_view(probe.kind()));
  }
  for (const sense::SensorModel& sensor : sense::sensors_of(model)) {
    file_.attribute("/sensors/" + sensor.name, "kind", std::string_view(sensor.kind));
    file_.attribute("/sensors/" + sensor.name, "observable", std::string_view(sensor.observable));
  }
}

void RunStates::write() {
  for (const Series& one : series_) file_.append(one.number, observables_.read(one.observable));
  file_.flush_after(kFlushInterval);
}

}  // namespace sinew::record
