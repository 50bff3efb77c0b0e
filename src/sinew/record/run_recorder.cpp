#include "sinew/record/run_recorder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/build_info.hpp"
#include "sinew/core/file.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/element_states.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/record/run_states.hpp"
#include "sinew/record/run_table.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::record {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void unwritable(const fs::path& path, const std::string& reason) {
  throw Error(ErrorKind::file_unwritable, {.file = path.string()},
              fmt::format("this cannot be written: {}", reason),
              "choose another folder with --out, or change its permissions");
}

// Checks permissions before anything is replaced, so that a failure does not damage an older run.
void require_writable(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) unwritable(folder, problem.message());
  if (!fs::is_directory(folder)) unwritable(folder, "it is a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) unwritable(folder, std::strerror(errno));
  for (const char* name :
       {"run.csv", "run.h5", "scene.yaml", "probes.csv", "sensors.csv", "run.png"}) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) continue;
    if (!fs::is_regular_file(file)) unwritable(file, "it is not a regular file");
    if (::access(file.c_str(), W_OK) != 0) unwritable(file, std::strerror(errno));
  }
}

// Removes the series of an older run, which would be mistaken for that of this run.
void remove_series(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".pvd" && entry.path().stem().string().starts_with("run")) {
      stale.push_back(entry.path());
    }
  }
  for (const fs::path& list : stale) {
    const std::string stem = list.stem().string();
    std::vector<fs::path> steps;
    for (const auto& entry : fs::directory_iterator(folder / stem, ignored)) {
      if (entry.path().filename().string().starts_with(stem + "_") &&
          entry.path().extension() == ".vtu") {
        steps.push_back(entry.path());
      }
    }
    for (const fs::path& step : steps) fs::remove(step, ignored);
    fs::remove(folder / stem, ignored);  // only when nothing else is in it
    fs::remove(list, ignored);
  }
}

// Writes run.pvd, or run_BODY.pvd for each of several bodies.
class ParaviewSeries {
 public:
  ParaviewSeries(const fs::path& folder, const sim::Simulation& simulation)
      : simulation_(simulation) {
    const auto bodies = simulation.model().bodies();
    for (const auto& body : bodies) {
      means_.push_back(fem::nodal_mean(body));
      lists_.emplace_back(folder /
                          (bodies.size() == 1 ? "run.pvd" : "run_" + body.name() + ".pvd"));
    }
  }

  void write() {
    for (std::size_t b = 0; b < lists_.size(); ++b) {
      const mechanics::Body& body = simulation_.body(static_cast<int>(b));
      const mesh::Mesh& mesh = body.model().mesh();
      mesh::VtuFields fields;
      fields.positions = &body.positions();
      fields.compressed = false;
      // Points are already deformed. With a displacement field, a warp would move them twice.
      fields.points.push_back(
          {"rest_position", 3, {mesh.nodes.data(), mesh.nodes.data() + mesh.nodes.size()}});
      const Points& speed = body.velocities();
      fields.points.push_back({"velocity", 3, {speed.data(), speed.data() + speed.size()}});
      if (means_[b]) add_fields(static_cast<int>(b), fields);
      lists_[b].write(simulation_.time(), mesh, fields);
    }
  }

 private:
  // Adds fields of finite elements: stress, strain and reactions.
  void add_fields(int index, mesh::VtuFields& fields) {
    const auto& body = *mechanics::as<const fem::HasMaterial>(simulation_.body(index));
    const fem::NodalMean& mean = *means_[static_cast<std::size_t>(index)];
    const fem::ElementStates states = fem::element_states(body);
    fields.cells.push_back({"deformation_gradient", 9, rows_of(states.deformation)});
    fields.cells.push_back({"cauchy_stress", 9, rows_of(states.cauchy)});
    const auto infos = fem::element_fields();
    const std::vector<double> values = fem::all_element_fields(body);
    const std::vector<double> at_nodes = mean(values, infos.size());
    for (std::size_t k = 0; k < infos.size(); ++k) {
      fields.points.push_back({infos[k].name, 1, column(at_nodes, k, infos.size())});
      if (infos[k].field == fem::ElementField::von_mises_stress) {
        fields.cells.push_back({infos[k].name, 1, column(values, k, infos.size())});
      }
    }
    const Points held =
        fem::reactions(body, states, simulation_.efforts(), simulation_.world().rows().direction,
                       simulation_.model().rows(), index);
    fields.points.push_back({"reaction", 3, {held.data(), held.data() + held.size()}});
    if (!simulation_.model().contacts().empty()) add_contact_force(body, fields);
  }

  void add_contact_force(const fem::HasMaterial& body, mesh::VtuFields& fields) {
    Points forces = Points::Zero(body.positions().rows(), 3);
    body.add_row_forces(sim::split_efforts(simulation_).contact, forces);
    fields.points.push_back({"contact_force", 3, {forces.data(), forces.data() + forces.size()}});
  }

  static std::vector<double> column(const std::vector<double>& rows, std::size_t k,
                                    std::size_t width) {
    std::vector<double> result;
    result.reserve(rows.size() / width);
    for (std::size_t i = k; i < rows.size(); i += width) result.push_back(rows[i]);
    return result;
  }

  static std::vector<double> rows_of(const std::vector<Matrix3>& tensors) {
    std::vector<double> result;
    result.reserve(9 * tensors.size());
    for (const Matrix3& m : tensors) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) result.push_back(m(r, c));
      }
    }
    return result;
  }

  const sim::Simulation& simulation_;
  std::vector<mesh::PvdWriter> lists_;
  std::vector<std::unique_ptr<fem::NodalMean>> means_;  // one a body; none of an arm
};

RecordSettings checked(RecordSettings settings) {
  if (settings.every < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "record.every"},
                fmt::format("a frame every {} steps", settings.every), "write 1 or more");
  }
  require_writable(settings.folder);
  return settings;
}

}  // namespace

struct RunRecorder::Files {
  Files(sim::Observables list, RecordSettings what)
      : observables(std::move(list)),
        settings(checked(std::move(what))),
        states(settings.folder / "run.h5", observables, settings),
        table(settings.folder / "run.csv", observables, TableKind::run) {
    write_file(settings.folder / "scene.yaml", settings.scene);
    remove_series(settings.folder);
    // Files of an older run would be mistaken for those of this run.
    for (const char* name : {"probes.csv", "sensors.csv", "run.png"}) {
      fs::remove(settings.folder / name);
    }
    const sim::Simulation& simulation = observables.simulation();
    if (!simulation.model().probes().empty()) {
      probes.emplace(settings.folder / "probes.csv", observables, TableKind::probes);
    }
    if (!simulation.model().sensors().empty()) {
      sensors.emplace(settings.folder / "sensors.csv", observables, TableKind::sensors);
    }
    if (settings.vtk) series.emplace(settings.folder, simulation);
  }
  void write() {
    observables.refresh();
    table.write();
    if (probes) probes->write();
    if (sensors) sensors->write();
    states.write();
    if (series) series->write();
    ++frames;
  }

  sim::Observables observables;
  RecordSettings settings;
  RunStates states;  // first: a file that another program holds open stops everything
  RunTable table;
  std::optional<RunTable> probes, sensors;
  std::optional<ParaviewSeries> series;
  std::int64_t frames = 0;
};

RunRecorder::RunRecorder(sim::Observables observables, RecordSettings settings)
    : files_(std::make_unique<Files>(std::move(observables), std::move(settings))) {
  files_->write();
  files_->states.flush();
}

RunRecorder::~RunRecorder() = default;

void RunRecorder::after_step() {
  if (files_->observables.simulation().steps() % files_->settings.every == 0) files_->write();
}

void RunRecorder::finish() { files_->states.flush(); }

std::int64_t RunRecorder::frames() const { return files_->frames; }

const RecordSettings& RunRecorder::settings() const { return files_->settings; }

}  // namespace sinew::record
