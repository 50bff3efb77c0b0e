/// @file
/// Boxes of every kind of solid element, with one rubber or several materials.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mesh/quadratic.hpp"

#include "block_mesh.hpp"
#include "reference.hpp"

namespace sinew::fem::solid_bodies {

inline material::Hyperelastic rubber(double poisson_ratio = 0.49) {
  material::Hyperelastic law =
      material::ogden({{24361.0, 1.7138}, {66.703, 7.0679}, {-453.81, -3.3659}},
                      material::OgdenConvention::mu_over_alpha);
  law.bulk_modulus = material::bulk_modulus_of(law.shear_modulus(), poisson_ratio);
  return law;
}

inline material::Hyperelastic soft_rubber() {
  material::Hyperelastic law = material::yeoh({9e3, -200.0, 30.0});
  law.bulk_modulus = 2e5;
  return law;
}

enum class Kind { tetrahedra, patches, quadratic, hexahedra, both };

/// A box of cells with jittered nodes; `both` has hexahedra below and tetrahedra above.
inline std::shared_ptr<mesh::Mesh> box(Kind kind, int nx, int ny, int nz, double jitter = 0.12) {
  auto result = block_mesh(nx, ny, nz, kEdge, jitter);
  if (kind == Kind::tetrahedra || kind == Kind::patches) return result;
  if (kind == Kind::quadratic) {
    return std::make_shared<mesh::Mesh>(mesh::with_middle_nodes(*result));
  }
  const auto number = [=](int x, int y, int z) { return (z * (ny + 1) + y) * (nx + 1) + x; };
  const int layers = kind == Kind::hexahedra ? nz : (nz + 1) / 2;
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        result->hexahedra.push_back({number(x, y, z), number(x + 1, y, z), number(x + 1, y + 1, z),
                                     number(x, y + 1, z), number(x, y, z + 1),
                                     number(x + 1, y, z + 1), number(x + 1, y + 1, z + 1),
                                     number(x, y + 1, z + 1)});
      }
    }
  }
  // There are six tetrahedra per cell, cell by cell from below.
  result->tetrahedra.erase(result->tetrahedra.begin(),
                           result->tetrahedra.begin() + 6 * nx * ny * layers);
  return result;
}

inline FemModelSettings settings_of(const mesh::Mesh& mesh, const material::Hyperelastic& law) {
  FemModelSettings settings;
  settings.regions.push_back({.constants = {}, .density = 1070.0, .hyperelastic = law});
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

/// Assigns elements in turn to two rubbers and, for tetrahedra, a corotational material (if
/// quadratic, a third rubber).
inline FemModelSettings mixed_settings(const mesh::Mesh& mesh) {
  FemModelSettings settings;
  settings.regions = {{.constants = {}, .density = 1000.0, .hyperelastic = rubber()},
                      {.constants = {}, .density = 1100.0, .hyperelastic = soft_rubber()},
                      {.constants = {2e5, 0.4}, .density = 900.0}};
  if (!mesh.quadratic.empty()) settings.regions[2].hyperelastic = material::neo_hookean(3e4);
  if (!mesh.quadratic.empty()) settings.regions[2].hyperelastic->bulk_modulus = 4e5;
  const auto tetrahedra = static_cast<NodeId>(mesh.tetrahedra.size());
  for (NodeId e = 0; e < tetrahedra + static_cast<NodeId>(mesh.hexahedra.size()); ++e) {
    settings.regions[static_cast<std::size_t>(e < tetrahedra ? e % 3 : e % 2)].elements.push_back(
        e);
  }
  std::erase_if(settings.regions,
                [](const MaterialRegion& region) { return region.elements.empty(); });
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

/// As above, or for patches two rubbers in separate parts.
inline FemModelSettings mixed_settings(Kind kind, const mesh::Mesh& mesh) {
  FemModelSettings settings = mixed_settings(mesh);
  if (kind != Kind::patches) return settings;
  settings.regions.pop_back();
  for (MaterialRegion& region : settings.regions) {
    region.elements.clear();
    region.patches = true;
  }
  const auto count = static_cast<NodeId>(mesh.tetrahedra.size());
  for (NodeId e = 0; e < count; ++e) {
    settings.regions[e < count / 3 ? 0 : 1].elements.push_back(e);
  }
  return settings;
}

inline FemModelSettings settings_of(Kind kind, const mesh::Mesh& mesh,
                                    const material::Hyperelastic& law) {
  FemModelSettings settings = settings_of(mesh, law);
  settings.regions.front().patches = kind == Kind::patches;
  return settings;
}

struct Body {
  Body(std::shared_ptr<const mesh::Mesh> mesh, const FemModelSettings& settings, int threads = 1)
      : model(std::make_shared<const FemModel>(std::move(mesh), settings)),
        pool(threads),
        assembly(model, pool) {}

  double energy(const Points& x) {
    assembly.evaluate(x, {.tangent = Tangent::none});
    return assembly.strain_energy();
  }
  VectorX forces(const Points& x) {
    assembly.evaluate(x, {.tangent = Tangent::none});
    return Eigen::Map<const VectorX>(assembly.forces().data(), 3 * model->free_count());
  }
  MatrixX matrix(const Points& x, Tangent tangent) {
    assembly.evaluate(x, {.tangent = tangent});
    return dense_matrix(assembly);
  }
  /// Returns x with its free coordinate k changed by `step`.
  Points stepped(Points x, Eigen::Index k, double step) const {
    x(model->free_nodes()[static_cast<std::size_t>(k / 3)], k % 3) += step;
    return x;
  }

  std::shared_ptr<const FemModel> model;
  ThreadPool pool;
  Assembly assembly;
};

}  // namespace sinew::fem::solid_bodies
