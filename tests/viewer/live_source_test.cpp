// Display of running robots: steps, clocks, commands, and runs that stop early.
#include "viewer/live_source.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "sinew/control/target_controller.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/law/controller.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/simulation.hpp"

#include "robot_fixture.hpp"
#include "viewer/fields.hpp"
#include "viewer/robot_state.hpp"

namespace sinew::viewer {
namespace {

using namespace std::chrono_literals;

/// A source and the frames it shows.
struct Live {
  explicit Live(const LiveSettings& settings, scene::Robot shown = robot())
      : source(std::move(shown), settings) {
    source.start(watcher);
  }
  ~Live() { source.stop(); }

  Outcome ask(const Request& request) {
    std::promise<Outcome> done;
    source.submit(request, [&](const Outcome& outcome) { done.set_value(outcome); });
    auto answer = done.get_future();
    if (answer.wait_for(60s) != std::future_status::ready) {
      throw std::runtime_error("no answer");
    }
    return answer.get();
  }
  /// Waits for the frame of a step.
  std::shared_ptr<const Frame> at(std::uint64_t step) {
    return wait([step](const Frame& frame) { return frame.step == step; });
  }
  template <typename Holds>
  std::shared_ptr<const Frame> wait(Holds&& holds) {
    for (int k = 0; k < 18000; ++k) {
      if (auto frame = watcher.frame(); frame && holds(*frame)) return frame;
      std::this_thread::sleep_for(10ms);
    }
    throw std::runtime_error("no such frame");
  }

  Watcher watcher;
  LiveSource source;
};

TEST(LiveSource, StepsExactlyAndAsASimulationDoes) {
  Live live({.controller = "", .playing = false});
  EXPECT_EQ(kind(live.ask(SetCommand{"up", "tension", 1.5})), "");
  EXPECT_EQ(kind(live.ask(Step{25})), "");
  const auto frame = live.at(25);
  const scene::Robot same = robot();
  sim::Simulation simulation(same.model);
  simulation.follow();
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(1.5)});
  for (int k = 0; k < 25; ++k) simulation.step();
  EXPECT_EQ(frame->hash, simulation.state().hash());
  EXPECT_EQ(frame->signals[0], simulation.actuator(0).effort);
  EXPECT_FALSE(frame->bodies[0].fields[2].empty()) << "a field that was asked for";
  EXPECT_TRUE(frame->bodies[0].fields[0].empty()) << "a field that nobody asked for";
}

TEST(LiveSource, ShowsAnewWhenAFieldIsChosen) {
  Live live({.controller = "", .playing = false});
  const auto before = live.at(0);
  EXPECT_EQ(kind(live.ask(ChooseField{"von_mises_stress"})), "");
  live.wait([&](const Frame& frame) { return &frame != before.get(); });
}

TEST(LiveSource, ShowsFieldsAndProbesAsTheyAreMeasured) {
  const scene::Robot same = robot();
  RobotState state(same);
  const Description& description = state.description();
  for (int k = 0; k < 3; ++k) {
    state.command({"up", "tension", 1.0 + k});
    state.step();
  }
  const auto frame = state.frame({.fields = std::vector<bool>(list_fields().size(), true)}, 1.0);
  const mechanics::Body& body = state.simulation().body(0);
  const auto& own = *mechanics::as<const fem::HasMaterial>(body);
  const fem::NodalMean mean(own.material().elements());
  ASSERT_EQ(frame->bodies[0].fields.size(), description.fields.size());
  for (std::size_t f = 0; f < description.fields.size(); ++f) {
    const std::string& name = description.fields[f];
    std::vector<double> expected;
    if (name == "displacement") {
      expected = fem::displacement_field(body);
    } else if (name == "actuator_force") {
      expected = fem::row_force_field(own, state.simulation().efforts());
    } else {
      expected = mean(fem::element_field(own, fem::element_field_of(name)));
    }
    const auto& nodes = description.surfaces[0].nodes;
    ASSERT_EQ(frame->bodies[0].fields[f].size(), nodes.size());
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      ASSERT_EQ(frame->bodies[0].fields[f][v],
                static_cast<float>(expected[static_cast<std::size_t>(nodes[v])]))
          << name;
    }
  }
  const auto signal = [&](const char* key) {
    const auto found = std::ranges::find(description.signals, key, &SignalInfo::key);
    return frame->signals.at(static_cast<std::size_t>(found - description.signals.begin()));
  };
  EXPECT_EQ(frame->signals.size(), description.signals.size());
  EXPECT_EQ(signal("probe.bend"), state.simulation().probe_values(0)[0]);
  EXPECT_GT(signal("probe.bend"), 1e-3);
  EXPECT_EQ(signal("probe.axis"), state.simulation().probe_values(1)[0]);
  ASSERT_EQ(frame->probes.size(), 3 * (2 + 4u));
  EXPECT_EQ(frame->probes[3 * 5 + 2], static_cast<float>(state.simulation().effector_value(0).z()));
}

TEST(LiveSource, TellsTheValuesOfANode) {
  const scene::Robot same = robot();
  RobotState state(same);
  state.command({"up", "tension", 2.0});
  for (int k = 0; k < 5; ++k) state.step();
  const DisplaySurface& surface = state.description().surfaces[0];
  FrameWishes wishes{.fields = std::vector<bool>(list_fields().size(), true)};
  for (std::size_t v = 0; v < surface.nodes.size(); v += 7) {
    wishes.picks.push_back({0, PickKind::node, surface.nodes[v]});
  }
  const auto frame = state.frame(wishes, 1.0);
  ASSERT_EQ(frame->picks.size(), wishes.picks.size());
  for (std::size_t k = 0; k < frame->picks.size(); ++k) {
    const PickFrame& pick = frame->picks[k];
    ASSERT_EQ(pick.fields.size(), wishes.fields.size());
    for (std::size_t f = 0; f < wishes.fields.size(); ++f) {
      const float painted = frame->bodies[0].fields[f][7 * k];
      EXPECT_NEAR(pick.fields[f], painted, 1e-5F * std::abs(painted) + 1e-12F)
          << state.description().fields[f];
    }
    const auto& body = frame->bodies[0];
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(pick.positions.at(c), body.positions[21 * k + c]);
      EXPECT_EQ(pick.rest.at(c), surface.rest[21 * k + c]);
    }
  }
  EXPECT_GT(frame->picks[0].fields[1], 1.0F) << "stressed where it is held";
}

TEST(LiveSource, TellsTheValuesOfAnElement) {
  const scene::Robot same = robot();
  RobotState state(same);
  state.command({"up", "tension", 2.0});
  for (int k = 0; k < 5; ++k) state.step();
  const mechanics::Body& body = state.simulation().body(0);
  const auto& own = *mechanics::as<const fem::HasMaterial>(body);
  const mesh::Mesh& mesh = body.model().mesh();
  FrameWishes wishes;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); e += 5) {
    wishes.picks.push_back({0, PickKind::element, e});
  }
  const auto frame = state.frame(wishes, 1.0);
  for (const PickFrame& pick : frame->picks) {
    const auto e = static_cast<std::size_t>(pick.at.number);
    const double volume = mesh::signed_volume(mesh::corners_of(mesh, pick.at.number));
    EXPECT_NEAR(static_cast<double>(pick.volume), volume, 1e-6 * volume);
    ASSERT_EQ(pick.positions.size(), 12U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(pick.positions[3 * k + 2],
                static_cast<float>(body.positions()(mesh.tetrahedra[e][k], 2)));
    }
    EXPECT_TRUE(std::isnan(pick.fields.front())) << "the displacement is of nodes";
    for (std::size_t f = 0; f < fem::element_fields().size(); ++f) {
      const double value = fem::element_field(own, fem::element_fields()[f].field)[e];
      EXPECT_NEAR(static_cast<double>(pick.fields[f + 1]), value, 1e-5 * std::abs(value) + 1e-12)
          << fem::element_fields()[f].name;
    }
  }
}

TEST(LiveSource, ShowsWhatIsInsideWhereItIsAskedFor) {
  const scene::Robot same = robot();
  RobotState state(same);
  state.command({"up", "tension", 2.0});
  for (int k = 0; k < 5; ++k) state.step();
  const mesh::Interior& inside = state.description().surfaces[0].inside;
  FrameWishes wishes{.fields = std::vector<bool>(list_fields().size())};
  wishes.fields[0] = true;
  EXPECT_TRUE(state.frame(wishes, 1.0)->bodies[0].inner_positions.empty());
  wishes.inside = true;
  const auto frame = state.frame(wishes, 1.0);
  const BodyFrame& body = frame->bodies[0];
  ASSERT_GT(inside.nodes.size(), 0U);
  ASSERT_EQ(body.inner_positions.size(), 3 * inside.nodes.size());
  const std::vector<double> moved = fem::displacement_field(state.simulation().body(0));
  for (std::size_t k = 0; k < inside.nodes.size(); ++k) {
    const NodeId node = inside.nodes[k];
    EXPECT_EQ(body.inner_positions[3 * k + 1],
              static_cast<float>(state.simulation().body(0).positions()(node, 1)));
    EXPECT_EQ(body.inner_fields[0][k], static_cast<float>(moved[static_cast<std::size_t>(node)]));
  }
  EXPECT_TRUE(body.inner_fields[1].empty()) << "nobody asked";
}

TEST(LiveSource, WaitsForAPageWhenToldTo) {
  Watcher watcher;
  LiveSource source(robot(), {.controller = "", .playing = true, .speed = 0.0, .gallery = {}});
  source.await_page();
  source.start(watcher);
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(watcher.frame()->step, 0U);
  EXPECT_EQ(watcher.status()["playing"], true);
  source.submit(Ready{}, [](const Outcome&) {});
  for (int k = 0; k < 1000 && watcher.frame()->step == 0; ++k) std::this_thread::sleep_for(10ms);
  EXPECT_GT(watcher.frame()->step, 0U);
  source.stop();
}

TEST(LiveSource, TellsOfSlackInCablesThatAreCommanded) {
  const scene::Robot same = robot();
  RobotState state(same);
  const auto slack = [&] {
    const Json status = Json::parse(state.status_members());
    return std::ranges::count_if(status["troubles"],
                                 [](const Json& t) { return t["kind"] == "slack"; });
  };
  state.command({"push", "force", -0.5});
  for (int k = 0; k < 5; ++k) state.step();
  ASSERT_TRUE(state.simulation().actuator(0).slack);
  EXPECT_EQ(slack(), 0) << "nobody pulls it";
  state.command({"up", "displacement", -1e-3});
  for (int k = 0; k < 5; ++k) state.step();
  ASSERT_TRUE(state.simulation().actuator(0).slack);
  EXPECT_EQ(slack(), 1);
}

TEST(LiveSource, ShowsSensorsBesideProbes) {
  std::string text = kScene;
  text.insert(text.find("controllers:"), R"(sensors:
  eye: {type: marker, body: beam, point: 60 10 10 mm, noise: 0.1 mm, delay: 20 ms}
  load: {type: cable-tension, actuator: up, bias: 1 N}
)");
  const scene::Robot same = scene::build(scene::parse_scene_text(text, "test", {}));
  RobotState state(same);
  const Description& description = state.description();
  const Json probes = Json::parse(description.scene)["probes"];
  ASSERT_EQ(probes.size(), 4u);
  EXPECT_EQ(probes[1]["sensor"], false);
  EXPECT_EQ(probes[2]["sensor"], true);
  EXPECT_EQ(probes[2]["kind"], "marker");
  EXPECT_EQ(probes[2]["marks"], 1);
  EXPECT_EQ(probes[2]["signals"].size(), 3u);
  EXPECT_EQ(probes[3]["marks"], 0);
  EXPECT_EQ(probes[3]["signals"], Json::array({"sensor.load.measured"}));
  const auto number = [&](const Frame& frame, const char* key) {
    const auto found = std::ranges::find(description.signals, key, &SignalInfo::key);
    return frame.signals.at(static_cast<std::size_t>(found - description.signals.begin()));
  };
  const auto start = state.frame({}, 1.0);
  EXPECT_TRUE(std::isnan(number(*start, "sensor.eye.measured_x")));  // not yet arrived
  for (int k = 0; k < 4; ++k) state.step();
  const auto frame = state.frame({}, 1.0);
  const sim::Simulation& simulation = state.simulation();
  EXPECT_EQ(number(*frame, "sensor.eye.measured_x"),
            sense::sensors_of(simulation).channel(0).value()[0]);
  EXPECT_EQ(number(*frame, "sensor.eye.true_x"), simulation.effector_value(0).x());
  EXPECT_EQ(number(*frame, "sensor.load.measured"), simulation.actuator(0).effort + 1.0);
  ASSERT_EQ(frame->probes.size(), 3 * (2 + 4 + 1u));
  EXPECT_EQ(frame->probes[3 * 6], static_cast<float>(simulation.effector_value(0).x()));
}

TEST(LiveSource, ResetsBitForBit) {
  Live live({.controller = "hold", .playing = false});
  const auto start = live.at(0)->hash;
  live.ask(Step{30});
  const auto later = live.at(30)->hash;
  EXPECT_NE(later, start);
  live.ask(SetTarget{"tip", Vector3(0.06, 0.012, 0.01)});
  live.ask(Pull{"beam", {0, 1, 2}, Vector3(1, 0, 0), Vector3(0.1, 0, 0.1), 5.0});
  live.ask(ChooseController{std::nullopt});
  live.ask(Step{5});
  EXPECT_EQ(kind(live.ask(Reset{})), "");
  EXPECT_EQ(live.at(0)->hash, start);
  live.ask(Step{30});
  EXPECT_EQ(live.at(30)->hash, later);
}

TEST(LiveSource, PlaysPausesAndKeepsTime) {
  Live live({.controller = "hold", .playing = true, .speed = 0.0});
  live.wait([](const Frame& frame) { return frame.step > 200; });
  EXPECT_EQ(kind(live.ask(Pause{})), "");
  const auto still = live.watcher.frame()->step;
  std::this_thread::sleep_for(200ms);
  EXPECT_LE(live.watcher.frame()->step, still + 500) << "what was under way may yet be shown";
  const auto paused = live.watcher.frame()->step;
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(live.watcher.frame()->step, paused);
  EXPECT_EQ(live.watcher.status()["playing"], false);
}

TEST(LiveSource, RefusesWithAReason) {
  Live live({.controller = "hold", .playing = false});
  EXPECT_EQ(kind(live.ask(SetCommand{"up", "displacement", 0.0})), "actuator-owned");
  EXPECT_EQ(kind(live.ask(SetCommand{"up", "pressure", 0.0})), "wrong-actuator-type");
  EXPECT_EQ(kind(live.ask(SetCommand{"upp", "displacement", 0.0})), "unknown-name");
  EXPECT_EQ(kind(live.ask(SetCommand{"up", "tension", 21.0})), "out-of-range");
  EXPECT_EQ(kind(live.ask(ChooseController{"hodl"})), "unknown-name");
  EXPECT_EQ(kind(live.ask(SetTarget{"top", Vector3::Zero()})), "unknown-name");
  EXPECT_EQ(kind(live.ask(Pull{"beam", {0, 1, 999999}, Vector3(1, 0, 0), Vector3::Zero(), 1.0})),
            "index-out-of-range");
  EXPECT_EQ(kind(live.ask(Open{"trunk/trunk"})), "not-in-this-version");
  EXPECT_EQ(live.watcher.frame()->step, 0U);
}

TEST(LiveSource, SteersWithoutAController) {
  Live live({.controller = "", .playing = false});
  EXPECT_EQ(kind(live.ask(SetTarget{"tip", Vector3(0.06, 0.01, 0.012)})), "");
  live.ask(Step{100});
  live.at(100);
  EXPECT_EQ(live.watcher.status()["controller"], "view");
  EXPECT_EQ(live.watcher.status()["commands"]["up"]["owned"], true);
  EXPECT_EQ(kind(live.ask(SetTarget{"tip", std::nullopt})), "");
  live.ask(Step{1});
  live.at(101);
  EXPECT_EQ(live.watcher.status()["controller"], nullptr);
}

TEST(LiveSource, SaysWhyARunStoppedAndStartsAnew) {
  Live live({.controller = "", .playing = false});
  const auto start = live.at(0)->hash;
  EXPECT_EQ(kind(live.ask(SetCommand{"push", "force", -1e6})), "");
  const Outcome outcome = live.ask(Step{50});
  ASSERT_TRUE(outcome.has_value());
  live.wait([&](const Frame&) { return !live.watcher.status()["stopped"].is_null(); });
  EXPECT_FALSE(live.watcher.status()["stopped"]["message"].get<std::string>().empty());
  EXPECT_EQ(kind(live.ask(Play{})), "") << "it tries again from the last solved state";
  live.wait([&](const Frame&) { return !live.watcher.status()["stopped"].is_null(); });
  EXPECT_EQ(kind(live.ask(Reset{})), "");
  live.wait([&](const Frame& frame) { return frame.hash == start; });
  EXPECT_EQ(kind(live.ask(Step{3})), "");
}

TEST(LiveSource, ABalloonPastItsPeakStopsAtItsLastSolvedStateAndPlaysOnFromThere) {
  Live live({.controller = "", .playing = false},
            scene::build(scene::parse_scene_text(kBalloon, "balloon", {})));
  EXPECT_EQ(kind(live.ask(SetCommand{"air", "pressure", 4.8e3})), "");
  live.ask(Step{1});
  const auto solved = live.at(1)->hash;
  EXPECT_EQ(kind(live.ask(SetCommand{"air", "pressure", 60e3})), "");
  EXPECT_EQ(kind(live.ask(Play{})), "");
  live.wait([&](const Frame&) { return !live.watcher.status()["stopped"].is_null(); });
  const auto message = live.watcher.status()["stopped"]["message"].get<std::string>();
  EXPECT_NE(message.find("limit point"), std::string::npos) << message;
  EXPECT_NE(message.find("volume_growth"), std::string::npos) << message;
  EXPECT_EQ(live.at(1)->hash, solved) << "the last solved state is shown";
  EXPECT_EQ(kind(live.ask(SetCommand{"air", "pressure", 3e3})), "");
  EXPECT_EQ(kind(live.ask(Play{})), "");
  live.wait([](const Frame& frame) { return frame.step > 3; });
  EXPECT_TRUE(live.watcher.status()["stopped"].is_null());
}

TEST(LiveSource, RecordsEveryStepAndSavesAFile) {
  Live live({.controller = "hold", .playing = false});
  const auto save = [&](std::string_view name) {
    std::promise<std::optional<Download>> file;
    live.source.fetch(name, [&](std::optional<Download> got) { file.set_value(std::move(got)); });
    return file.get_future().get();
  };
  EXPECT_FALSE(save("run.csv").has_value()) << "nothing was recorded";
  live.ask(Step{3});
  EXPECT_EQ(kind(live.ask(Record{true})), "");
  live.ask(Step{10});
  live.at(13);
  EXPECT_EQ(live.watcher.status()["recording"]["frames"], 11);
  EXPECT_FALSE(save("run.csv").has_value()) << "it has not ended";
  EXPECT_EQ(kind(live.ask(Record{false})), "");
  live.ask(Step{5});
  const auto table = save("run.csv");
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(std::ranges::count(table->bytes, '\n'), 12);
  const auto motion = save("motion.glb");
  ASSERT_TRUE(motion.has_value());
  EXPECT_EQ(motion->bytes.substr(0, 4), "glTF");
  EXPECT_FALSE(save("../run.csv").has_value());
}

TEST(LiveSource, StepsASimulationOfOthersAndGivesItsControllerBack) {
  const scene::Robot shown = robot();
  const auto simulation = std::make_shared<sim::Simulation>(shown.model);
  std::pair<std::string, std::unique_ptr<control::TargetController>> left;
  {
    Watcher watcher;
    LiveSource source(shown, simulation,
                      scene::SceneController{"mine", shown.controllers.at(0).settings},
                      {.controller = "", .playing = true, .speed = 0.0, .gallery = {}});
    source.start(watcher);
    std::promise<Outcome> done;
    source.submit(SetTarget{"tip", Vector3(0.06, 0.01, 0.011)},
                  [&](const Outcome& outcome) { done.set_value(outcome); });
    EXPECT_EQ(kind(done.get_future().get()), "");
    source.stop();
    left = source.take_controller();
  }
  EXPECT_EQ(left.first, "mine");
  ASSERT_NE(left.second, nullptr);
  EXPECT_EQ(left.second->settings().tasks.at(0).target.at(0.0), Vector3(0.06, 0.01, 0.011));
  const auto before = simulation->steps();
  simulation->step();
  EXPECT_EQ(simulation->steps(), before + 1);
  EXPECT_EQ(simulation->actuator(0).owner, dynamic_cast<const law::Controller*>(left.second.get()));
}

}  // namespace
}  // namespace sinew::viewer
