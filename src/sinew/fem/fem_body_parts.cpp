// Everything that the motion of a finite-element body depends on, by name.
#include <fmt/format.h>

#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

namespace {

void visit(PartVisitor& visitor, const material::Hyperelastic& energy) {
  int k = 0;
  for (const auto& term : energy.powers) {
    visitor.below(fmt::format("powers.{}", k++), [&] {
      visitor.number("coefficient", "Pa", term.coefficient).number("exponent", "", term.exponent);
    });
  }
  visitor.add(energy.polynomial);
  for (std::size_t i = 0; i < energy.polynomial.size(); ++i) {
    visitor.list(fmt::format("polynomial.{}", i), "Pa", energy.polynomial[i]);
  }
  visitor.number("bulk_modulus", "Pa", energy.bulk_modulus).add(energy.saint_venant_shear);
  if (energy.saint_venant_shear != 0.0) {
    visitor.list("shear_modulus", "Pa", energy.saint_venant_shear);
  }
  k = 0;
  for (const auto& term : energy.prony) {
    visitor.below(fmt::format("viscosity.{}", k++), [&] {
      visitor.number("relative_modulus", "", term.relative_modulus)
          .number("relaxation_time", "s", term.relaxation_time);
    });
  }
  if (!energy.mullins) return;
  visitor.below("softening", [&] {
    visitor.number("r", "", energy.mullins->r)
        .number("m", "Pa", energy.mullins->m)
        .number("beta", "", energy.mullins->beta);
  });
}

void visit(PartVisitor& visitor, const MaterialRegion& region) {
  const auto& [modulus, ratio] = region.constants;
  if (region.hyperelastic) {
    visitor.add(modulus, ratio);  // not used
  } else {
    visitor.number("young_modulus", "Pa", modulus).number("poisson_ratio", "", ratio);
  }
  visitor.add(region.law, region.elements, region.patches, region.hyperelastic.has_value());
  if (region.hyperelastic) visit(visitor, *region.hyperelastic);
}

// The paths of regions below their body: those of the scene's parts, or of the body.
class RegionPaths {
 public:
  std::string of(const MaterialRegion& region, const char* name) {
    if (!region.name.empty()) return fmt::format("parts.{}.{}", region.name, name);
    if (rest_ == nullptr) rest_ = &region;
    if (rest_ == &region) return name;
    if (last_ != &region) ++further_;  // from programs that give no names
    last_ = &region;
    return fmt::format("regions.{}.{}", further_, name);
  }

 private:
  const MaterialRegion *rest_ = nullptr, *last_ = nullptr;
  int further_ = 0;
};

}  // namespace

void FemBodyModel::describe(PartsVisitor& parts) const {
  const FemModelSettings& elements = settings_.elements;
  const mesh::Mesh& mesh = *settings_.mesh;
  parts.part("mesh").add(mesh.nodes, mesh.tetrahedra, mesh.quadratic, mesh.hexahedra);
  PartVisitor& material = parts.part("material");
  PartVisitor& mass = parts.part("mass");
  mass.add(elements.mass).number("mass", "kg", elements.total_mass);
  mass.add(elements.equal_nodal_masses);
  RegionPaths paths;
  for (const MaterialRegion& region : elements.regions) {
    if (elements.total_mass) {
      mass.add(region.density);  // scaled
    } else {
      mass.number(paths.of(region, "density"), "kg/m^3", region.density);
    }
    material.below(paths.of(region, "material"), [&] { visit(material, region); });
  }
  // Masses given by name come last.
  PartVisitor& points = parts.part("point masses", "masses");
  const std::size_t unnamed = elements.point_masses.size() - settings_.masses.size();
  for (std::size_t k = 0; k < elements.point_masses.size(); ++k) {
    const PointMass& point = elements.point_masses[k];
    points.add(point.nodes, point.weights, point.mass);
    if (k >= unnamed) points.list(settings_.masses[k - unnamed].name + ".mass", "kg", point.mass);
  }
  PartVisitor& held = parts.part("fixed nodes").add(elements.fixed_nodes);
  for (const HeldAxis& axis : elements.held_axes) held.add(axis.node, axis.axis);
  parts.part("damping")
      .number("damping.mass", "1/s", settings_.damping.mass)
      .number("damping.stiffness", "s", settings_.damping.stiffness);
  parts.part("gravity").number("gravity", "m/s^2", settings_.gravity);
  if (elements.membranes.empty()) return;
  PartVisitor& membranes = parts.part("membranes", "membranes");
  for (const MembraneLayer& layer : elements.membranes) {
    for (const mesh::Face& face : layer.faces) membranes.add(face.node, face.middle);
    membranes.below(layer.name, [&] {
      membranes.number("thickness", "m", layer.thickness)
          .number("young_modulus", "Pa", layer.constants.young_modulus)
          .number("poisson_ratio", "", layer.constants.poisson_ratio);
    });
  }
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

void FemBodyModel::describe_load(int load, PartVisitor& visitor) const {
  mechanics::describe(loads_->loads()[static_cast<std::size_t>(load)], visitor);
}

}  // namespace sinew::fem
