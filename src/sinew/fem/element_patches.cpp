#include "sinew/fem/element_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "sinew/fem/solid_kernel.hpp"
#include "sinew/fem/transpose.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::fem {

namespace {

// Score of a tetrahedron: new nodes, minus faces in the patch, minus faces in any patch, number.
using Score = std::tuple<int, int, int, std::int32_t>;

/// Grows patches one element at a time.
class Grouping {
 public:
  Grouping(const mesh::Mesh& mesh, const std::vector<std::int32_t>& elements)
      : mesh_(mesh),
        patch_(mesh.tetrahedra.size(), kOutside),
        neighbours_(mesh.tetrahedra.size(), {-1, -1, -1, -1}) {
    for (const std::int32_t e : elements) patch_[index(e)] = kFree;
    const std::vector<mesh::FaceUse> uses = mesh::face_uses(mesh);
    for (std::size_t k = 1; k < uses.size(); ++k) {
      if (uses[k].key != uses[k - 1].key) continue;
      join(uses[k].tetrahedron, uses[k - 1].tetrahedron);
      join(uses[k - 1].tetrahedron, uses[k].tetrahedron);
    }
  }

  /// Members of each patch, in the order in which patches were begun.
  std::vector<std::vector<std::int32_t>> run(const std::vector<std::int32_t>& elements) {
    for (const std::int32_t seed : elements) {
      if (patch_[index(seed)] == kFree) grow(seed);
    }
    dissolve_small(elements);
    std::vector<std::vector<std::int32_t>> members(sizes_.size());
    for (const std::int32_t e : elements) members[index(patch_[index(e)])].push_back(e);
    std::erase_if(members, [](const auto& own) { return own.empty(); });
    return members;
  }

 private:
  static constexpr std::int32_t kOutside = -2;  // of another region
  static constexpr std::int32_t kFree = -1;

  static std::size_t index(std::int32_t value) { return static_cast<std::size_t>(value); }

  void join(std::int32_t element, std::int32_t other) {
    auto& own = neighbours_[index(element)];
    *std::ranges::find(own, -1) = other;
  }

  void grow(std::int32_t seed) {
    const auto patch = static_cast<std::int32_t>(sizes_.size());
    std::vector<std::int32_t> members;
    std::vector<NodeId> nodes;
    for (std::int32_t next = seed; next >= 0; next = best_neighbour(members, nodes)) {
      members.push_back(next);
      patch_[index(next)] = patch;
      for (const NodeId node : mesh_.tetrahedra[index(next)]) {
        if (std::ranges::find(nodes, node) == nodes.end()) nodes.push_back(node);
      }
      if (static_cast<int>(members.size()) == kPatchSize) break;
    }
    sizes_.push_back(static_cast<int>(members.size()));
  }

  /// The free neighbour with the fewest new nodes; of equal ones, that with most faces in the
  /// patch, then that with most faces in any patch, which would otherwise be left alone.
  std::int32_t best_neighbour(const std::vector<std::int32_t>& members,
                              const std::vector<NodeId>& nodes) const {
    Score best{5, 0, 0, -1};
    for (const std::int32_t member : members) {
      for (const std::int32_t e : neighbours_[index(member)]) {
        if (e < 0 || patch_[index(e)] != kFree) continue;
        int unknown = 0, faces = 0, taken = 0;
        for (const NodeId node : mesh_.tetrahedra[index(e)]) {
          unknown += std::ranges::find(nodes, node) == nodes.end() ? 1 : 0;
        }
        for (const std::int32_t other : neighbours_[index(e)]) {
          if (other < 0) continue;
          taken += patch_[index(other)] >= 0 ? 1 : 0;
          faces += patch_[index(other)] == patch_[index(member)] ? 1 : 0;
        }
        best = std::min(best, Score{unknown, -faces, -taken, e});
      }
    }
    return std::get<3>(best);
  }

  /// Moves the members of small patches to a neighbouring patch, since a patch of a few elements
  /// would lock.
  void dissolve_small(const std::vector<std::int32_t>& elements) {
    constexpr int kSmall = kPatchSize / 3;
    for (const std::int32_t e : elements) {
      const std::int32_t own = patch_[index(e)];
      if (sizes_[index(own)] > kSmall) continue;
      std::int32_t to = -1;
      for (const std::int32_t other : neighbours_[index(e)]) {
        if (other < 0 || patch_[index(other)] < 0) continue;
        const std::int32_t at = patch_[index(other)];
        if (sizes_[index(at)] <= kSmall) continue;
        if (to < 0 || sizes_[index(at)] < sizes_[index(to)]) to = at;
      }
      if (to < 0) continue;
      --sizes_[index(own)];
      ++sizes_[index(to)];
      patch_[index(e)] = to;
    }
  }

  const mesh::Mesh& mesh_;
  std::vector<std::int32_t> patch_;
  std::vector<std::array<std::int32_t, 4>> neighbours_;
  std::vector<int> sizes_;
};

}  // namespace

std::vector<std::int32_t> group_elements(const mesh::Mesh& mesh,
                                         std::vector<std::int32_t>& elements) {
  const auto members = Grouping(mesh, elements).run(elements);
  std::vector<std::int32_t> first{0};
  elements.clear();
  for (const auto& own : members) {
    elements.insert(elements.end(), own.begin(), own.end());
    first.push_back(static_cast<std::int32_t>(elements.size()));
  }
  return first;
}

void make_patches(SolidGroup& group, std::vector<std::int32_t> first_slot) {
  ElementPatches& patches = group.patches;
  patches.first_slot = std::move(first_slot);
  const std::size_t count = patches.first_slot.size() - 1;
  patches.of_slot.assign(group.element.size(), static_cast<std::int32_t>(count) - 1);
  patches.volume.assign(count, 0.0);
  patches.first_row = {0};
  patches.first_part = {0};
  for (std::size_t p = 0; p < count; ++p) {
    std::vector<std::pair<NodeId, std::uint32_t>> uses;
    for (std::int32_t s = patches.first_slot[p]; s < patches.first_slot[p + 1]; ++s) {
      const auto slot = static_cast<std::size_t>(s);
      patches.of_slot[slot] = static_cast<std::int32_t>(p);
      patches.volume[p] += group.weight(slot, 0);
      for (std::size_t a = 0; a < 4; ++a) {
        uses.emplace_back(group.node_of(slot, a), static_cast<std::uint32_t>(4 * slot + a));
      }
    }
    std::ranges::sort(uses);
    for (std::size_t k = 0; k < uses.size(); ++k) {
      if (k == 0 || uses[k].first != uses[k - 1].first) {
        if (k > 0) patches.first_part.push_back(static_cast<std::int32_t>(patches.part.size()));
        patches.row_node.push_back(uses[k].first);
      }
      patches.part.push_back(uses[k].second);
    }
    patches.first_part.push_back(static_cast<std::int32_t>(patches.part.size()));
    patches.first_row.push_back(patches.rows());
  }
}

double own_bulk_modulus(const SolidGroup& group) {
  const material::Hyperelastic& law = group.law;
  if (law.saint_venant_shear != 0.0 || group.nodes == 8) return 0.0;
  if (group.nodes == 4 && group.patches.empty()) return law.bulk_modulus;
  const double share = group.nodes == 4 ? kPatchShare : kQuadraticShare;
  return std::min(law.bulk_modulus, share * law.shear_modulus());
}

void average_ratios(const SolidGroup& group, int begin, int end, std::span<const double> ratios,
                    std::span<double> result) {
  const ElementPatches& patches = group.patches;
  for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
    double sum = 0.0;
    for (std::int32_t s = patches.first_slot[p]; s < patches.first_slot[p + 1]; ++s) {
      const auto slot = static_cast<std::size_t>(s);
      sum += group.weight(slot, 0) * ratios[slot];
    }
    result[p] = sum / patches.volume[p];
  }
}

void sum_rows(const SolidGroup& group, int begin, int end, const double* spread, double* result) {
  const ElementPatches& patches = group.patches;
  const double modulus = group.law.bulk_modulus - own_bulk_modulus(group);
  for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
    const double scale = std::sqrt(modulus / patches.volume[p]);
    for (std::int32_t r = patches.first_row[p]; r < patches.first_row[p + 1]; ++r) {
      const auto row = static_cast<std::size_t>(r);
      Quad sum = {};
      for (std::int32_t k = patches.first_part[row]; k < patches.first_part[row + 1]; ++k) {
        sum += load_quad(spread + std::size_t{4} * patches.part[static_cast<std::size_t>(k)]);
      }
      store_quad(result + 4 * row, scale * sum);
    }
  }
}

std::vector<double> patch_ratios(const SolidGroup& group, const double* points) {
  std::vector<double> result(group.patches.volume.size());
  if (result.empty()) return result;
  std::vector<double> ratios(group.element.size());
  volume_ratios(group, 0, group.batches(), points, ratios.data());
  average_ratios(group, 0, group.patches.count(), ratios, result);
  return result;
}

}  // namespace sinew::fem
