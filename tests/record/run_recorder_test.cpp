#include "sinew/record/run_recorder.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/csv.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/record/run_file.hpp"

#include "sim/contact_robots.hpp"
#include "sim/robots.hpp"

namespace sinew::record {
namespace {

namespace fs = std::filesystem;
using sinew::testing::beam;
using sinew::testing::pull;

/// A folder of its own for every test, removed at its end.
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

// Records a pulled beam; returns positions of its nodes in every frame.
std::vector<Points> record_pull(sim::Simulation& simulation, const RecordSettings& settings,
                                int steps) {
  simulation.command(0, pull(0.004));
  RunRecorder recorder(simulation, nullptr, settings);
  std::vector<Points> seen = {simulation.fem_body(0).positions()};
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    recorder.after_step();
    if (simulation.steps() % settings.every == 0) {
      seen.push_back(simulation.fem_body(0).positions());
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
  const mesh::Mesh& original = simulation.fem_body(0).fem_model().mesh();
  EXPECT_EQ(mesh.nodes, original.nodes);
  EXPECT_EQ(mesh.tetrahedra, original.tetrahedra);
}

TEST_F(RunRecorderTest, TheTableHasUnitsAndWords) {
  sim::Simulation simulation(beam());
  inverse::InverseSettings steering;
  steering.tasks = {{0, inverse::Target::fixed({0.099, 0.0, 0.004}), {1.0}}};
  inverse::InverseController controller(simulation, steering);
  RunRecorder recorder(simulation, &controller, settings());
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
  EXPECT_EQ(names[9], "\"tip.x [m]\"");
  EXPECT_EQ(names[12], "\"tip.target_x [m]\"");
  EXPECT_EQ(names[15], "\"tip.error [m]\"");
  EXPECT_EQ(names.back(), "controller");
  const auto first = cells(rows[1]), last = cells(rows.back());
  ASSERT_EQ(first.size(), names.size());
  ASSERT_EQ(last.size(), names.size());
  EXPECT_EQ(first.back(), "start");
  EXPECT_EQ(last.back(), inverse::inverse_status_name(controller.status()));
  EXPECT_EQ(last[last.size() - 2], "solved");
  EXPECT_EQ(std::stod(last[15]), controller.error());
  EXPECT_EQ(std::stod(last[12]), 0.099);
  EXPECT_EQ(std::stod(last[9]), simulation.effector_value(0).x());
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
  sim::ModelBuilder builder = block_on_plane(options);
  sim::ContactSettings wall;
  wall.name = "wall";
  wall.surface = constraint::Sphere{{0.0, 0.0, 0.1}, 0.01};
  wall.points = Points::Zero(1, 3);
  wall.points(0, 2) = 0.02;
  sim::BaseMotion motion;
  motion.translation[2] = sim::Signal::ramp({0.0, -0.01, 0.0, 1.0});
  motion.angle = sim::Signal::ramp({0.0, 1.0, 0.0, 1.0});
  wall.motion = motion;
  builder.add_contact(wall);
  sim::Simulation simulation(builder.build());
  RecordSettings what = settings();
  what.vtk = true;
  RunRecorder recorder(simulation, nullptr, what);
  std::vector<std::array<sim::ContactMoment, 2>> seen;
  for (int k = 0; k <= 40; ++k) {
    seen.push_back({simulation.contact_moment(0), simulation.contact_moment(1)});
    simulation.step();
    recorder.after_step();
  }
  recorder.finish();
  const RunFile run(folder_ / "run" / "run.h5");
  EXPECT_EQ(run.contacts(), (std::vector<std::string>{"floor", "wall"}));
  int touching = 0;
  for (std::size_t frame = 0; frame < seen.size(); ++frame) {
    for (const int contact : {0, 1}) {
      const sim::ContactMoment read =
          run.contact(contact == 0 ? "floor" : "wall", static_cast<std::int64_t>(frame));
      const sim::ContactMoment& was = seen[frame][static_cast<std::size_t>(contact)];
      EXPECT_EQ(read.pose.affine(), was.pose.affine());
      ASSERT_EQ(read.points.size(), was.points.size());
      for (std::size_t k = 0; k < was.points.size(); ++k) {
        const sim::ContactPoint &a = read.points[k], &b = was.points[k];
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(a.gap, b.gap);
        EXPECT_EQ(a.normal, b.normal);
        EXPECT_EQ(a.normal_force, b.normal_force);
        EXPECT_EQ(a.friction_force, b.friction_force);
        EXPECT_EQ(a.state, b.state);
        touching += a.state == qp::ContactState::open ? 0 : 1;
      }
    }
  }
  EXPECT_GT(touching, 100);
  EXPECT_EQ(kind_of([&] { run.contact("flor", 0); }), ErrorKind::unknown_name);
  EXPECT_EQ(kind_of([&] { run.contact("floor", 42); }), ErrorKind::out_of_range);
  EXPECT_NE(text(folder_ / "run" / "run" / "run_000041.vtu").find("contact_force"),
            std::string::npos);
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
  EXPECT_EQ(kind_of([&] { RunRecorder(simulation, nullptr, sparse); }), ErrorKind::out_of_range);
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
  record_pull(simulation, settings(), 1);  // without a series
  EXPECT_FALSE(fs::exists(run / "run.pvd"));
  EXPECT_FALSE(fs::exists(run / "run"));
}

TEST_F(RunRecorderTest, WhatCannotBeWrittenReplacesNothing) {
  sim::Simulation simulation(beam());
  record_pull(simulation, settings(), 2);
  const fs::path run = folder_ / "run";
  const std::string table = text(run / "run.csv");
  fs::remove(run / "scene.yaml");
  fs::create_directory(run / "scene.yaml");  // in the way
  EXPECT_EQ(kind_of([&] { RunRecorder(simulation, nullptr, settings()); }),
            ErrorKind::file_unwritable);
  EXPECT_EQ(text(run / "run.csv"), table);
  EXPECT_EQ(RunFile(run / "run.h5").frames(), 3);
  std::ofstream(folder_ / "file") << "x";
  RecordSettings wrong = settings();
  wrong.folder = folder_ / "file";
  EXPECT_EQ(kind_of([&] { RunRecorder(simulation, nullptr, wrong); }), ErrorKind::file_unwritable);
}

TEST_F(RunRecorderTest, AKilledRunIsReadable) {
  const pid_t child = fork();
  if (child == 0) {
    sim::Simulation simulation(beam());
    RunRecorder recorder(simulation, nullptr, settings());
    for (int i = 0; i < 40; ++i) {
      simulation.step();
      recorder.after_step();
      if (i == 29) recorder.finish();
    }
    kill(getpid(), SIGKILL);  // nothing is closed
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
