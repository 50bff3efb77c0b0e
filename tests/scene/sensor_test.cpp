// Sensors of scenes: values of each type in a run, and invalid scenes.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

namespace sinew::scene {
namespace {

namespace fs = std::filesystem;

// A silicone finger with a cable and a chamber, which is pressed on a floor.
const std::string kFinger = R"(sinew: 1
gravity: 0 0 -9.81 m/s^2
time_step: 10 ms
integrator: bdf2
bodies:
  finger:
    type: fem
    mesh: {shape: chambered-cylinder, radius: 12.5 mm, height: 65 mm, chamber_radius: 3.7 mm,
           chamber_offset: 7.3 mm, chamber_top: 60 mm, element_size: 12 mm}
    material: {young_modulus: 200 kPa, poisson_ratio: 0.35}
    density: 1070 kg/m^3
    damping: {stiffness: 0.01 s}
    fixed: {set: bottom}
actuators:
  cable: {type: cable, body: finger, points: [-9 0 0 mm, -9 0 60 mm],
          command: {displacement: {ramp: {to: 5 mm, duration: 0.2 s}}}}
  air: {type: chamber, body: finger, surface: {set: chamber}, cap: true,
        gas: {supply: {conductance: 1e-10 m^3/(s Pa)}},
        command: {pressure: {ramp: {to: 10 kPa, duration: 0.1 s}}}}
effectors:
  tip: {body: finger, point: 0 0 65 mm}
contacts:
  wall: {body: finger, surface: {plane: {point: -14 0 0 mm, normal: 1 0 0}}, friction: 0.3}
)";

const std::string kSensors = R"(sensors:
  marker: {type: marker, body: finger, point: 0 0 65 mm, noise: 0.1 mm, rate: 50 Hz, delay: 20 ms}
  length: {type: cable-length, actuator: cable, noise: 0.1 mm, quantum: 0.01 mm, seed: 4}
  load: {type: cable-tension, actuator: cable, drift: 0.1 N, dropout: 20 %}
  winch: {type: motor-current, actuator: cable, torque_constant: 0.05 N m/A, radius: 8 mm}
  gauge: {type: pressure, actuator: air, range: 0 8 kPa}
  gain: {type: volume, actuator: air}
  flow: {type: flow, actuator: air, bias: 0.1 ml/s}
  fibre: {type: curvature, body: finger, line: [0 0 0 mm, 0 0 65 mm], places: [20 mm, 45 mm],
          gauge: 30 mm, about: y, noise: 0.1 1/m}
  skin: {type: stretch, body: finger, line: [0 0 0 mm, 0 0 65 mm], samples: 5}
  wire: {type: resistance, body: finger, line: [0 0 0 mm, 0 0 65 mm], samples: 5, resistance: 350 Ohm,
         gauge_factor: 2}
  light: {type: attenuation, body: finger, line: [0 0 0 mm, 0 0 65 mm], loss_per_length: 20 dB/m,
          loss_per_turn: 2 dB}
  cloth: {type: capacitance, body: finger, permittivity: 2.8, noise: 0.001 pF,
          electrodes: [{set: bottom}, {set: top}]}
  turn: {type: orientation, body: finger, at: [0 0 65 mm, 5 0 65 mm, 0 5 65 mm]}
  spin: {type: gyroscope, body: finger, at: [0 0 65 mm, 5 0 65 mm, 0 5 65 mm]}
  shake: {type: accelerometer, body: finger, at: [0 0 65 mm, 5 0 65 mm, 0 5 65 mm]}
  press: {type: contact-force, contact: wall}
  pad: {type: contact-force, contact: wall, patch: {plane: {point: 0 0 65 mm, normal: 0 0 1}}}
  on: {type: touch, contact: wall, threshold: 0.1 mN, rate: 20 Hz}
)";

std::unique_ptr<sim::Simulation> simulation_of(const std::string& text) {
  return std::make_unique<sim::Simulation>(build(parse_scene_text(text, "scene.yaml", {})).model);
}

std::vector<double> truth(const sim::Simulation& simulation, const char* name) {
  return sense::sensors_of(simulation).truth(sense::sensor_index(simulation.model(), name));
}

const sense::Channel& channel(const sim::Simulation& simulation, const char* name) {
  return sense::sensors_of(simulation).channel(sense::sensor_index(simulation.model(), name));
}

TEST(Sensors, OnlyLook) {
  const auto with = simulation_of(kFinger + kSensors), without = simulation_of(kFinger);
  EXPECT_EQ(with->model().fingerprint(), without->model().fingerprint());
  for (int k = 0; k < 25; ++k) {
    with->step();
    without->step();
    run::State state = with->state();
    EXPECT_FALSE(state.instruments.empty());
    state.instruments.clear();
    ASSERT_EQ(state.hash(), without->state().hash()) << k;
  }
}

TEST(Sensors, SayWhatOthersObserve) {
  const auto simulation = simulation_of(kFinger + kSensors);
  sim::Observables list(*simulation);
  const auto number = [&](const char* name) { return list.number(list.find(name)); };
  double filled = 0.0, most = 0.0;
  const double before = simulation->drive_state(1)[0];
  for (int k = 0; k < 40; ++k) {
    simulation->step();
    list.refresh();
    filled += 0.01 * truth(*simulation, "flow")[0];
    most = std::max(most, number("wall.normal_force"));
    EXPECT_EQ(truth(*simulation, "length")[0], number("cable.displacement"));
    EXPECT_EQ(truth(*simulation, "load")[0], number("cable.tension"));
    EXPECT_DOUBLE_EQ(truth(*simulation, "winch")[0], number("cable.tension") * 0.008 / 0.05);
    EXPECT_EQ(truth(*simulation, "gauge")[0], number("air.pressure"));
    EXPECT_EQ(truth(*simulation, "gain")[0], number("air.volume_growth"));
    EXPECT_NEAR(truth(*simulation, "press")[0], number("wall.normal_force"), 1e-12);
    EXPECT_EQ(truth(*simulation, "on")[0], number("wall.normal_force") > 1e-4 ? 1.0 : 0.0);
    const Vector3 tip = simulation->effector_value(0);
    EXPECT_EQ(truth(*simulation, "marker"), std::vector<double>(tip.data(), tip.data() + 3));
    EXPECT_EQ(number("gauge.measured"), std::min(8000.0, number("air.pressure")));
    EXPECT_NEAR(number("flow.measured") - number("flow.true"), 1e-7, 1e-18);
  }
  EXPECT_NEAR(filled, simulation->drive_state(1)[0] - before, 1e-12 * before);
  EXPECT_GT(filled, 0.1 * before);
  EXPECT_GT(most, 1e-3) << "nothing was pressed";
  EXPECT_GT(std::abs(truth(*simulation, "fibre")[0]), 1.0);
  EXPECT_NEAR(truth(*simulation, "wire")[0], 350.0 * (1.0 + 2.0 * truth(*simulation, "skin")[0]),
              1e-9);
  EXPECT_EQ(sense::sensors_of(simulation->model())[1].observable, "cable.displacement");
  EXPECT_EQ(sense::sensors_of(simulation->model())[0].observable, "marker.true");
}

// The patch at the end measures the forces of the points that are there.
TEST(Sensors, APatchFeelsItsPoints) {
  const auto simulation = simulation_of(kFinger + kSensors);
  double most = 0.0;
  const auto& body = simulation->body(0);
  const mesh::Mesh& mesh = body.model().mesh();
  for (int k = 0; k < 40; ++k) {
    simulation->step();
    double expected = 0.0;
    for (const contact::ContactPoint& point : simulation->contacts().points(0)) {
      if (point.normal_force == 0.0) continue;
      Eigen::Index node = 0;
      (body.positions().rowwise() - point.position.transpose()).rowwise().norm().minCoeff(&node);
      if (std::abs(mesh.nodes(node, 2) - 0.065) < 1e-9) expected += point.normal_force;
    }
    most = std::max(most, expected);
    EXPECT_NEAR(truth(*simulation, "pad")[0], expected, 1e-12);
  }
  EXPECT_GT(most, 1e-3);
}

TEST(Sensors, GoOnFromSavedStatesBitForBit) {
  const auto whole = simulation_of(kFinger + kSensors);
  const auto resumed = simulation_of(kFinger + kSensors);
  for (int k = 0; k < 13; ++k) whole->step();
  sim::parse_state(*resumed, sim::format_state(*whole), "state");
  const auto clone = whole->clone();
  sim::Observables lists[] = {sim::Observables(*whole), sim::Observables(*resumed),
                              sim::Observables(*clone)};
  for (int k = 0; k < 12; ++k) {
    for (auto* one : {whole.get(), resumed.get(), clone.get()}) one->step();
    EXPECT_EQ(resumed->state(), whole->state());
    EXPECT_EQ(clone->state(), whole->state());
  }
  for (std::size_t i = 0; i < sense::sensors_of(whole->model()).size(); ++i) {
    const auto index = static_cast<int>(i);
    for (std::size_t c = 0; c < sense::sensors_of(*whole).channel(index).size(); ++c) {
      EXPECT_EQ(sense::sensors_of(*resumed).channel(index).value()[c],
                sense::sensors_of(*whole).channel(index).value()[c]);
      EXPECT_EQ(sense::sensors_of(*clone).channel(index).value()[c],
                sense::sensors_of(*whole).channel(index).value()[c]);
    }
  }
  const std::uint64_t hash = whole->state().hash();
  whole->reset();
  for (int k = 0; k < 25; ++k) whole->step();
  EXPECT_EQ(whole->state().hash(), hash);
}

TEST(Sensors, StatesOfRobotsWithAndWithoutThemAreExchanged) {
  const auto with = simulation_of(kFinger + kSensors), without = simulation_of(kFinger);
  for (int k = 0; k < 3; ++k) {
    with->step();
    without->step();
  }
  const std::string plain = sim::format_state(*without), sensing = sim::format_state(*with);
  // Each robot accepts the other's state; its sensors then restart.
  sim::parse_state(*without, sensing, "sensing");
  sim::parse_state(*with, plain, "plain");
  EXPECT_EQ(channel(*with, "length").samples(), 1);
  EXPECT_EQ(channel(*with, "length").time(), with->time());
}

TEST(Sensors, AreAtRestAfterAStaticSolution) {
  const auto simulation = simulation_of(kFinger + kSensors);
  simulation->solve_static();
  EXPECT_TRUE(channel(*simulation, "marker").valid(0.0));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(channel(*simulation, "marker").value()[c], simulation->effector_value(0)[c], 6e-4);
    EXPECT_EQ(truth(*simulation, "spin")[c], 0.0);
  }
  const double first = channel(*simulation, "marker").value()[0];
  simulation->solve_static();
  EXPECT_NE(channel(*simulation, "marker").value()[0], first) << "each has its own noise";
}

const std::string kSpinner = R"(sinew: 1
gravity: 0 0 -9.81 m/s^2
time_step: 1 ms
integrator: bdf2
bodies:
  top: {type: rigid, shape: {box: 60 60 20 mm}, mass: 100 g, pose: {position: 0 0 1 m},
        velocity: {angular: 0 0 20 rad/s}}
sensors:
  spin: {type: gyroscope, body: top, at: 0 0 1000 mm}
  free: {type: accelerometer, body: top, at: 0 0 1000 mm}
  rim: {type: accelerometer, body: top, at: 25 0 1000 mm}
  turn: {type: orientation, body: top, at: 0 0 1000 mm}
)";

// A falling body that spins about its axis has no specific force at its centre, and r omega^2
// inwards at a distance r.
TEST(Sensors, InertialUnitsFeelASpinThatFalls) {
  const auto simulation = simulation_of(kSpinner);
  for (int k = 0; k < 100; ++k) simulation->step();
  const auto* pose = mechanics::as<const mechanics::HasPose>(simulation->body(0));
  const auto spin = truth(*simulation, "spin"), free = truth(*simulation, "free"),
             rim = truth(*simulation, "rim"), turn = truth(*simulation, "turn");
  const Vector3 rotation = rotation_vector(pose->axes());
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(turn[c], rotation[static_cast<Eigen::Index>(c)], 1e-9);
    EXPECT_NEAR(free[c], 0.0, 1e-6);
  }
  EXPECT_NEAR(spin[2], 20.0, 1e-6);
  // The mean over a step lags by half a step, an angle of omega h/2, which appears in the
  // tangential part.
  const double centripetal = 0.025 * 20.0 * 20.0;
  EXPECT_NEAR(rim[0], -centripetal, 1e-3 * centripetal);
  EXPECT_NEAR(rim[1], 0.0, 0.02 * centripetal);
}

TEST(Sensors, InertialUnitsAtRestFeelTheirWeight) {
  const auto simulation = simulation_of(kFinger + kSensors);
  simulation->solve_static();
  const auto up = truth(*simulation, "shake"), turn = truth(*simulation, "turn");
  const Vector3 expected =
      rotation_matrix(Vector3(turn[0], turn[1], turn[2])).transpose() * Vector3(0.0, 0.0, 9.81);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(up[c], expected[static_cast<Eigen::Index>(c)], 1e-9);
  }
}

struct Broken {
  const char* sensor;
  ErrorKind kind;
  const char* message;
  const char* remedy;
};

TEST(Sensors, WhatIsWrongNamesPlaceValueAndRemedy) {
  for (const Broken& broken :
       {Broken{"{type: cable-length, actuator: cabel}", ErrorKind::unknown_name, "cabel",
               "did you mean 'cable'"},
        Broken{"{type: cable-length, actuator: air}", ErrorKind::wrong_actuator_type,
               "'air' is of type chamber", "cable or spring"},
        Broken{"{type: pressure, actuator: cable}", ErrorKind::wrong_actuator_type,
               "'cable' is of type cable", "chamber"},
        Broken{"{type: marker, body: finger, point: 0 0 65 mm, rate: 30 Hz}",
               ErrorKind::out_of_range, "every 3.33333 steps of 0.01 s", "choose 25 Hz"},
        Broken{"{type: marker, body: finger, point: 0 0 65 mm, rate: 400 Hz}",
               ErrorKind::out_of_range, "400 Hz", "choose 100 Hz"},
        Broken{"{type: marker, body: finger, point: 0 0 65 mm, range: 1 0 m}",
               ErrorKind::contradictory_limits, "the range ends at 0", "least value first"},
        Broken{"{type: marker, body: finger, point: 0 0 65 mm, noise: 1 N}",
               ErrorKind::wrong_dimension, "expected a length", ""},
        Broken{"{type: marker, body: finger, point: 90 0 65 mm}", ErrorKind::point_outside_mesh,
               "point 0 of sensor 's'", ""},
        Broken{"{type: marker, body: finger}", ErrorKind::missing_key, "point, points, set", ""},
        Broken{"{type: thermometer, body: finger}", ErrorKind::unknown_choice, "thermometer", ""},
        Broken{"{type: motor-current, actuator: cable, torque_constant: 0.05 N m/A}",
               ErrorKind::missing_key, "drum", "radius: 8 mm"},
        Broken{"{type: motor-current, actuator: cable, force_constant: 1 N/A, radius: 8 mm}",
               ErrorKind::conflicting_keys, "exerts a torque", "torque_constant"},
        Broken{"{type: orientation, body: finger, at: 0 0 65 mm}", ErrorKind::wrong_length,
               "1 point(s)", "three points"},
        Broken{"{type: touch, contact: floor}", ErrorKind::unknown_name, "floor", "wall"},
        Broken{"{type: curvature, body: finger, line: [0 0 0 mm, 0 0 65 mm], places: [64 mm]}",
               ErrorKind::out_of_range, "0.064 m", "shorter `gauge`"},
        Broken{"{type: capacitance, body: finger, electrodes: [{set: top}, {set: top}]}",
               ErrorKind::zero_volume, "touch", "a layer between"},
        Broken{"{type: marker, body: finger, point: 0 0 65 mm, missing: lost}",
               ErrorKind::conflicting_keys, "'missing' without 'file'", "add file"}}) {
    const std::string text = kFinger + "sensors:\n  s: " + broken.sensor + "\n";
    try {
      simulation_of(text);
      ADD_FAILURE() << "accepted: " << broken.sensor;
    } catch (const Error& error) {
      EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(broken.kind)) << error.what();
      EXPECT_THAT(std::string(error.what()), testing::HasSubstr(broken.message));
      EXPECT_THAT(error.remedy(), testing::HasSubstr(broken.remedy)) << error.what();
      EXPECT_EQ(error.place().line, 25) << error.what();
    }
  }
}

class RecordedSensor : public ::testing::Test {
 protected:
  RecordedSensor() { fs::create_directories(folder_); }
  ~RecordedSensor() override { fs::remove_all(folder_); }
  std::unique_ptr<sim::Simulation> with(const std::string& table, const std::string& keys = "") {
    std::ofstream(folder_ / "m.csv") << table;
    const std::string text = kFinger +
                             "sensors:\n  s: {type: cable-tension, actuator: cable, file: m.csv" +
                             keys + "}\n";
    return std::make_unique<sim::Simulation>(
        build(parse_scene_text(text, "scene.yaml", folder_)).model);
  }
  void expect_error(const std::string& table, const std::string& keys, ErrorKind kind, int line,
                    const char* message, const char* remedy) {
    try {
      with(table, keys);
      ADD_FAILURE() << "accepted: " << table;
    } catch (const Error& error) {
      EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(kind)) << error.what();
      EXPECT_EQ(error.place().line, line) << error.what();
      EXPECT_THAT(error.message(), testing::HasSubstr(message)) << error.what();
      EXPECT_THAT(error.remedy(), testing::HasSubstr(remedy)) << error.what();
    }
  }
  const fs::path folder_ =
      fs::temp_directory_path() /
      fmt::format("sinew_sensor_{}",
                  ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RecordedSensor, IsReplayedAtItsTimes) {
  const auto simulation = with("0,1\n0.013,2\n0.024,3\n0.026,4\n", ", delay: 10 ms, noise: 0.1 N");
  const sense::Channel& s = sense::sensors_of(*simulation).channel(0);
  EXPECT_EQ(s.settings().standard_deviation(), 0.1);
  EXPECT_FALSE(s.has_value());
  const double expected[] = {1, 1, 2, 4};  // at 10, 20, 30 and 40 ms
  for (const double value : expected) {
    simulation->step();
    EXPECT_EQ(s.value()[0], value) << simulation->time();
  }
  EXPECT_EQ(s.time(), 0.026);
  EXPECT_GE(truth(*simulation, "s")[0], 0.0);  // true value of the model
}

TEST_F(RecordedSensor, SaysNothingBeforeItsFirstSample) {
  const auto simulation = with("0.025,1\n");
  const sense::Channel& s = sense::sensors_of(*simulation).channel(0);
  for (int k = 0; k < 2; ++k) {
    simulation->step();
    EXPECT_FALSE(s.has_value() || s.fresh());
    EXPECT_EQ(s.samples(), 0);
  }
  simulation->step();
  EXPECT_EQ(s.value()[0], 1.0);
}

TEST_F(RecordedSensor, ReadsColumnsByTheirHeadings) {
  const std::string table =
      "time [s],other,s.measured [mN],s.sample_time [s]\n"
      "0,9,nan,nan\n0.01,9,500,0\n0.02,9,500,0\n0.03,9,700,0.02\n";
  const auto simulation = with(table, ", missing: lost");
  const sense::Channel& s = sense::sensors_of(*simulation).channel(0);
  const double values[] = {0.5, 0.5, 0.7};
  const double times[] = {0.0, 0.0, 0.02};
  for (std::size_t k = 0; k < 3; ++k) {
    simulation->step();
    EXPECT_DOUBLE_EQ(s.value()[0], values[k]);
    EXPECT_EQ(s.time(), times[k]);
    EXPECT_EQ(s.fresh(), k != 1);
  }
  const auto named = with("t,a,b\n0,1,2\n", ", columns: [b]");
  EXPECT_EQ(sense::sensors_of(*named).channel(0).value()[0], 2.0);
}

TEST_F(RecordedSensor, GapsAndMissingValuesAreErrorsOrLostSamples) {
  const std::string gaps = "0,1\n0.01,nan\n0.02,\n0.05,4\n";
  expect_error(gaps, "", ErrorKind::not_finite, 2, "'nan'", "");
  expect_error("0,1\n0.01,\n", "", ErrorKind::malformed_table, 2, "empty", "");
  expect_error("0,1\n0.01,2\n0.04,3\n", ", rate: 100 Hz", ErrorKind::bad_signal, 3,
               "no sample between 0.01 s and 0.04 s", "missing: lost");
  expect_error("0,1\n0.01,2\n0.01,3\n", "", ErrorKind::non_monotonic_time, 3, "0.01", "increase");
  expect_error("0,1,2\n", "", ErrorKind::wrong_columns, 25, "3 columns", "columns");
  expect_error("t,a\n0,1\n", ", columns: [b]", ErrorKind::wrong_columns, 25, "'b'", "t, a");
  expect_error("0,1\n", ", dropout: 10 %", ErrorKind::conflicting_keys, 25, "dropout", "remove");
  const auto simulation = with(gaps, ", missing: lost, rate: 100 Hz, timeout: 15 ms");
  const sense::Channel& s = sense::sensors_of(*simulation).channel(0);
  for (int k = 0; k < 3; ++k) simulation->step();
  EXPECT_EQ(s.missing(), 2);
  EXPECT_EQ(s.value()[0], 1.0);
  EXPECT_FALSE(s.valid(simulation->time()));
  for (int k = 0; k < 2; ++k) simulation->step();
  EXPECT_EQ(s.value()[0], 4.0);
  EXPECT_TRUE(s.valid(simulation->time()));
}

TEST_F(RecordedSensor, GoesOnFromASavedState) {
  const std::string table = "0,1\n0.01,2\n0.02,3\n0.03,4\n0.04,5\n";
  const auto simulation = with(table);
  simulation->step();
  simulation->step();
  const auto clone = simulation->clone();
  for (auto* one : {simulation.get(), clone.get()}) {
    one->step();
    EXPECT_EQ(sense::sensors_of(*one).channel(0).value()[0], 4.0);
    EXPECT_EQ(sense::sensors_of(*one).channel(0).samples(), 4);
  }
}

}  // namespace
}  // namespace sinew::scene
