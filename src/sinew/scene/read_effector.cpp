#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

// Least sine of the angle between directions, or in a triangle, that defines a frame.
constexpr double kDegenerate = 1e-6;

void read_orientation(const Fields& fields, EffectorDescription& effector) {
  effector.kind = EffectorDescription::Kind::orientation;
  if (fields.find("directions") != nullptr) {
    throw Error(ErrorKind::conflicting_keys, fields.place("directions"),
                "'directions' with 'orientation': a rotation has x, y and z components",
                "remove directions; weights of the controller choose among components");
  }
  if (effector.points.points.rows() == 1) return;  // of a rigid section
  const Vector3 origin = effector.points.points.row(0);
  const Vector3 first = effector.points.points.row(1).transpose() - origin;
  const Vector3 second = effector.points.points.row(2).transpose() - origin;
  const double size = first.norm() * second.norm();
  if (first.cross(second).norm() > kDegenerate * size && size > 0.0) return;
  throw Error(ErrorKind::degenerate_orientation, fields.place("orientation"),
              "the three points lie on one line", "give three points that span a triangle");
}

void read_measured(const Fields& fields, EffectorDescription& effector,
                   const ReadContext& context) {
  using Kind = EffectorDescription::Kind;
  if (fields.read("set", effector.set)) {
    effector.kind = Kind::set;
    effector.set_place = fields.place("set");
    return;
  }
  if (fields.find("point") != nullptr) {
    effector.kind = Kind::point;
    effector.points = read_point(fields, "point");
  } else if (fields.find("points") != nullptr) {
    effector.kind = Kind::points;
    effector.points = read_points(fields, "points", context);
  } else {
    effector.points = fields.form("orientation").shape == Shape::quantity
                          ? read_point(fields, "orientation")
                          : read_points(fields, "orientation", context);
    read_orientation(fields, effector);
  }
}

void read_directions(const Fields& fields, EffectorDescription& effector) {
  const Node* node = fields.find("directions");
  if (node == nullptr) return;
  const Form& form = fields.form("directions");
  if (form.shape == Shape::choice) {
    effector.directions = read_axis(*node, {form}).transpose();
    return;
  }
  const auto count = static_cast<Eigen::Index>(node->items().size());
  effector.directions.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Node& item = node->items()[static_cast<std::size_t>(i)];
    effector.directions.row(i) = read_axis(item, form.items).transpose();
  }
  const MatrixX overlap = effector.directions * effector.directions.transpose();
  if (overlap.determinant() > kDegenerate * kDegenerate) return;
  throw Error(ErrorKind::out_of_range, node->place(), "the directions depend on each other",
              "give directions that do not lie in one line or plane");
}

}  // namespace

Vector3 read_axis(const Node& node, const std::vector<Form>& forms) {
  const Form& form = select_form(node, forms, "x");
  if (form.shape != Shape::choice) return unit_vector(read_numbers(node, form), node.place());
  const std::string& word = read_choice(node, form).word;
  return Vector3::Unit(word == "x" ? 0 : word == "y" ? 1 : 2);
}

EffectorDescription read_effector(const Node::Entry& entry, const ReadContext& context) {
  EffectorDescription effector;
  effector.name = entry.key;
  effector.place = entry.key_place;
  const Fields fields(entry.value, form_of(grammar(), "effectors", Shape::names).items.front());
  fields.read("body", effector.body);
  effector.body_place = fields.place("body");
  read_outside(fields, effector.outside);
  read_measured(fields, effector, context);
  read_directions(fields, effector);
  return effector;
}

}  // namespace sinew::scene
