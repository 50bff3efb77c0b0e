// Selects the finite elements of a body.
#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/rotation.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/build_parts.hpp"

namespace sinew::scene {

namespace {

template <typename Visit>
void each_material(const BodyDescription& body, Visit visit) {
  visit(body.material);
  for (const PartDescription& part : body.parts) visit(part.material);
}

bool is_hyperelastic(const BodyDescription& body) {
  bool all = true;
  each_material(body, [&](const MaterialDescription& one) { all = all && one.is_hyperelastic(); });
  return all;
}

void check_kind(const BodyDescription& body, const mesh::Mesh& mesh) {
  const bool tetrahedra = !mesh.tetrahedra.empty(), hexahedra = !mesh.hexahedra.empty();
  const bool quadratic = !mesh.quadratic.empty();
  const bool linear = body.element == Element::tet4 || body.element == Element::tet4_patch;
  const bool other =
      (linear && (hexahedra || quadratic)) || (body.element == Element::hex8 && tetrahedra);
  if (!other) return;
  throw Error(ErrorKind::unsupported_element, body.element_place,
              fmt::format("the mesh has {}", quadratic    ? "quadratic tetrahedra"
                                             : tetrahedra ? "tetrahedra"
                                                          : "hexahedra"),
              "leave `element` out, or give another mesh");
}

void check_law(const BodyDescription& body, const MaterialDescription& material,
               const mesh::Mesh& mesh) {
  const bool split = material.is_hyperelastic() && material.energy.saint_venant_shear == 0.0;
  if (body.element == Element::tet4_patch && !split) {
    throw Error(ErrorKind::unsupported_element, material.place,
                "tet4-patch needs a law whose volumetric part stands apart",
                "give it a hyperelastic one other than saint-venant-kirchhoff, for instance model: "
                "neo-hookean, or take tet4");
  }
  const bool hexahedra = !mesh.hexahedra.empty();
  if ((hexahedra || !mesh.quadratic.empty()) && !material.is_hyperelastic()) {
    throw Error(ErrorKind::unsupported_element, material.place,
                fmt::format("the mesh has {}, and the material is linear or corotational",
                            hexahedra ? "hexahedra" : "quadratic tetrahedra"),
                "give them a hyperelastic one, for instance model: neo-hookean");
  }
}

// The mesh in the frame of its file, with the element type that the body names.
mesh::Mesh make_own_mesh(const BodyDescription& body) {
  const bool chosen = body.element != Element::any;
  if (chosen || !is_hyperelastic(body)) {
    return make_mesh(body.mesh, body.element);
  }
  if (!body.mesh.shape.empty()) return make_mesh(body.mesh, Element::tet10);
  mesh::Mesh mesh = make_mesh(body.mesh);
  const bool linear = mesh.hexahedra.empty() && mesh.quadratic.empty();
  return linear ? mesh::with_middle_nodes(mesh) : mesh;
}

}  // namespace

mesh::Mesh make_body_mesh(const BodyDescription& body) {
  mesh::Mesh mesh = make_own_mesh(body);
  place_in_world(body, mesh.nodes);
  mesh.axes = rotation_matrix(body.rotation) * mesh.axes;
  return mesh;
}

void place_in_world(const BodyDescription& body, Points& points) {
  if (!body.rotation.isZero(0.0)) points = points * rotation_matrix(body.rotation).transpose();
  if (!body.position.isZero(0.0)) points.rowwise() += body.position.transpose();
}

void check_element(const BodyDescription& body, const mesh::Mesh& mesh) {
  check_kind(body, mesh);
  each_material(body, [&](const MaterialDescription& one) { check_law(body, one, mesh); });
}

}  // namespace sinew::scene
