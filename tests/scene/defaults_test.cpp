// Documented defaults of the grammar equal the defaults of the structs: writing every default into
// a scene does not change its description.
#include <sstream>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/mesh/shapes.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/grammar.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/scene/values.hpp"
#include "sinew/sense/sensor_settings.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

const char* const kSparse = R"(sinew: 1
bodies:
  a:
    type: fem
    mesh: {file: a.vtk}
    material: {young_modulus: 1, poisson_ratio: 0}
    mass: 1
    fixed: {plane: {point: 0 0 0}}
actuators:
  ramp:
    type: cable
    body: a
    points: [0 0 0, 0 0 1]
    command: {tension: {ramp: {to: 1, duration: 1}}}
  sine:
    type: force
    body: a
    point: 0 0 1
    direction: 1 0 0
    command: {force: {sine: {amplitude: 1, period: 1}}}
  held: {type: force, body: a, point: 0 0 1, direction: 0 1 0}
effectors:
  tip: {body: a, point: 0 0 1}
masses:
  hung: {body: a, point: 0 0 1, mass: 1}
probes:
  axis: {body: a, line: [0 0 0, 0 0 1]}
  girth: {body: a, extent: {across: z}}
sensors:
  mark: {type: marker, body: a, point: 0 0 1}
  light: {type: attenuation, body: a, line: [0 0 0, 0 0 1]}
  plates: {type: capacitance, body: a, electrodes: [{patch: {point: 0 0 0}}, {set: b}]}
  on: {type: touch, contact: floor, file: a.csv}
contacts:
  floor: {body: a, surface: {plane: {}}, motion: {}}
controllers:
  follow:
    type: inverse
    effectors:
      tip: {target: {circle: {centre: 0 0 1, radius: 1, period: 1}}}
  line:
    type: inverse
    actuators: [sine]
    effectors:
      tip: {target: {polyline: {points: [0 0 0, 0 0 1], period: 1}}}
  loop:
    type: closed-loop
    actuators: [held]
    sensors: [mark]
    effectors: {tip: {target: 0 0 1}}
)";

// The description as text, with signals and targets by their values.
class Dump {
 public:
  explicit Dump(const SceneDescription& scene) {
    add(scene.gravity, scene.time_step, scene.integrator, scene.duration.value_or(-1));
    add(scene.solver.method, scene.solver.tangent, scene.solver.tolerance.value_or(-1));
    add(scene.solver.max_iterations, scene.solver.threads, scene.solver.backend);
    add(scene.solver.contact_tolerance);
    add(scene.solver.ordering, scene.record.every, scene.record.states);
    for (const auto& body : scene.bodies) add_body(body);
    for (const auto& actuator : scene.actuators) add_actuator(actuator);
    for (const auto& mass : scene.masses) add(mass.outside);
    for (const auto& effector : scene.effectors) add(effector.directions, effector.outside);
    for (const auto& probe : scene.probes) add_probe(probe);
    for (const auto& sensor : scene.sensors) add_sensor(sensor);
    for (const auto& contact : scene.contacts) {
      const auto& plane = std::get<constraint::Plane>(contact.surface);
      add(plane.point, plane.normal, contact.friction, contact.outside, contact.motion->axis);
      add(contact.motion->translation[0].value(1.0), contact.motion->angle.value(1.0));
    }
    for (const auto& controller : scene.controllers) {
      if (const auto* inverse = controller.as<InverseDescription>()) {
        add(inverse->settings.regularisation, inverse->settings.epsilon);
      }
      if (const auto* loop = controller.as<ClosedLoopDescription>()) {
        add(loop->settings.gain, loop->settings.integral, loop->settings.timeout);
      }
      for (const auto& task : controller.tasks) {
        for (const double weight : task.weights) add(weight);
        for (const double time : {0.0, 0.3, 1.7}) add(task.target.at(time));
      }
    }
  }
  std::string text() const { return out_.str(); }

 private:
  void add_body(const BodyDescription& body) {
    add(body.mesh.unit, body.material.model, body.mass_distribution, body.mass_matrix);
    add(body.mass_damping, body.stiffness_damping, body.fixed[0].normal, body.fixed[0].within);
    const auto start = body.velocity.value_or(InitialVelocityDescription{});
    add(start.linear, start.angular);
  }
  void add_probe(const ProbeDescription& probe) {
    add(probe.outside);
    if (const auto* line = probe.as<builder::ProbeLine>()) add(line->samples);
    if (const auto* extent = probe.as<builder::ProbeExtent>()) add(extent->way);
  }
  void add_sensor(const SensorDescription& sensor) {
    const sense::ChannelSettings& channel = sensor.channel;
    add(channel.noise, channel.bias, channel.drift, channel.delay, channel.dropout, channel.seed);
    add(sensor.outside);
    if (const auto* line = sensor.as<sense::SensorLine>()) {
      add(line->line.samples, line->loss_per_length, line->loss_per_turn);
    } else if (const auto* plates = sensor.as<CapacitanceDescription>()) {
      add(plates->permittivity, plates->electrodes[0].angle);
    } else if (const auto* contact = sensor.as<ContactSensorDescription>()) {
      add(contact->threshold.value_or(-1.0));
    }
  }
  void add_actuator(const ActuatorDescription& actuator) {
    if (const auto* cable = actuator.as<CableDescription>()) {
      const builder::CableSettings& settings = cable->settings;
      add(settings.outside, settings.pull_from_world, settings.geometric_stiffness);
      add(settings.friction, settings.guide_radius, settings.guide_spacing);
      add_limits(settings.tension, settings.displacement);
    } else {
      const auto& force = *actuator.as<builder::ForceSettings>();
      add(force.outside);
      add_limits(force.force, force.displacement);
    }
    for (const double time : {0.0, 0.3, 1.7}) add(actuator.command.signal.value(time));
  }
  void add_limits(const model::Limits& effort, const model::Limits& motion) {
    for (const model::Limits& limits : {effort, motion}) add(limits.min, limits.max, limits.rate);
  }
  template <typename... Values>
  void add(const Values&... values) {
    (write(values), ...);
    out_ << '\n';
  }
  template <typename Value>
  void write(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      out_ << static_cast<int>(value) << ' ';
    } else {
      out_ << value << ' ';
    }
  }

  std::ostringstream out_;
};

std::string dump(const Node& tree) {
  return Dump(parse_scene_tree(tree, {}, Files::ignore)).text();
}

// For every omitted key with a default: sets it, compares, and removes it again.
class Visitor {
 public:
  explicit Visitor(Node& scene) : scene_(scene), before_(dump(scene)) {}

  void visit(Node& map, const KeyTable& table) {
    for (const Key& key : table.keys) {
      if (Node* present = map.find(key.name)) {
        visit_value(*present, key.forms);
      } else if (!key.default_text.empty() && applies(map, key)) {
        Node value = parse_yaml(key.default_text, "default");
        map.set(key.name, value);
        EXPECT_EQ(dump(scene_), before_) << table.name << ": " << key.name;
        ++tried_;
        visit_value(*map.find(key.name), key.forms);
        map.erase(key.name);
      }
    }
  }
  int tried() const { return tried_; }

 private:
  static bool applies(const Node& map, const Key& key) {
    return key.only_with.empty() || map.find(key.only_with) != nullptr;
  }

  void visit_value(Node& node, const std::vector<Form>& forms) {
    const Form& form = select_form(node, forms, {});
    if (form.shape == Shape::names) {
      for (Node::Entry& entry : node.entries()) visit_value(entry.value, form.items);
    } else if (node.is_map()) {
      visit(node, table_of(node, form));
    }
  }

  Node& scene_;
  std::string before_;
  int tried_ = 0;
};

TEST(Defaults, DocumentedOnesAreThoseOfTheStructs) {
  Node tree = parse_yaml(kSparse, "scene.yaml");
  // Two controllers share actuators here, which does not concern defaults.
  tree.find("controllers")->find("follow")->set("actuators", parse_yaml("[ramp]", "x"));
  Visitor visitor(tree);
  visitor.visit(tree, grammar());
  EXPECT_GT(visitor.tried(), 45);
}

TEST(Defaults, OfTheTrunkAreThoseOfItsShape) {
  const Form& bodies = form_of(grammar(), "bodies", Shape::names);
  const Form& shapes = form_of(*bodies.items[0].choices[0].table, "mesh", Shape::variants);
  const mesh::TrunkShape trunk;
  const auto documented = [&](const char* key) {
    const Key& entry = *shapes.choices.back().table->find(key);
    return read_numbers(parse_yaml(entry.default_text, key), entry.forms[0])[0];
  };
  ASSERT_EQ(shapes.choices.back().word, "trunk");
  EXPECT_DOUBLE_EQ(documented("base_radius"), trunk.bottom_radius);
  EXPECT_DOUBLE_EQ(documented("tip_radius"), trunk.top_radius);
  EXPECT_DOUBLE_EQ(documented("height"), trunk.height);
  EXPECT_EQ(documented("bellows"), trunk.bellows);
  EXPECT_DOUBLE_EQ(trunk.groove_depth, 0.25) << "the page says: a quarter of base_radius";
}

// The grammar accepts each of its examples.
void check_examples(const KeyTable& table, int& count, int depth) {
  if (depth > 8) return;
  for (const Key& key : table.keys) {
    if (key.later) continue;
    EXPECT_FALSE(key.description.empty()) << table.name << ": " << key.name;
    ASSERT_FALSE(key.example.empty()) << table.name << ": " << key.name;
    if (key.example.find("...") == std::string::npos) {
      const Node example = parse_yaml(key.example, key.name);
      EXPECT_NO_THROW(select_form(example, key.forms, {})) << table.name << ": " << key.name;
      const Form& form = select_form(example, key.forms, {});
      if (form.shape == Shape::quantity) {
        EXPECT_NO_THROW(read_numbers(example, form)) << table.name << ": " << key.name;
      }
      if (form.shape == Shape::choice) {
        EXPECT_NO_THROW(read_choice(example, form)) << table.name << ": " << key.name;
      }
      if (form.shape == Shape::unit) {
        EXPECT_NO_THROW(read_unit(example, form)) << table.name << ": " << key.name;
      }
      ++count;
    }
    for (const Form& form : key.forms) {
      if (form.shape == Shape::table) check_examples(*form.table, count, depth + 1);
      for (const Choice& choice : form.choices) {
        if (choice.table) check_examples(*choice.table, count, depth + 1);
      }
      for (const Form& item : form.items) {
        if (item.shape == Shape::table) check_examples(*item.table, count, depth + 1);
        for (const Choice& choice : item.choices) {
          if (choice.table) check_examples(*choice.table, count, depth + 1);
        }
      }
    }
  }
}

TEST(Grammar, ExamplesAreValid) {
  int count = 0;
  check_examples(grammar(), count, 0);
  EXPECT_GT(count, 100);
}

TEST(Grammar, AsksForWhatItHas) {
  EXPECT_THROW(form_of(grammar(), "no_such_key", Shape::text), Error);
  EXPECT_THROW(form_of(grammar(), "time_step", Shape::boolean), Error);
}

}  // namespace
}  // namespace sinew::scene
