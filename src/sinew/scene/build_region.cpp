// Regions, faces and spots of the bodies that are built.
#include "sinew/builder/probe_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

mesh::Region region_of(const FixedRegion& fixed) {
  switch (fixed.kind) {
    case FixedRegion::Kind::box:
      return mesh::BoxRegion{fixed.lower, fixed.upper};
    case FixedRegion::Kind::sphere:
      return mesh::SphereRegion{fixed.point, fixed.radius};
    case FixedRegion::Kind::plane:
      return mesh::PlaneRegion{fixed.point, fixed.normal, -fixed.within, fixed.within};
    case FixedRegion::Kind::set:
      return mesh::NamedRegion{fixed.set};
  }
  return mesh::NamedRegion{fixed.set};
}

std::vector<mesh::Face> faces_of(const SurfaceDescription& surface, const mesh::Mesh& mesh) {
  const std::string& what = surface.place.item;
  try {
    switch (surface.kind) {
      case SurfaceDescription::Kind::inside:
        return mesh::enclosing_surface(mesh, surface.point, what);
      case SurfaceDescription::Kind::patch:
        return mesh::grow_patch(mesh, surface.point, surface.angle, what);
      case SurfaceDescription::Kind::region:
        return mesh::select_faces(mesh, region_of(surface.region), what);
      case SurfaceDescription::Kind::file:
        throw Error(ErrorKind::conflicting_keys, surface.place,
                    "faces of the body's own mesh are asked for, not a surface in a file",
                    "name them by a point inside, a patch or a region");
    }
  } catch (const Error& error) {
    throw error.at(surface.place);
  }
  return {};
}

std::vector<NodeId> nodes_of(const FixedRegion& region, const mesh::Mesh& mesh) {
  return at_place(region.place,
                  [&] { return mesh::select_nodes(mesh, region_of(region), region.place.item); });
}

builder::ProbeSpot spot_of(const SpotDescription& spot, const BodyOf& body_of) {
  const BuiltBody body = body_of(spot.body);
  builder::ProbeSpot built;
  built.body = body.number;
  built.points = spot.points.points;
  if (spot.region) built.nodes = nodes_of(*spot.region, body.model->mesh());
  return built;
}

}  // namespace sinew::scene
