#include "sinew/record/run_recorder.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/build_info.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/folder_lock.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/draft_folder.hpp"
#include "sinew/record/paraview_series.hpp"
#include "sinew/record/run_states.hpp"
#include "sinew/record/run_table.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

namespace {

namespace fs = std::filesystem;

constexpr std::array kFiles = {"run.csv",    "run.h5",      "scene.yaml",
                               "probes.csv", "sensors.csv", "run.png"};

[[noreturn]] void unwritable(const fs::path& path, const std::string& reason) {
  throw Error(ErrorKind::file_unwritable, {.file = path.string()},
              fmt::format("this cannot be written: {}", reason),
              "choose another folder with --out, or change its permissions");
}

// Makes the folder if it is missing.
fs::path with_folder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem == std::errc::no_space_on_device) throw_unwritable(folder, problem.value());
  if (problem) unwritable(folder, problem.message());
  if (!fs::is_directory(folder)) unwritable(folder, "it is a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) unwritable(folder, std::strerror(errno));
  return folder;
}

// Checks that all files of an older run may be replaced, before one of them is.
void require_replaceable(const fs::path& folder) {
  for (const char* name : kFiles) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) continue;
    if (!fs::is_regular_file(file)) unwritable(file, "it is not a regular file");
    if (::access(file.c_str(), W_OK) != 0) unwritable(file, std::strerror(errno));
  }
}

RecordSettings checked(RecordSettings settings) {
  if (settings.every < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "record.every"},
                fmt::format("a frame every {} steps", settings.every), "write 1 or more");
  }
  return settings;
}

}  // namespace

struct RunRecorder::Files {
  Files(sim::Observables list, RecordSettings what)
      : observables(std::move(list)),
        settings(checked(std::move(what))),
        lock(with_folder(settings.folder)),
        draft(settings.folder) {
    try {
      require_replaceable(settings.folder);
      create();
      write();
      states->flush();
      publish();
    } catch (const Error& error) {
      throw draft.named(error);
    }
  }
  void create() {
    const model::Model& model = observables.simulation().model();
    states.emplace(draft / "run.h5", observables, settings);
    table.emplace(draft / "run.csv", observables, TableKind::run);
    write_file(draft / "scene.yaml", settings.scene);
    if (!model.probes().empty()) {
      probes.emplace(draft / "probes.csv", observables, TableKind::probes);
    }
    if (!sense::sensors_of(model).empty()) {
      sensors.emplace(draft / "sensors.csv", observables, TableKind::sensors);
    }
    if (settings.vtk) series.emplace(draft.path(), observables.simulation());
  }
  // Replaces the record of an older run. Whenever this is interrupted, run.h5 is that of the older
  // run or of this one.
  void publish() {
    remove_series(settings.folder);
    // Files of an older run would be mistaken for those of this run.
    for (const char* name : {"probes.csv", "sensors.csv", "run.png"}) {
      std::error_code problem;
      fs::remove(settings.folder / name, problem);
      if (problem) throw_unwritable(settings.folder / name, problem.value());
    }
    states->rename(settings.folder / "run.h5");
    table->rename(settings.folder / "run.csv");
    replace_file(draft / "scene.yaml", settings.folder / "scene.yaml");
    if (probes) probes->rename(settings.folder / "probes.csv");
    if (sensors) sensors->rename(settings.folder / "sensors.csv");
    if (series) series->move_to(settings.folder);
    draft.remove();
  }
  void write() {
    observables.refresh();
    table->write();
    if (probes) probes->write();
    if (sensors) sensors->write();
    states->write();
    if (series) series->write();
    ++frames;
  }

  sim::Observables observables;
  RecordSettings settings;
  FolderLock lock;  // released last
  DraftFolder draft;
  std::optional<RunStates> states;
  std::optional<RunTable> table, probes, sensors;
  std::optional<ParaviewSeries> series;
  std::int64_t frames = 0;
};

RunRecorder::RunRecorder(sim::Observables observables, RecordSettings settings)
    : files_(std::make_unique<Files>(std::move(observables), std::move(settings))) {}

RunRecorder::~RunRecorder() = default;

void RunRecorder::after_step() {
  if (files_->observables.simulation().steps() % files_->settings.every == 0) files_->write();
}

void RunRecorder::finish() { files_->states->flush(); }

std::int64_t RunRecorder::frames() const { return files_->frames; }

const RecordSettings& RunRecorder::settings() const { return files_->settings; }

}  // namespace sinew::record
