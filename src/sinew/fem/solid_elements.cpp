#include "sinew/fem/solid_elements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;

struct PointConstants {
  Eigen::Matrix<double, Eigen::Dynamic, 3> gradients;
  double weight = 0.0;
};

Eigen::Matrix<double, Eigen::Dynamic, 3> rest_nodes(const mesh::Mesh& mesh,
                                                    std::span<const NodeId> nodes) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> x(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    x.row(static_cast<Eigen::Index>(a)) = mesh.nodes.row(nodes[a]);
  }
  return x;
}

/// Maps local gradients (n, 3) at rest positions (n, 3) to spatial gradients, and computes the
/// weight.
PointConstants point_constants(const Eigen::Matrix<double, Eigen::Dynamic, 3>& local,
                               const Eigen::Matrix<double, Eigen::Dynamic, 3>& x, double weight) {
  const Matrix3 jacobian = x.transpose() * local;  // dX/dxi
  return {local * jacobian.inverse(), weight * jacobian.determinant()};
}

std::vector<PointConstants> constants_of(const mesh::Mesh& mesh, std::span<const NodeId> nodes) {
  const auto x = rest_nodes(mesh, nodes);
  if (nodes.size() == 4) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> local(4, 3);
    local << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    return {point_constants(local, x, 1.0 / 6.0)};
  }
  std::vector<PointConstants> result;
  if (nodes.size() == 10) {
    for (const auto& point : mesh::quadratic_points()) {
      result.push_back(point_constants(mesh::quadratic_gradients(point), x, 1.0 / 24.0));
    }
    return result;
  }
  for (const Vector3& point : mesh::hexahedron_points()) {
    result.push_back(point_constants(mesh::hexahedron_gradients(point), x, 1.0));
  }
  return result;
}

void check_volumes(const mesh::Mesh& mesh, int element, std::span<const PointConstants> points) {
  const ElementList list(mesh);
  const auto x = rest_nodes(mesh, list.nodes(element));
  const double size = (x.colwise().maxCoeff() - x.colwise().minCoeff()).maxCoeff();
  for (const PointConstants& point : points) {
    const bool flat = !(std::abs(point.weight) > 1e-14 * size * size * size);
    if (!flat && point.weight > 0.0) continue;
    throw Error(flat ? ErrorKind::zero_volume : ErrorKind::inverted_element,
                {.file = mesh.name, .item = {}},
                fmt::format("{} has a volume of {:g} m^3 at a point of integration",
                            list.name(element), point.weight),
                flat ? "remove or remesh it" : "check the order of its nodes, or remesh it");
  }
}

/// Elements by (kind, region), each list in spatial order.
std::map<std::pair<std::size_t, std::int32_t>, std::vector<std::int32_t>> sorted_elements(
    const mesh::Mesh& mesh, std::span<const MaterialRegion> regions,
    std::span<const std::int32_t> region_of, std::span<const std::int32_t> rank) {
  const ElementList list(mesh);
  std::map<std::pair<std::size_t, std::int32_t>, std::vector<std::int32_t>> result;
  for (int e = 0; e < list.count(); ++e) {
    const std::int32_t region = region_of[static_cast<std::size_t>(e)];
    if (!regions[static_cast<std::size_t>(region)].hyperelastic) continue;
    result[{list.nodes(e).size(), region}].push_back(e);
  }
  const auto lowest = [&](std::int32_t element) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    for (const NodeId node : list.nodes(element)) {
      least = std::min(least, rank[static_cast<std::size_t>(node)]);
    }
    return least;
  };
  for (auto& [kind, elements] : result) {
    std::ranges::stable_sort(elements, {}, lowest);
  }
  return result;
}

/// Leaves out what is not sampled. @param elements in the order of slots. @param first_slot where
/// each patch begins in it; empty without patches.
void keep_sampled(const mesh::Mesh& mesh, std::span<const double> weights,
                  std::vector<std::int32_t>& elements, std::vector<std::int32_t>& first_slot) {
  const auto weight = [&](std::int32_t e) { return weights[static_cast<std::size_t>(e)]; };
  std::vector<std::int32_t> kept_first{0};
  std::int32_t kept = 0;
  for (std::size_t p = 0; p + 1 < first_slot.size(); ++p) {
    const std::int32_t begin = first_slot[p], end = first_slot[p + 1];
    const std::int32_t first = elements[static_cast<std::size_t>(begin)];
    for (std::int32_t s = begin; s < end; ++s) {
      const std::int32_t e = elements[static_cast<std::size_t>(s)];
      if (weight(e) == weight(first)) continue;
      const ElementList list(mesh);
      throw Error(ErrorKind::bad_argument, {.file = mesh.name, .item = "sample"},
                  fmt::format("{} and {} share a patch, and have the weights {:g} and {:g}",
                              list.name(first), list.name(e), weight(first), weight(e)),
                  "sample whole patches, with one weight each");
    }
    if (weight(first) == 0.0) continue;
    kept += end - begin;
    kept_first.push_back(kept);
  }
  if (!first_slot.empty()) first_slot = std::move(kept_first);
  std::erase_if(elements, [&](std::int32_t e) { return weight(e) == 0.0; });
}

void fill_group(SolidGroup& group, const mesh::Mesh& mesh, std::span<const double> weights,
                const std::vector<std::int32_t>& elements) {
  const ElementList list(mesh);
  const std::size_t slots = (elements.size() + kLanes - 1) / kLanes * kLanes;
  const auto nodes = static_cast<std::size_t>(group.nodes);
  const auto rows = static_cast<std::size_t>(group.rows_per_point());
  group.element.assign(slots, -1);
  group.node.resize(nodes * slots);
  group.constants.resize(slots / kLanes * static_cast<std::size_t>(group.points) * rows);
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const bool filling = slot >= elements.size();
    const std::int32_t element = filling ? elements.back() : elements[slot];
    if (!filling) group.element[slot] = element;
    const std::size_t batch = slot / kLanes, lane = slot % kLanes;
    const auto members = list.nodes(element);
    for (std::size_t a = 0; a < nodes; ++a) {
      group.node[(batch * nodes + a) * kLanes + lane] = members[a];
    }
    const std::vector<PointConstants> points = constants_of(mesh, members);
    if (!filling) check_volumes(mesh, element, points);
    for (std::size_t q = 0; q < points.size(); ++q) {
      LaneRow* row = &group.constants[(batch * points.size() + q) * rows];
      for (std::size_t k = 0; k < 3 * nodes; ++k) {
        row[k].value[lane] =
            points[q].gradients(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
      }
      row[3 * nodes].value[lane] =
          filling ? 0.0 : weights[static_cast<std::size_t>(element)] * points[q].weight;
    }
  }
}

}  // namespace

std::string ElementList::name(int element) const {
  if (is_tetrahedron(element)) return fmt::format("tetrahedron {}", element);
  return fmt::format("hexahedron {}", element - static_cast<int>(mesh_.tetrahedra.size()));
}

std::vector<SolidGroup> make_solid_groups(const mesh::Mesh& mesh,
                                          std::span<const MaterialRegion> regions,
                                          std::span<const std::int32_t> region_of,
                                          std::span<const double> weights,
                                          std::span<const std::int32_t> rank,
                                          const ElementBatches& batches) {
  std::vector<SolidGroup> groups;
  auto slot = static_cast<std::int64_t>(batches.tetrahedron.size());
  std::int64_t force = 4 * slot, block = 0, patch_slots = 0, patch_count = 0, patch_rows = 0;
  for (const auto& [kind, elements] : sorted_elements(mesh, regions, region_of, rank)) {
    SolidGroup group;
    group.nodes = static_cast<int>(kind.first);
    group.points = kind.first == 8 ? 8 : kind.first == 10 ? 4 : 1;
    group.law = *regions[static_cast<std::size_t>(kind.second)].hyperelastic;
    group.first_slot = slot;
    group.first_force = force;
    group.first_block = block;
    std::vector<std::int32_t> order = elements, first_slot;
    const bool patches = group.nodes == 4 && regions[static_cast<std::size_t>(kind.second)].patches;
    if (patches) first_slot = group_elements(mesh, order);
    keep_sampled(mesh, weights, order, first_slot);
    if (order.empty()) continue;
    fill_group(group, mesh, weights, order);
    if (patches) {
      make_patches(group, std::move(first_slot));
      group.patches.slots_before = patch_slots;
      group.patches.patches_before = patch_count;
      group.patches.rows_before = patch_rows;
      patch_slots += static_cast<std::int64_t>(group.element.size());
      patch_count += group.patches.count();
      patch_rows += group.patches.rows();
    }
    const auto slots = static_cast<std::int64_t>(group.element.size());
    slot += slots;
    force += slots * group.nodes;
    block += slots * group.pairs();
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace sinew::fem
