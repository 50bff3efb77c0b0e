#include "sinew/record/run_recorder.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"

namespace sinew::record {

namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::span<const double> flat(const Points& points) {
  return {points.data(), static_cast<std::size_t>(points.size())};
}

}  // namespace

RunRecorder::RunRecorder(const sim::Simulation& simulation,
                         const inverse::InverseController* controller, RecordSettings settings)
    : simulation_(simulation), controller_(controller), settings_(std::move(settings)) {
  std::error_code failure;
  std::filesystem::create_directories(settings_.folder, failure);
  if (failure) {
    throw Error(ErrorKind::file_unwritable, {.file = settings_.folder.string()},
                fmt::format("cannot make the folder: {}", failure.message()),
                "choose another one with --out");
  }
  mesh::write_file(settings_.folder / "scene.yaml", settings_.scene);
  const auto names = columns();
  csv_ = std::make_unique<CsvWriter>(settings_.folder / "run.csv", names);
  row_.reserve(names.size());
  h5_ = std::make_unique<Hdf5Writer>(settings_.folder / "run.h5");
  declare_arrays();
  if (!settings_.vtk) return;
  for (const auto& body : simulation_.model().bodies()) {
    vtk_.push_back(std::make_unique<mesh::PvdWriter>(settings_.folder / (body->name() + ".pvd")));
  }
}

RunRecorder::~RunRecorder() = default;

std::vector<std::string> RunRecorder::columns() const {
  std::vector<std::string> names = {"time [s]"};
  const auto& model = simulation_.model();
  for (const auto& actuator : model.actuators()) {
    names.push_back(fmt::format("{}.{} [N]", actuator.name, actuator.effort_name()));
    names.push_back(fmt::format("{}.{} [m]", actuator.name, sim::ActuatorModel::motion_name()));
  }
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    const char* unit = model.effector(static_cast<int>(i)).unit();
    for (const char axis : {'x', 'y', 'z'}) {
      names.push_back(fmt::format("{}.{} [{}]", model.effectors()[i].name, axis, unit));
    }
  }
  for (const char* name : {"residual [N]", "relative_residual", "violation [m]", "iterations",
                           "scale", "volume_ratio"}) {
    names.emplace_back(name);
  }
  if (controller_ != nullptr) {
    for (const char* name : {"error [m]", "predicted_error [m]", "status"}) {
      names.emplace_back(name);
    }
  }
  return names;
}

void RunRecorder::declare_arrays() {
  h5_->text_attribute("sinew_version", std::string(version()));
  h5_->number_attribute("format_version", 1.0);
  h5_->number_attribute("time_step", simulation_.model().step().time_step);
  h5_->text_attribute("scene", settings_.scene);
  const auto& model = simulation_.model();
  column_arrays_.push_back(h5_->growing("/time", {}, "s"));
  for (const auto& actuator : model.actuators()) {
    column_arrays_.push_back(h5_->growing("/actuators/" + actuator.name + "/effort", {}, "N"));
    column_arrays_.push_back(h5_->growing("/actuators/" + actuator.name + "/motion", {}, "m"));
  }
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    column_arrays_.push_back(h5_->growing("/effectors/" + model.effectors()[i].name + "/position",
                                          {3}, model.effector(static_cast<int>(i)).unit()));
  }
  for (std::size_t i = 0; i < model.bodies().size(); ++i) {
    const auto& body = simulation_.fem_body(static_cast<int>(i));
    const mesh::Mesh& mesh = body.fem_model().mesh();
    const std::string root = "/mesh/" + model.bodies()[i]->name();
    const auto nodes = static_cast<std::size_t>(mesh.node_count());
    h5_->array(root + "/nodes", {nodes, 3}, flat(mesh.nodes));
    h5_->array(
        root + "/tetrahedra", {mesh.tetrahedra.size(), 4},
        std::span<const std::int32_t>(mesh.tetrahedra.front().data(), 4 * mesh.tetrahedra.size()));
    if (settings_.states) {
      position_arrays_.push_back(
          h5_->growing("/positions/" + model.bodies()[i]->name(), {nodes, 3}, "m"));
    }
  }
}

void RunRecorder::record() {
  if (simulation_.steps() % settings_.every != 0) return;
  const auto& model = simulation_.model();
  row_.assign(1, simulation_.time());
  std::size_t array = 0;
  h5_->append(column_arrays_[array++], row_);
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const auto& state = simulation_.actuator(static_cast<int>(i));
    row_.push_back(state.effort);
    row_.push_back(state.motion);
    h5_->append(column_arrays_[array++], {&state.effort, 1});
    h5_->append(column_arrays_[array++], {&state.motion, 1});
  }
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    const Vector3 value = simulation_.effector_value(static_cast<int>(i));
    row_.insert(row_.end(), value.data(), value.data() + 3);
    h5_->append(column_arrays_[array++], {value.data(), 3});
  }
  const auto& report = simulation_.report();
  for (const double value :
       {report.residual, report.relative_residual, report.violation,
        static_cast<double>(report.iterations), report.scale, report.smallest_volume_ratio}) {
    row_.push_back(value);
  }
  if (controller_ != nullptr) {
    row_.push_back(controller_->error());
    row_.push_back(controller_->predicted_error());
    row_.push_back(static_cast<double>(controller_->status()));
  }
  csv_->write_row(row_);
  write_states();
  ++frames_;
  if (wall_seconds() - last_flush_ > 1.0) {
    h5_->flush();
    last_flush_ = wall_seconds();
  }
}

void RunRecorder::write_states() {
  for (std::size_t i = 0; i < position_arrays_.size(); ++i) {
    h5_->append(position_arrays_[i], flat(simulation_.fem_body(static_cast<int>(i)).positions()));
  }
  for (std::size_t i = 0; i < vtk_.size(); ++i) {
    const auto& body = simulation_.fem_body(static_cast<int>(i));
    const mesh::Mesh& mesh = body.fem_model().mesh();
    const Points moved = body.positions() - mesh.nodes;
    mesh::VtuFields fields;
    fields.positions = &body.positions();
    fields.sets = false;
    fields.points.push_back({"displacement", 3, {moved.data(), moved.data() + moved.size()}});
    vtk_[i]->write(simulation_.time(), mesh, fields);
  }
}

void RunRecorder::finish() { h5_->flush(); }

}  // namespace sinew::record
