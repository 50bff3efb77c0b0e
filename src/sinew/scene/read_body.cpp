#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/axis_names.hpp"
#include "sinew/material/library.hpp"
#include "sinew/material/scaled.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

constexpr const char* kShapeKey = "shape";

// Reads one factor, or one for each axis.
void read_scale(const Fields& fields, Vector3& scale) {
  std::vector<double> factors;
  if (!fields.read_numbers("scale", factors)) return;
  if (factors.size() == 2) {
    throw Error(ErrorKind::wrong_length, fields.place("scale"), "there are 2 factors",
                "write one, or three along x, y and z");
  }
  if (factors.size() == 1) factors.resize(3, factors.front());
  scale = Vector3(factors[0], factors[1], factors[2]);
  if (scale.prod() != 0.0) return;
  throw Error(ErrorKind::out_of_range, fields.place("scale"), "a factor of 0 leaves no volume",
              "write factors other than 0; -1 mirrors");
}

}  // namespace

MeshDescription read_mesh_file(const Fields& fields, const ReadContext& context) {
  MeshDescription mesh;
  mesh.file = context.path(fields, "file");
  mesh.place = fields.place("file");
  mesh.unit_given = fields.read("unit", mesh.unit);
  if (mesh.unit_given) mesh.unit_place = fields.place("unit");
  read_scale(fields, mesh.scale);
  return mesh;
}

namespace {

// Reads the given measures of a shape.
void read_measures(const Fields& fields, MeshDescription& mesh) {
  for (const Node::Entry& entry : fields.map().entries()) {
    if (entry.key == kShapeKey) continue;
    const Form& written = fields.form(entry.key);
    mesh.parameters[entry.key] = written.shape == Shape::integer
                                     ? read_integer(entry.value, written)
                                     : read_numbers(entry.value, written).front();
  }
}

MeshDescription read_mesh(const Fields& body, const ReadContext& context) {
  const Form& form = body.form("mesh");
  const Fields fields = body.below("mesh");
  if (form.shape == Shape::table) return read_mesh_file(fields, context);
  MeshDescription mesh;
  mesh.place = body.place("mesh");
  mesh.shape = read_text(*fields.map().find(kShapeKey));
  read_measures(fields, mesh);
  return mesh;
}

void read_parts(const Fields& fields, const ReadContext& context, BodyDescription& body) {
  const Node* parts = fields.find("parts");
  if (parts == nullptr) return;
  const Form& form = fields.form("parts").items.front();
  for (const Node::Entry& entry : parts->entries()) {
    const Fields own(entry.value, form);
    PartDescription part;
    part.name = entry.key;
    part.place = entry.key_place;
    part.region = read_region(own.below("region"));
    part.material = read_material(own, context);
    double density = 0.0;
    if (own.read("density", density)) part.density = density;
    body.parts.push_back(std::move(part));
  }
}

void read_mass(const Fields& fields, BodyDescription& body) {
  double value = 0.0;
  body.mass_place = body.place;
  if (fields.read("mass", value)) {
    body.mass = value;
    body.mass_place = fields.place("mass");
  }
  if (fields.read("density", value)) {
    body.density = value;
    body.mass_place = fields.place("density");
  }
  fields.read_choice("mass_distribution", body.mass_distribution,
                     {{"even", MassDistribution::even}, {"volume", MassDistribution::volume}});
  fields.read_choice("mass_matrix", body.mass_matrix,
                     {{"lumped", MassMatrix::lumped}, {"consistent", MassMatrix::consistent}});
  if (body.mass_distribution == MassDistribution::even &&
      body.mass_matrix == MassMatrix::consistent) {
    throw Error(ErrorKind::conflicting_keys, fields.place("mass_matrix"),
                "an even mass has no consistent matrix",
                "write mass_matrix: lumped, or mass_distribution: volume");
  }
}

void read_box(const Fields& fields, FixedRegion& region) {
  std::vector<double> corners;
  fields.read_numbers("box", corners);
  for (int axis = 0; axis < 3; ++axis) {
    region.lower[axis] = corners[static_cast<std::size_t>(axis)];
    region.upper[axis] = corners[static_cast<std::size_t>(axis) + 3];
    if (region.lower[axis] <= region.upper[axis]) continue;
    throw Error(ErrorKind::contradictory_limits, fields.place("box"),
                fmt::format("the box begins at {} = {} m and ends at {} m", "xyz"[axis],
                            region.lower[axis], region.upper[axis]),
                "write the lowest corner first: x y z x y z");
  }
}

void read_axes(const Fields& fields, FixedRegion& region) {
  const Node* axes = fields.find("axes");
  if (axes == nullptr) return;
  region.axes = {false, false, false};
  const auto hold = [&](const Node& word) {
    region.axes[std::string_view("xyz").find(read_text(word).front())] = true;
  };
  if (fields.form("axes").shape == Shape::choice) return hold(*axes);
  for (const Node& word : axes->items()) hold(word);
}

}  // namespace

FixedRegion read_region(const Fields& fields) {
  FixedRegion region;
  region.place = fields.map().place();
  if (fields.find("box") != nullptr) {
    region.place = fields.place("box");
    read_box(fields, region);
  } else if (fields.find("sphere") != nullptr) {
    region.kind = FixedRegion::Kind::sphere;
    const Fields sphere = fields.below("sphere");
    sphere.read("centre", region.point);
    sphere.read("radius", region.radius);
  } else if (fields.find("plane") != nullptr) {
    region.kind = FixedRegion::Kind::plane;
    const Fields plane = fields.below("plane");
    plane.read("point", region.point);
    plane.read_direction("normal", region.normal);
    plane.read("within", region.within);
  } else {
    region.kind = FixedRegion::Kind::set;
    fields.read("set", region.set);
    region.place = fields.place("set");
  }
  return region;
}

namespace {

// The tables of one region or of a list of them; empty without the key.
std::vector<Fields> tables_of(const Fields& fields, std::string_view key) {
  std::vector<Fields> tables;
  const Node* written = fields.find(key);
  if (written == nullptr) return tables;
  const Form& form = fields.form(key);
  if (form.shape == Shape::table) {
    tables.emplace_back(*written, form);
  } else {
    for (const Node& item : written->items()) {
      tables.emplace_back(item, select_form(item, form.items, {}));
    }
  }
  return tables;
}

void read_fixed(const Fields& fields, BodyDescription& body) {
  for (const Fields& region : tables_of(fields, "fixed")) {
    body.fixed.push_back(read_region(region));
    read_axes(region, body.fixed.back());
  }
}

}  // namespace

std::vector<FixedRegion> read_regions(const Fields& fields, std::string_view key) {
  std::vector<FixedRegion> regions;
  for (const Fields& region : tables_of(fields, key)) regions.push_back(read_region(region));
  return regions;
}

model::BaseMotion read_motion(const Fields& fields, const ReadContext& context) {
  model::BaseMotion motion;
  for (std::size_t c = 0; c < 3; ++c) {
    if (fields.find(kAxisNames[c]) != nullptr) {
      motion.translation[c] = read_signal(fields, kAxisNames[c], context);
    }
  }
  if (fields.find("angle") != nullptr) motion.angle = read_signal(fields, "angle", context);
  fields.read_direction("axis", motion.axis);
  fields.read("centre", motion.centre);
  return motion;
}

namespace {

const Form& shape_form() {
  const Form& body = form_of(grammar(), "bodies", Shape::names).items.front();
  const auto fem = std::ranges::find(body.choices, "fem", &Choice::word);
  return form_of(*fem->table, "mesh", Shape::variants);
}

}  // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const Choice& shape : shape_form().choices) names.push_back(shape.word);
  return names;
}

MeshDescription read_shape(const std::string& shape, const std::vector<std::string>& measures) {
  const Location place = {.item = "--shape"}, setting = {.item = "--set"};
  Node written = Node::map(), word = Node::text(shape);
  word.set_place(place);
  written.set(kShapeKey, std::move(word));
  for (const std::string& measure : measures) {
    const std::size_t equals = measure.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Error(ErrorKind::bad_argument, setting,
                  fmt::format("{} is not an assignment", show(measure)),
                  "write a measure, '=' and a value: radius=15mm");
    }
    const std::string key = measure.substr(0, equals);
    Node value = parse_yaml(measure.substr(equals + 1), key);
    value.set_place({.file = "--set", .item = key});
    written.set(key, std::move(value));
  }
  const Fields fields(written, shape_form());
  for (const Node::Entry& entry : written.entries()) {
    if (entry.key == kShapeKey) continue;
    const Key* key = fields.table().find(entry.key);
    if (key == nullptr) throw_unknown_key(entry.key, fields.table(), setting);
    check_value(entry.value, key->forms);
  }
  MeshDescription mesh;
  mesh.place = place;
  mesh.shape = shape;
  read_measures(fields, mesh);
  return mesh;
}

void read_fem_body(const Fields& fields, const ReadContext& context, BodyDescription& body) {
  body.mesh = read_mesh(fields, context);
  const Fields pose = fields.below("pose");
  pose.read("position", body.position);
  body.rotation = read_rotation_vector(pose);
  fields.read_choice("element", body.element,
                     {{"tet4", Element::tet4},
                      {"tet4-patch", Element::tet4_patch},
                      {"tet10", Element::tet10},
                      {"hex8", Element::hex8}});
  body.element_place = fields.place("element");
  body.material = read_material(fields, context);
  read_parts(fields, context, body);
  read_mass(fields, body);
  const Fields damping = fields.below("damping");
  damping.read("mass", body.mass_damping);
  damping.read("stiffness", body.stiffness_damping);
  read_fixed(fields, body);
  if (fields.find("velocity") != nullptr) {
    const Fields start = fields.below("velocity");
    auto& velocity = body.velocity.emplace();
    velocity.place = fields.place("velocity");
    start.read("linear", velocity.linear);
    start.read("angular", velocity.angular);
  }
  if (fields.find("motion") != nullptr) {
    body.motion = read_motion(fields.below("motion"), context);
    body.motion_place = fields.place("motion");
  }
}

}  // namespace sinew::scene
