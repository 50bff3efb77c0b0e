#include "sinew/record/run_recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/control/controller_observables.hpp"
#include "sinew/control/inverse_controller.hpp"
#include "sinew/core/csv.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/record/hdf5_writer.hpp"
#include "sinew/record/run_file.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

#include "record/older_run.hpp"
#include "sim/contact_robots.hpp"
#include "sim/robots.hpp"

namespace sinew::record {
namespace {

namespace fs = std::filesystem;
using sinew::testing::beam;
using sinew::testing::pull;

/// A temporary folder of each test, removed at its end.
class RunRecorderTest : public ::testing::Test {
 protected:
  RunRecorderTest() {
    std::string pattern = (fs::temp_directory_path() / "sinew_record_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~RunRecorderTest() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  RecordSettings settings() const {
    RecordSettings settings;
    settings.folder = folder_ / "run";
    settings.scene_name = "beam";
    settings.scene = "sinew: 1\n";
    return settings;
  }
  static std::string text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return content.str();
  }
  static std::vector<std::string> lines(const fs::path& file) {
    std::istringstream stream(text(file));
    std::vector<std::string> found;
    for (std::string line; std::getline(stream, line);) found.push_back(line);
    return found;
  }
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> found;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
    return found;
  }

  fs::path folder_;
};

template <typename Action>
ErrorKind kind_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

// Records a pulled beam, and returns its node positions in every frame.
std::vector<Points> record_pull(sim::Simulation& simulation, const RecordSettings& settings,
                                int steps) {
  simulation.command(0, pull(0.004));
  RunRecorder recorder(sim::Observables(simulation), settings);
  std::vector<Points> seen = {simulation.body(0).positions()};
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    recorder.after_step();
    if (simulation.steps() % settings.every == 0) {
      seen.push_back(simulation.body(0).positions());
    }
  }
  recorder.finish();
  return seen;
}

TEST_F(RunRecorderTest, StatesReadBackBitForBit) {
  sim::Simulation simulation(beam());
  const auto seen = record_pull(simulation, settings(), 6);
  const RunFile run(folder_ / "run" / "run.h5");
  EXPECT_EQ(run.scene(), "sinew: 1\n");
  EXPECT_EQ(run.scene_name(), "beam");
  EXPECT_EQ(run.time_step(), simulation.model().step().time_step);
  ASSERT_EQ(run.frames(), 7);
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(run.positions("beam", i), seen[static_cast<std::size_t>(i)]) << i;
    EXPECT_NEAR(run.times()[static_cast<std::size_t>(i)], 0.01 * i, 1e-12);
  }
  EXPECT_EQ(run.actuator("cable_0", "motion").back(), simulation.actuator(0).motion);
  EXPECT_EQ(run.actuator("cable_0", "effort").back(), simulation.actuator(0).effort);
  EXPECT_GT(run.actuator("cable_0", "effort").back(), 0.0);
  EXPECT_EQ(Vector3(run.effector("tip").row(6)), simulation.effector_value(0));
  const mesh::Mesh mesh = run.rest_mesh("beam");
  const mesh::Mesh& original = simulation.body(0).model().mesh();
  EXPECT_EQ(mesh.nodes, original.nodes);
  EXPECT_EQ(mesh.tetrahedra, original.tetrahedra);
}

TEST_F(RunRecorderTest, TheTableHasUnitsAndWords) {
  sim::Simulation simulation(beam());
  control::TargetSettings steering;
  steering.tasks = {{0, control::Target::fixed({0.099, 0.0, 0.004}), {1.0}}};
  control::InverseController controller(simulation, steering);
  sim::Observables list(simulation);
  control::add_controller(list, &controller);
  RunRecorder recorder(std::move(list), settings());
  for (int i = 0; i < 5; ++i) {
    simulation.step();
    recorder.after_step();
  }
  const auto rows = lines(folder_ / "run" / "run.csv");
  ASSERT_EQ(rows.size(), 7u);
  const auto names = cells(rows[0]);
  EXPECT_EQ(names.front(), "\"time [s]\"");
  EXPECT_EQ(names[1], "\"cable_0.tension [N]\"");
  EXPECT_EQ(names[2], "\"cable_0.displacement [m]\"");
  EXPECT_EQ(names.back(), "controller");
  const auto first = cells(rows[1]), last = cells(rows.back());
  ASSERT_EQ(first.size(), names.size());
  ASSERT_EQ(last.size(), names.size());
  EXPECT_EQ(first.back(), "start");
  EXPECT_EQ(last.back(), control::controller_status_name(controller.status()));
  EXPECT_EQ(last[last.size() - 2], "solved");
  const auto number = [&](const std::string& heading) {
    const auto found = std::ranges::find(names, '"' + heading + '"');
    return found == names.end() ? NAN
                                : std::stod(last[static_cast<std::size_t>(found - names.begin())]);
  };
  EXPECT_EQ(number("tip.error [m]"), controller.error());
  EXPECT_EQ(number("tip.target_x [m]"), 0.099);
  EXPECT_EQ(number("tip.x [m]"), simulation.effector_value(0).x());
  EXPECT_EQ(number("cable_0.tension_command [N]"), simulation.actuator(0).effort);
}

TEST_F(RunRecorderTest, ProbesHaveATableAndSeries) {
  sinew::testing::BeamOptions options;
  options.probes = true;
  sim::Simulation simulation(beam(options));
  record_pull(simulation, settings(), 4);
  const fs::path run = folder_ / "run";
  const auto rows = lines(run / "probes.csv");
  ASSERT_EQ(rows.size(), 6u);
  const auto names = cells(rows[0]), last = cells(rows.back());
  ASSERT_EQ(names.size(), 1 + 3 + (1 + 3 * 6) + 1u);
  EXPECT_EQ(names[1], "\"end.x [m]\"");
  EXPECT_EQ(names[4], "\"axis.length [m]\"");
  EXPECT_EQ(names[22], "\"axis.5.z [m]\"");
  EXPECT_EQ(names[23], "\"bend [rad]\"");
  EXPECT_EQ(std::stod(last[1]), simulation.effector_value(0).x());
  EXPECT_EQ(std::stod(last[4]), simulation.probe_values(1)[0]);
  EXPECT_EQ(std::stod(last[23]), simulation.probe_values(2)[0]);
  EXPECT_GT(std::stod(last[23]), 0.01);
  {
    const RunFile file(run / "run.h5");
    EXPECT_EQ(file.probes(), (std::vector<std::string>{"axis", "bend", "end"}));
    ASSERT_EQ(file.probe("bend").size(), 5u);
    EXPECT_EQ(file.probe("bend").back(), simulation.probe_values(2)[0]);
    EXPECT_EQ(file.probe("axis").back(), simulation.probe_values(1)[0]);
    ASSERT_EQ(file.probe("end").size(), 15u);
    EXPECT_EQ(file.probe("end")[14], simulation.effector_value(0).z());
    EXPECT_EQ(kind_of([&] { file.probe("bent"); }), ErrorKind::unknown_name);
  }
  sim::Simulation bare(beam());
  record_pull(bare, settings(), 1);
  EXPECT_FALSE(fs::exists(run / "probes.csv")) << "an older run's";
  EXPECT_TRUE(RunFile(run / "run.h5").probes().empty());
}

TEST_F(RunRecorderTest, ContactsReadBackBitForBit) {
  sinew::testing::BlockOptions options{.angle = 0.5, .height = 1e-4};
  builder::ModelBuilder builder = block_on_plane(options);
  builder::ContactSettings wall;
  wall.name = "wall";
  wall.surface = constraint::Sphere{{0.0, 0.0, 0.1}, 0.01};
  wall.points = Points::Zero(1, 3);
  wall.points(0, 2) = 0.02;
  model::BaseMotion motion;
  motion.translation[2] = model::Signal::ramp({0.0, -0.01, 0.0, 1.0});
  motion.angle = model::Signal::ramp({0.0, 1.0, 0.0, 1.0});
  wall.motion = motion;
  builder.add_contact(wall);
  sim::Simulation simulation(builder.build());
  RecordSettings with_series = settings();
  with_series.vtk = true;
  RunRecorder recorder(sim::Observables(simulation), with_series);
  std::vector<std::array<contact::ContactSnapshot, 2>> seen;
  for (int k = 0; k <= 40; ++k) {
    seen.push_back({simulation.contacts().snapshot(0), simulation.contacts().snapshot(1)});
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  const RunFile run(folder_ / "run" / "run.h5");
  EXPECT_EQ(run.contacts(), (std::vector<std::string>{"floor", "wall"}));
  int touching = 0;
  for (std::size_t frame = 0; frame < seen.size(); ++frame) {
    for (const std::size_t contact : {0u, 1u}) {
      const std::string name = contact == 0 ? "floor" : "wall";
      const auto numbers = [&](const std::string& dataset) {
        return run.numbers(dataset, static_cast<std::int64_t>(frame));
      };
      const auto read = [&](const char* what) { return numbers("/contacts/" + name + "/" + what); };
      const contact::ContactSnapshot& was = seen[frame][contact];
      const Eigen::Matrix<double, 3, 4> pose = was.pose.affine();
      EXPECT_TRUE(std::ranges::equal(read("pose"), pose.reshaped<Eigen::RowMajor>()));
      ASSERT_EQ(read("gap").size(), was.points.size());
      contact::ContactResultant resultant;
      for (std::size_t k = 0; k < was.points.size(); ++k) {
        const contact::ContactPoint& point = was.points[k];
        const auto vector = [&](const char* what) {
          const std::vector<double> all = read(what);
          return Vector3(all[3 * k], all[3 * k + 1], all[3 * k + 2]);
        };
        EXPECT_EQ(vector("position"), point.position);
        EXPECT_EQ(read("gap")[k], point.gap);
        EXPECT_EQ(vector("normal"), point.normal);
        EXPECT_EQ(read("normal_force")[k], point.normal_force);
        EXPECT_EQ(vector("friction_force"), point.friction_force);
        EXPECT_EQ(read("state")[k], static_cast<double>(point.state));
        touching += point.state == qp::ContactState::open ? 0 : 1;
        resultant.add(point);
      }
      EXPECT_EQ(numbers("/contact_resultants/" + name + "/normal_force").front(),
                resultant.normal_force);
    }
  }
  EXPECT_GT(touching, 100);
  EXPECT_EQ(kind_of([&] { run.numbers("/contacts/flor/gap", 0); }), ErrorKind::malformed_file);
  EXPECT_EQ(kind_of([&] { run.numbers("/contacts/floor/gap", 42); }), ErrorKind::out_of_range);
  EXPECT_NE(text(folder_ / "run" / "run" / "run_000041.vtu").find("contact_force"),
            std::string::npos);
}

TEST_F(RunRecorderTest, TablesAndDatasetsAreThoseOfTheList) {
  sinew::testing::BeamOptions options;
  options.probes = true;
  options.step.integrator = mechanics::Integrator::backward_euler;
  sim::Simulation simulation(beam(options));
  const sim::Observables list(simulation);
  record_pull(simulation, settings(), 3);
  std::vector<std::string> run_headings, probe_headings, datasets;
  for (const run::Observable& one : list.list()) {
    for (const std::string& heading : headings_of(one)) {
      const std::string quoted =
          heading.find(' ') == std::string::npos ? heading : '"' + heading + '"';
      if (is_in_table(one, TableKind::run)) run_headings.push_back(quoted);
      if (is_in_table(one, TableKind::probes)) probe_headings.push_back(quoted);
    }
    if (!dataset_of(one).empty()) datasets.push_back(dataset_of(one));
  }
  EXPECT_EQ(cells(lines(folder_ / "run" / "run.csv")[0]), run_headings);
  EXPECT_EQ(cells(lines(folder_ / "run" / "probes.csv")[0]), probe_headings);
  std::vector<std::string> stored = RunFile(folder_ / "run" / "run.h5").datasets();
  std::ranges::sort(datasets);
  std::ranges::sort(stored);
  EXPECT_EQ(stored, datasets);
  EXPECT_EQ(std::set<std::string>(datasets.begin(), datasets.end()).size(), datasets.size());
}

TEST_F(RunRecorderTest, EveryObservableReadsBackBitForBit) {
  sinew::testing::BeamOptions options;
  options.probes = true;
  options.gravity = {0.0, 0.0, -9.81};
  options.step.integrator = mechanics::Integrator::bdf2;
  sim::Simulation simulation(beam(options));
  simulation.command(0, pull(0.004));
  RunRecorder recorder(sim::Observables(simulation), settings());
  sim::Observables list(simulation);
  std::vector<std::vector<std::vector<double>>> seen;  // values by frame and observable
  const auto look = [&] {
    list.refresh();
    seen.emplace_back();
    for (std::size_t k = 0; k < list.list().size(); ++k) {
      const auto numbers = list.read(k);
      seen.back().emplace_back(numbers.begin(), numbers.end());
    }
  };
  look();
  // More frames than fit into one chunk of a small series.
  for (int i = 0; i < 700; ++i) {
    simulation.step();
    recorder.after_step();
    look();
    if (i == 300) recorder.finish();
  }
  recorder.finish();
  const RunFile run(folder_ / "run" / "run.h5");
  ASSERT_EQ(run.frames(), 701);
  for (std::size_t k = 0; k < list.list().size(); ++k) {
    const std::string dataset = dataset_of(list.list()[k]);
    if (dataset.empty()) continue;
    const std::vector<double> all = run.series(dataset);
    auto at = all.begin();
    for (std::size_t frame = 0; frame < seen.size(); ++frame) {
      for (const double number : seen[frame][k]) {
        ASSERT_NE(at, all.end());
        EXPECT_TRUE(*at == number || (std::isnan(*at) && std::isnan(number)))
            << dataset << " at " << frame;
        ++at;
      }
    }
    EXPECT_EQ(at, all.end()) << dataset;
  }
}

TEST_F(RunRecorderTest, CommandsAreRecordedAsTheyWereGiven) {
  sim::Simulation simulation(beam());
  simulation.command(0,
                     {model::CommandKind::motion, model::Signal::ramp({0.0, 0.004, 0.01, 0.03})});
  simulation.command(1, sinew::testing::tension(0.3));
  RunRecorder recorder(sim::Observables(simulation), settings());
  for (int i = 0; i < 6; ++i) {
    if (i == 3) simulation.command(1, pull(0.001));
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  const RunFile run(folder_ / "run" / "run.h5");
  EXPECT_EQ(run.format_version(), 3);
  EXPECT_EQ(run.lacks(), "");
  const std::vector<double> ramp = run.actuator("cable_0", "motion_command");
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    const double part = std::clamp((0.01 * static_cast<double>(i) - 0.01) / 0.03, 0.0, 1.0);
    EXPECT_DOUBLE_EQ(ramp[i], 0.004 * part) << i;
  }
  const std::vector<double> tension = run.actuator("cable_1", "effort_command"),
                            motion = run.actuator("cable_1", "motion_command");
  for (std::size_t i = 0; i < tension.size(); ++i) {
    EXPECT_EQ(std::isnan(tension[i]), i > 3) << i;
    EXPECT_EQ(std::isnan(motion[i]), i <= 3) << i;
  }
  EXPECT_EQ(tension[2], 0.3);
  EXPECT_EQ(motion[5], 0.001);
}

TEST_F(RunRecorderTest, OlderRecordingsAreReadAndSayWhatTheyLack) {
  sim::Simulation simulation(beam());
  testing::OlderRun older(folder_ / "old.h5", simulation, "sinew: 1\n");
  older.write();
  simulation.command(0, pull(0.004));
  for (int i = 0; i < 3; ++i) {
    simulation.step();
    older.write();
  }
  older.finish();
  const RunFile run(folder_ / "old.h5");
  EXPECT_EQ(run.format_version(), 2);
  EXPECT_EQ(run.lacks(),
            "recorded without commands, energies and resultants of contacts (format 2)");
  ASSERT_EQ(run.frames(), 4);
  EXPECT_EQ(run.actuator("cable_0", "effort").back(), simulation.actuator(0).effort);
  EXPECT_EQ(run.positions("beam", 3), simulation.body(0).positions());
  EXPECT_EQ(Vector3(run.effector("tip").row(3)), simulation.effector_value(0));
  EXPECT_FALSE(run.has("/actuators/cable_0/motion_command"));
  try {
    run.actuator("cable_0", "motion_command");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::missing_key);
    EXPECT_NE(std::string(error.what()).find("recorded without commands"), std::string::npos);
  }
}

TEST_F(RunRecorderTest, FormatsThatAreNotKnownAreRefused) {
  for (const std::int64_t version : {kOldestRunFormatVersion - 1, kRunFormatVersion + 1}) {
    Hdf5Writer file(folder_ / "other.h5");
    file.attribute("/", "format", std::string_view("sinew-run"));
    file.attribute("/", "format_version", version);
    file.flush();
    EXPECT_EQ(kind_of([&] { RunFile(folder_ / "other.h5"); }), ErrorKind::unsupported_version);
  }
}

TEST_F(RunRecorderTest, EveryOtherStepAndNoStates) {
  RecordSettings sparse = settings();
  sparse.every = 2;
  sparse.states = false;
  sim::Simulation simulation(beam());
  record_pull(simulation, sparse, 5);
  const RunFile run(folder_ / "run" / "run.h5");
  ASSERT_EQ(run.frames(), 3);
  EXPECT_DOUBLE_EQ(run.times()[2], 0.04);
  EXPECT_FALSE(run.has_states());
  EXPECT_EQ(kind_of([&] { run.positions("beam", 0); }), ErrorKind::missing_key);
  sparse.every = 0;
  EXPECT_EQ(kind_of([&] { RunRecorder(sim::Observables(simulation), sparse); }),
            ErrorKind::out_of_range);
}

TEST_F(RunRecorderTest, DynamicsRecordVelocities) {
  sinew::testing::BeamOptions options;
  options.step.integrator = mechanics::Integrator::backward_euler;
  options.gravity = {0.0, 0.0, -9.81};
  sim::Simulation simulation(beam(options));
  record_pull(simulation, settings(), 2);
  EXPECT_NE(text(folder_ / "run" / "run.h5").find("velocities"), std::string::npos);
}

TEST_F(RunRecorderTest, ASeriesForParaviewReplacesAnOlderOne) {
  sim::Simulation simulation(beam());
  RecordSettings with_series = settings();
  with_series.vtk = true;
  const auto seen = record_pull(simulation, with_series, 3);
  const fs::path run = folder_ / "run";
  EXPECT_TRUE(fs::exists(run / "run.pvd"));
  const mesh::Mesh last = mesh::read_mesh_unchecked(run / "run" / "run_000003.vtu");
  EXPECT_LT((last.nodes - seen.back()).cwiseAbs().maxCoeff(), 1e-15);
  const std::string written = text(run / "run" / "run_000003.vtu");
  for (const fem::ElementFieldInfo& info : fem::element_fields()) {
    EXPECT_NE(written.find(fmt::format("Name=\"{}\"", info.name)), std::string::npos) << info.name;
  }
  simulation.reset();
  record_pull(simulation, settings(), 1);  // no series
  EXPECT_FALSE(fs::exists(run / "run.pvd"));
  EXPECT_FALSE(fs::exists(run / "run"));
}

TEST_F(RunRecorderTest, WhatCannotBeWrittenReplacesNothing) {
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 2);
  const fs::path run = folder_ / "run";
  const std::string table = text(run / "run.csv");
  fs::remove(run / "scene.yaml");
  fs::create_directory(run / "scene.yaml");  // blocks the file
  EXPECT_EQ(kind_of([&] { RunRecorder(sim::Observables(simulation), settings()); }),
            ErrorKind::file_unwritable);
  EXPECT_EQ(text(run / "run.csv"), table);
  EXPECT_EQ(RunFile(run / "run.h5").frames(), 3);
  std::ofstream(folder_ / "file") << "x";
  RecordSettings wrong = settings();
  wrong.folder = folder_ / "file";
  EXPECT_EQ(kind_of([&] { RunRecorder(sim::Observables(simulation), wrong); }),
            ErrorKind::file_unwritable);
}

TEST_F(RunRecorderTest, AKilledRunIsReadable) {
  const pid_t child = fork();
  if (child == 0) {
    sim::Simulation simulation(beam());
    RunRecorder recorder(sim::Observables(simulation), settings());
    for (int i = 0; i < 40; ++i) {
      simulation.step();
      recorder.after_step();
      if (i == 29) recorder.finish();
    }
    kill(getpid(), SIGKILL);  // no file is closed
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(lines(folder_ / "run" / "run.csv").size(), 42u) << "heading, start, 40 steps";
  const RunFile run(folder_ / "run" / "run.h5");
  ASSERT_GE(run.frames(), 31);
  EXPECT_NEAR(run.times()[30], 0.3, 1e-12);
  EXPECT_EQ(run.positions("beam", 30).rows(), run.rest_mesh("beam").nodes.rows());
}

TEST_F(RunRecorderTest, ASecondRunIntoTheFolderIsRefused) {
  sim::Simulation first(beam()), second(beam());
  const fs::path run = folder_ / "run";
  {
    RunRecorder recorder(sim::Observables(first), settings());
    for (int i = 0; i < 4; ++i) {
      first.step();
      recorder.after_step();
      RecordSettings other = settings();
      other.scene = "sinew: 2\n";
      other.vtk = true;
      EXPECT_EQ(kind_of([&] { RunRecorder(sim::Observables(second), other); }),
                ErrorKind::file_unwritable);
    }
    recorder.finish();
  }
  EXPECT_EQ(RunFile(run / "run.h5").frames(), 5);
  EXPECT_EQ(RunFile(run / "run.h5").scene(), "sinew: 1\n");
  EXPECT_EQ(lines(run / "run.csv").size(), 6u) << "heading, start, 4 steps";
  EXPECT_EQ(text(run / "scene.yaml"), "sinew: 1\n");
  EXPECT_FALSE(fs::exists(run / "run.pvd"));
  RunRecorder(sim::Observables(second), settings());  // the folder is free again
  EXPECT_EQ(RunFile(run / "run.h5").frames(), 1);
}

// The names of all files in a folder.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

TEST_F(RunRecorderTest, NothingIsLeftBesideTheRecord) {
  sim::Simulation simulation(beam());
  const fs::path run = folder_ / "run";
  fs::create_directories(run / ".sinew-new");  // as after a kill before the first frame
  std::ofstream(run / ".sinew-new" / "run.h5") << "torn";
  std::ofstream(run / ".sinew-lock") << "1";
  std::ofstream(run / "notes.txt") << "mine";
  record_pull(simulation, settings(), 2);
  EXPECT_EQ(files_in(run),
            (std::vector<std::string>{"notes.txt", "run.csv", "run.h5", "scene.yaml"}));
}

// Runs `action` in a process whose files cannot grow beyond `bytes`, as on a disk that fills up.
// @return its exit status, of waitpid().
template <typename Action>
int with_small_files(rlim_t bytes, const Action& action) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::exit(action());  // NOLINT(concurrency-mt-unsafe): HDF5 closes its files at the exit
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

TEST_F(RunRecorderTest, AFullDiskEndsTheRunAndKeepsTheRecord) {
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 3);
  const std::string before = text(folder_ / "run" / "run.h5");
  // The limit holds for files in memory, too, to which HDF5 writes some kB when it closes the file.
  std::vector<rlim_t> sizes = {10000};
  for (rlim_t size = before.size() / 8; size < 3 * before.size(); size += before.size() / 8) {
    sizes.push_back(size);
  }
  for (const bool vtk : {false, true}) {
    for (const rlim_t size : sizes) {
      simulation.reset();
      record_pull(simulation, settings(), 3);
      const int status = with_small_files(size, [&] {
        RecordSettings wanted = settings();
        wanted.vtk = vtk;
        return kind_of([&] { record_pull(simulation, wanted, 400); }) == ErrorKind::recording_failed
                   ? 0
                   : 1;
      });
      EXPECT_TRUE(WIFEXITED(status)) << size << " bytes: signal " << WTERMSIG(status);
      EXPECT_EQ(WEXITSTATUS(status), 0) << size << " bytes";
      const RunFile run(folder_ / "run" / "run.h5");
      EXPECT_GE(run.frames(), 1) << size << " bytes";
      EXPECT_EQ(run.positions("beam", run.frames() - 1).rows(), run.rest_mesh("beam").nodes.rows());
      if (size < before.size() / 2) {
        EXPECT_EQ(run.frames(), 4) << "the older record";
      }
    }
  }
}

TEST_F(RunRecorderTest, ARunThatIsKilledAtAnyMomentLeavesARecord) {
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 3);
  for (int delay = 0; delay < 40; ++delay) {
    const pid_t child = fork();
    if (child == 0) {
      for (;;) RunRecorder(sim::Observables(simulation), settings());
    }
    usleep(static_cast<useconds_t>(700 * delay));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const RunFile run(folder_ / "run" / "run.h5");
    EXPECT_TRUE(run.frames() == 4 || run.frames() == 1) << run.frames();
    EXPECT_EQ(run.positions("beam", 0).rows(), run.rest_mesh("beam").nodes.rows());
  }
}

TEST_F(RunRecorderTest, OtherFilesAreRefused) {
  EXPECT_EQ(kind_of([&] { RunFile(folder_ / "none.h5"); }), ErrorKind::file_not_found);
  std::ofstream(folder_ / "text.h5") << "no HDF5";
  EXPECT_EQ(kind_of([&] { RunFile(folder_ / "text.h5"); }), ErrorKind::unknown_format);
  EXPECT_FALSE(RunFile::is_hdf5(folder_ / "text.h5"));
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 2);
  EXPECT_TRUE(RunFile::is_hdf5(folder_ / "run" / "run.h5"));
  const RunFile run(folder_ / "run" / "run.h5");
  EXPECT_EQ(kind_of([&] { run.positions("beem", 0); }), ErrorKind::unknown_name);
  EXPECT_EQ(kind_of([&] { run.positions("beam", 3); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { run.positions("beam", -1); }), ErrorKind::out_of_range);
}

TEST_F(RunRecorderTest, TruncatedFilesAreRefused) {
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 2);
  const std::string whole = text(folder_ / "run" / "run.h5");
  const fs::path cut = folder_ / "cut.h5";
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    std::ofstream(cut, std::ios::binary) << whole.substr(0, random() % whole.size());
    const ErrorKind kind = kind_of([&] { RunFile(cut).positions("beam", 0); });
    EXPECT_TRUE(kind == ErrorKind::unknown_format || kind == ErrorKind::malformed_file ||
                kind == ErrorKind::unsupported_version)
        << error_kind_name(kind);
  }
}

}  // namespace
}  // namespace sinew::record
