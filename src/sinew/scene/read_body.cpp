#include <fmt/format.h>

#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

MeshDescription read_mesh(const Fields& body, const ReadContext& context) {
  MeshDescription mesh;
  mesh.place = body.place("mesh");
  const Form& form = body.form("mesh");
  const Fields fields = body.below("mesh");
  if (form.shape == Shape::table) {
    mesh.file = context.path(fields, "file");
    mesh.place = fields.place("file");
    mesh.unit_given = fields.read("unit", mesh.unit);
    if (mesh.unit_given) mesh.unit_place = fields.place("unit");
    return mesh;
  }
  mesh.shape = read_text(*fields.map().find(form.telltale));
  for (const Node::Entry& entry : fields.map().entries()) {
    if (entry.key == form.telltale) continue;
    const Form& written = fields.form(entry.key);
    mesh.parameters[entry.key] = written.shape == Shape::integer
                                     ? read_integer(entry.value, written)
                                     : read_numbers(entry.value, written).front();
  }
  return mesh;
}

MaterialDescription read_material(const Fields& body) {
  MaterialDescription material;
  material.place = body.place("material");
  const Fields fields = body.below("material");
  fields.read_choice(
      "model", material.model,
      {{"linear", MaterialModel::linear}, {"corotational", MaterialModel::corotational}});
  fields.read("young_modulus", material.young_modulus);
  fields.read("poisson_ratio", material.poisson_ratio);
  material.young_modulus_place = fields.place("young_modulus");
  material.poisson_ratio_place = fields.place("poisson_ratio");
  return material;
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

FixedRegion read_region(const Fields& fields) {
  FixedRegion region;
  region.place = fields.map().place();
  if (fields.find("box") != nullptr) {
    region.place = fields.place("box");
    read_box(fields, region);
  } else if (fields.find("sphere") != nullptr) {
    region.kind = FixedRegion::Kind::sphere;
    const Fields sphere = fields.below("sphere");
    sphere.read("center", region.point);
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

void read_fixed(const Fields& fields, BodyDescription& body) {
  const Node* fixed = fields.find("fixed");
  if (fixed == nullptr) return;
  const Form& form = fields.form("fixed");
  if (form.shape == Shape::table) {
    body.fixed.push_back(read_region(Fields(*fixed, form)));
    return;
  }
  for (const Node& item : fixed->items()) {
    body.fixed.push_back(read_region(Fields(item, select_form(item, form.items, {}))));
  }
}

}  // namespace

BodyDescription read_body(const Node::Entry& entry, const ReadContext& context) {
  BodyDescription body;
  body.name = entry.key;
  body.place = entry.key_place;
  const Form& form = form_of(grammar(), "bodies", Shape::names).items.front();
  const Fields fields(entry.value, form);
  body.mesh = read_mesh(fields, context);
  body.material = read_material(fields);
  read_mass(fields, body);
  const Fields damping = fields.below("damping");
  damping.read("mass", body.mass_damping);
  damping.read("stiffness", body.stiffness_damping);
  read_fixed(fields, body);
  return body;
}

}  // namespace sinew::scene
