#include "sinew/fem/mass.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::fem {

namespace {

void check_masses(const FemModelSettings& settings) {
  for (const Region& region : settings.regions) {
    if (std::isfinite(region.density) && region.density >= 0.0) continue;
    throw Error(ErrorKind::out_of_range, {.file = {}, .item = "density"},
                fmt::format("the density is {} kg/m^3", region.density),
                "give a finite value of at least 0, for instance 1070 kg/m^3");
  }
  const double total = settings.total_mass.value_or(1.0);
  if (!(std::isfinite(total) && total > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.file = {}, .item = "mass"},
                fmt::format("the total mass is {} kg", total),
                "give a finite value above 0, for instance 42 g");
  }
}

}  // namespace

std::vector<double> element_masses(const FemModelSettings& settings,
                                   std::span<const std::int32_t> region_of,
                                   std::span<const double> volumes) {
  check_masses(settings);
  std::vector<double> masses(volumes.begin(), volumes.end());
  const bool any_density = std::ranges::any_of(
      settings.regions, [](const Region& region) { return region.density > 0.0; });
  if (any_density || !settings.total_mass) {
    for (std::size_t t = 0; t < masses.size(); ++t) {
      masses[t] *= settings.regions[static_cast<std::size_t>(region_of[t])].density;
    }
  }
  if (settings.total_mass) {
    const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
    for (double& mass : masses) mass *= *settings.total_mass / sum;
  }
  return masses;
}

VectorX lumped_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                      std::span<const double> masses) {
  if (settings.even_mass && !settings.total_mass) {
    throw Error(ErrorKind::conflicting_keys, {.file = {}, .item = "mass"},
                "masses are to be spread evenly over nodes, but there is no total mass",
                "give the total mass");
  }
  if (settings.even_mass && settings.mass == MassMatrix::consistent) {
    throw Error(ErrorKind::conflicting_keys, {.file = {}, .item = "mass"},
                "masses spread evenly over nodes have no consistent matrix",
                "choose the lumped mass matrix");
  }
  VectorX result = VectorX::Zero(mesh.node_count());
  for (std::size_t t = 0; t < masses.size(); ++t) {
    for (const NodeId node : mesh.tetrahedra[t]) {
      if (settings.even_mass) {
        result[node] = 1.0;
      } else {
        result[node] += 0.25 * masses[t];
      }
    }
  }
  if (settings.even_mass) result *= *settings.total_mass / result.sum();
  return result;
}

std::vector<double> consistent_mass_blocks(const mesh::Mesh& mesh,
                                           std::span<const NodeId> free_index,
                                           const linalg::BlockPattern& pattern,
                                           std::span<const double> masses) {
  std::vector<double> result(static_cast<std::size_t>(pattern.blocks()), 0.0);
  for (std::size_t t = 0; t < masses.size(); ++t) {
    for (const NodeId a : mesh.tetrahedra[t]) {
      const NodeId i = free_index[static_cast<std::size_t>(a)];
      for (const NodeId b : mesh.tetrahedra[t]) {
        const NodeId j = free_index[static_cast<std::size_t>(b)];
        if (j < 0 || i < j) continue;
        result[static_cast<std::size_t>(pattern.find(i, j))] += masses[t] * (i == j ? 0.1 : 0.05);
      }
    }
  }
  return result;
}

}  // namespace sinew::fem
