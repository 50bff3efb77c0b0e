#include "sinew/fem/element_batches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;

/// Edge vectors x_a - x_0 as columns, a = 1..3.
Matrix3 edges(const mesh::Mesh& mesh, int tetrahedron) {
  const mesh::Tetrahedron& nodes = mesh.tetrahedra[static_cast<std::size_t>(tetrahedron)];
  Matrix3 result;
  for (int a = 0; a < 3; ++a) {
    result.col(a) =
        (mesh.nodes.row(nodes[static_cast<std::size_t>(a) + 1]) - mesh.nodes.row(nodes[0]))
            .transpose();
  }
  return result;
}

void check_volume(const mesh::Mesh& mesh, int tetrahedron, const Matrix3& edge) {
  const double volume = edge.determinant() / 6.0;
  const double size = edge.cwiseAbs().maxCoeff();
  const bool flat = !(std::abs(volume) > 1e-14 * size * size * size);
  if (!flat && volume > 0.0) return;
  throw Error(flat ? ErrorKind::zero_volume : ErrorKind::inverted_element,
              {.file = mesh.name, .item = {}},
              fmt::format("tetrahedron {} has a volume of {:.4g} m^3", tetrahedron, volume),
              flat ? "remove or remesh it" : "swap two of its nodes");
}

/// Tetrahedra in the order of slots; each law is padded with -1 to whole batches.
std::vector<std::int32_t> slot_order(const mesh::Mesh& mesh,
                                     std::span<const MaterialRegion> regions,
                                     std::span<const std::int32_t> region_of,
                                     std::span<const double> weights,
                                     std::span<const std::int32_t> rank) {
  std::vector<std::int32_t> order;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const MaterialRegion& region = regions[static_cast<std::size_t>(region_of[t])];
    if (!region.hyperelastic && weights[t] != 0.0) order.push_back(static_cast<std::int32_t>(t));
  }
  const auto lowest = [&](std::int32_t t) {
    std::int32_t result = std::numeric_limits<std::int32_t>::max();
    for (const NodeId node : mesh.tetrahedra[static_cast<std::size_t>(t)]) {
      result = std::min(result, rank[static_cast<std::size_t>(node)]);
    }
    return result;
  };
  const auto law = [&](std::int32_t t) {
    return regions[static_cast<std::size_t>(region_of[static_cast<std::size_t>(t)])].law;
  };
  std::ranges::stable_sort(order, [&](std::int32_t s, std::int32_t t) {
    return law(s) != law(t) ? law(s) < law(t) : lowest(s) < lowest(t);
  });
  std::vector<std::int32_t> slots;
  slots.reserve(order.size() + 2 * kLanes);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool new_law = k > 0 && law(order[k]) != law(order[k - 1]);
    while (new_law && slots.size() % kLanes != 0) slots.push_back(-1);
    slots.push_back(order[k]);
  }
  while (slots.size() % kLanes != 0) slots.push_back(-1);
  return slots;
}

void set_lane(BatchConstants& batch, std::size_t lane, const Matrix3& edge,
              const MaterialRegion& region, double weight) {
  const Matrix3 inverse = edge.inverse();  // row a - 1 is g_a
  for (int a = 0; a < 3; ++a) {
    for (int c = 0; c < 3; ++c) batch.gradient[a][c].value[lane] = inverse(a, c);
  }
  const double volume = weight * (edge.determinant() / 6.0);
  batch.volume.value[lane] = volume;
  batch.mu.value[lane] = region.constants.shear_modulus();
  batch.lambda.value[lane] = region.constants.first_lame();
  batch.root.value[lane] = std::sqrt(volume * region.constants.shear_modulus());
}

}  // namespace

ElementBatches make_element_batches(const mesh::Mesh& mesh, std::span<const MaterialRegion> regions,
                                    std::span<const std::int32_t> region_of,
                                    std::span<const double> weights,
                                    std::span<const std::int32_t> rank) {
  ElementBatches result;
  result.tetrahedron = slot_order(mesh, regions, region_of, weights, rank);
  const std::size_t slots = result.tetrahedron.size();
  result.constants.resize(slots / kLanes);
  result.nodes.resize(4 * slots);
  result.region.resize(slots);
  std::int32_t last = 0;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const bool filling = result.tetrahedron[slot] < 0;
    if (!filling) last = result.tetrahedron[slot];
    const std::size_t batch = slot / kLanes, lane = slot % kLanes;
    const auto element = static_cast<std::size_t>(last);
    const Matrix3 edge = edges(mesh, last);
    if (!filling) check_volume(mesh, last, edge);
    const MaterialRegion& region = regions[static_cast<std::size_t>(region_of[element])];
    result.region[slot] = region_of[element];
    set_lane(result.constants[batch], lane, edge, region, filling ? 0.0 : weights[element]);
    for (std::size_t a = 0; a < 4; ++a) {
      result.nodes[4 * kLanes * batch + kLanes * a + lane] = mesh.tetrahedra[element][a];
    }
    if (region.law == material::Law::linear) result.linear_batches = static_cast<int>(batch) + 1;
  }
  return result;
}

}  // namespace sinew::fem
