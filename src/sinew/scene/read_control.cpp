#include <algorithm>

#include <fmt/format.h>

#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

control::Target read_circle(const Fields& fields) {
  control::Circle circle;
  fields.read("centre", circle.centre);
  fields.read("radius", circle.radius);
  fields.read("normal", circle.normal);
  fields.read("period", circle.period);
  fields.read("start_angle", circle.start_angle);
  return control::Target::circle(circle);
}

control::Target read_polyline(const Fields& fields, const ReadContext& context) {
  control::Polyline polyline;
  const PointList points = read_points(fields, "points", context);
  if (points.points.rows() == 0 && context.files == Files::ignore) return {};
  polyline.points = points.points;
  fields.read("closed", polyline.closed);
  fields.read("period", polyline.period);
  double speed = 0.0;
  if (fields.read("speed", speed)) {
    const double length = control::Target::length(polyline.points, polyline.closed);
    if (length == 0.0) {
      throw Error(ErrorKind::out_of_range, points.place, "the polyline has no length",
                  "give points that differ, or a fixed target");
    }
    polyline.period = length / speed;
  }
  return control::Target::polyline(polyline);
}

control::Target read_trajectory(const Fields& fields, const ReadContext& context) {
  TimeTable table = read_time_table(fields, 3, context);
  if (context.files == Files::ignore) return {};
  return control::Target::trajectory(std::move(table.times), Points(table.values));
}

control::Target read_target(const Fields& task, const char* key, const ReadContext& context) {
  Vector3 position;
  if (task.form(key).shape == Shape::quantity) {
    task.read(key, position);
    return control::Target::fixed(position);
  }
  const Fields fields = task.below(key);
  for (const Node::Entry& entry : fields.map().entries()) {
    if (entry.key != "circle" && entry.key != "polyline" && entry.key != "file") continue;
    return at_place(entry.value.place(), [&] {
      if (entry.key == "circle") return read_circle(fields.below("circle"));
      if (entry.key == "polyline") return read_polyline(fields.below("polyline"), context);
      return read_trajectory(fields, context);
    });
  }
  return {};
}

// The key of a target: a position for points, a rotation for orientations.
const char* target_key(const Fields& task, const EffectorDescription& effector) {
  const bool turns = effector.kind == EffectorDescription::Kind::orientation;
  const char* key = turns ? "rotation" : "target";
  if (task.find(key) != nullptr) return key;
  const char* given = turns ? "target" : "rotation";
  throw Error(ErrorKind::conflicting_keys, task.place(given),
              fmt::format("the effector '{}' measures {}", effector.name,
                          turns ? "an orientation" : "a position"),
              fmt::format("give it a {} instead of a {}", key, given));
}

TaskDescription read_task(const Node::Entry& entry, const Form& form, const ReadContext& context,
                          const SceneDescription& scene) {
  TaskDescription task;
  task.effector = entry.key;
  task.place = entry.key_place;
  const Fields fields(entry.value, form);
  const auto effector = std::find_if(scene.effectors.begin(), scene.effectors.end(),
                                     [&](const auto& e) { return e.name == entry.key; });
  const char* key = target_key(fields, *effector);
  task.target = read_target(fields, key, context);
  fields.read_numbers("weight", task.weights);
  fields.read("priority", task.priority);
  const auto directions = static_cast<std::size_t>(effector->directions.rows());
  if (task.weights.size() != 1 && task.weights.size() != directions) {
    throw Error(ErrorKind::wrong_length, fields.place("weight"),
                fmt::format("{} weights for the {} direction{} of '{}'", task.weights.size(),
                            directions, directions == 1 ? "" : "s", effector->name),
                "give one weight, or one for each direction");
  }
  return task;
}

void read_driven(const Fields& fields, ControllerDescription& controller) {
  const Node* actuators = fields.find("actuators");
  if (actuators == nullptr) return;
  for (const Node& name : actuators->items()) {
    const auto& known = controller.actuators;
    if (std::find(known.begin(), known.end(), name.spelling()) != known.end()) {
      throw Error(ErrorKind::duplicate_key, name.place(),
                  fmt::format("{} is named twice", show(name.spelling())), "name it once");
    }
    controller.actuators.push_back(name.spelling());
    controller.actuator_places.push_back(name.place());
  }
}

}  // namespace

ControllerDescription read_controller(const Node::Entry& entry, const ReadContext& context,
                                      const SceneDescription& scene) {
  ControllerDescription controller;
  controller.name = entry.key;
  controller.place = entry.key_place;
  const Form& form = form_of(grammar(), "controllers", Shape::names).items.front();
  const Fields fields(entry.value, form);
  controller.kind = &controller_kind(read_text(*entry.value.find(form.telltale)));
  read_driven(fields, controller);
  if (const Node* effectors = fields.find("effectors")) {
    const Form& tasks = fields.form("effectors").items.front();
    for (const Node::Entry& task : effectors->entries()) {
      controller.tasks.push_back(read_task(task, tasks, context, scene));
    }
  }
  controller.own = controller.kind->read({fields, context, scene, controller});
  return controller;
}

}  // namespace sinew::scene
