// Hashes of everything that the motion of a finite-element body depends on, by name.
#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

namespace {

void add(ValueHash& hash, const material::Hyperelastic& energy) {
  for (const auto& term : energy.powers) hash.add(term.coefficient, term.exponent);
  hash.add(energy.polynomial, energy.bulk_modulus, energy.saint_venant_shear);
  for (const auto& term : energy.prony) hash.add(term.relative_modulus, term.relaxation_time);
  if (energy.mullins) hash.add(energy.mullins->r, energy.mullins->m, energy.mullins->beta);
}

void add(ValueHash& hash, const std::vector<mesh::Face>& faces) {
  for (const mesh::Face& face : faces) hash.add(face.node, face.middle);
}

}  // namespace

std::vector<NamedHash> FemBodyModel::parts() const {
  const FemModelSettings& elements = settings_.elements;
  const mesh::Mesh& mesh = *settings_.mesh;
  ValueHash material, mass, points;
  mass.add(elements.mass, elements.total_mass, elements.equal_nodal_masses);
  for (const MaterialRegion& region : elements.regions) {
    mass.add(region.density);
    material.add(region.constants.young_modulus, region.constants.poisson_ratio, region.law,
                 region.elements, region.patches, region.hyperelastic.has_value());
    if (region.hyperelastic) add(material, *region.hyperelastic);
  }
  for (const PointMass& point : elements.point_masses) {
    points.add(point.nodes, point.weights, point.mass);
  }
  ValueHash membranes;
  for (const MembraneLayer& layer : elements.membranes) {
    add(membranes, layer.faces);
    membranes.add(layer.thickness, layer.constants.young_modulus, layer.constants.poisson_ratio);
  }
  ValueHash held = ValueHash().add(elements.fixed_nodes);
  for (const HeldAxis& axis : elements.held_axes) held.add(axis.node, axis.axis);
  const ValueHash nodes =
      ValueHash().add(mesh.nodes, mesh.tetrahedra, mesh.quadratic, mesh.hexahedra);
  const ValueHash damping = ValueHash().add(settings_.damping.mass, settings_.damping.stiffness);
  if (elements.sample) material.add(elements.sample->elements, elements.sample->weights);
  std::vector<NamedHash> result = {{"mesh", nodes.value()},
                                   {"material", material.value()},
                                   {"mass", mass.value()},
                                   {"point masses", points.value()},
                                   {"fixed nodes", held.value()},
                                   {"damping", damping.value()},
                                   {"gravity", ValueHash().add(settings_.gravity).value()}};
  if (!elements.membranes.empty()) result.push_back({"membranes", membranes.value()});
  return result;
}

// Hashes the position of the site and the spread of its nodes, which distinguishes a ball from its
// centre. Nodes and weights are not hashed: rounding decides in which element a point on a face was
// found.
std::uint64_t FemBodyModel::site_hash(int site) const {
  const mechanics::Attachment& of = attachment(site);
  const Vector3 at = rest_position(site);
  double spread = 0.0;
  for (std::size_t k = 0; k < of.nodes.size(); ++k) {
    spread += of.weights[k] * (mesh().nodes.row(of.nodes[k]).transpose() - at).squaredNorm();
  }
  return ValueHash().add(at, spread).value();
}

std::uint64_t FemBodyModel::load_hash(int load) const {
  return mechanics::hash_of(loads_->loads()[static_cast<std::size_t>(load)]);
}

}  // namespace sinew::fem
