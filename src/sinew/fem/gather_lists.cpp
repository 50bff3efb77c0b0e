#include "sinew/fem/gather_lists.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;

struct Part {
  std::int32_t visit;  // block visit
  std::uint32_t code;
  double ratio;
  double stiffness;  // V mu g_a . g_b
};

/// The order in which columns and their blocks are visited.
struct BlockVisits {
  const linalg::BlockPattern& pattern;
  std::vector<std::int32_t> visit;  // column -> visit
  const std::vector<std::int32_t>& block_visit;

  BlockVisits(const linalg::BlockPattern& blocks, std::span<const NodeId> free_index,
              std::span<const std::int32_t> rank, GatherLists& lists)
      : pattern(blocks),
        visit(static_cast<std::size_t>(blocks.nodes)),
        block_visit(lists.block_visit) {
    std::vector<std::int32_t> free_at(rank.size(), -1);  // rank -> free number
    for (std::size_t node = 0; node < rank.size(); ++node) {
      free_at[static_cast<std::size_t>(rank[node])] = free_index[node];
    }
    std::int32_t next = 0;
    for (const std::int32_t free : free_at) {
      if (free < 0) continue;
      const auto j = static_cast<std::size_t>(free);
      visit[j] = static_cast<std::int32_t>(lists.column.size());
      lists.column.push_back(free);
      lists.block_visit.push_back(next);
      next += pattern.column_start[j + 1] - pattern.column_start[j];
    }
    lists.block_visit.push_back(next);
  }

  /// Visit of block (i, j), i >= j.
  std::int32_t of(NodeId i, NodeId j) const {
    const auto column = static_cast<std::size_t>(j);
    return block_visit[static_cast<std::size_t>(visit[column])] + pattern.find(i, j) -
           pattern.column_start[column];
  }
};

std::array<NodeId, 4> free_nodes_of(const ElementBatches& elements, std::size_t slot,
                                    std::span<const NodeId> free_index) {
  std::array<NodeId, 4> result{};
  const std::size_t first = 4 * kLanes * (slot / kLanes) + slot % kLanes;
  for (std::size_t a = 0; a < 4; ++a) {
    result[a] = free_index[static_cast<std::size_t>(elements.nodes[first + kLanes * a])];
  }
  return result;
}

Vector3 gradient(const BatchConstants& batch, std::size_t lane, std::size_t a) {
  Vector3 g;
  for (int c = 0; c < 3; ++c) {
    const auto of = [&](int k) { return batch.gradient[k][c].value[lane]; };
    g[c] = a == 0 ? -(of(0) + of(1) + of(2)) : of(static_cast<int>(a) - 1);
  }
  return g;
}

/// Appends the blocks in the lower triangle to which a slot contributes.
void append_parts(const ElementBatches& elements, std::span<const MaterialRegion> regions,
                  std::size_t slot, const std::array<NodeId, 4>& free, const BlockVisits& visits,
                  std::vector<Part>& parts) {
  const BatchConstants& batch = elements.constants[slot / kLanes];
  const std::size_t lane = slot % kLanes;
  const material::ElasticConstants& constants =
      regions[static_cast<std::size_t>(elements.region[slot])].constants;
  const double scale = batch.volume.value[lane] * batch.mu.value[lane];
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      if (free[b] < 0 || free[a] < free[b]) continue;
      const auto code = static_cast<std::uint32_t>(16 * slot + 4 * a + b);
      parts.push_back({visits.of(free[a], free[b]), code,
                       constants.first_lame() / constants.shear_modulus(),
                       scale * gradient(batch, lane, a).dot(gradient(batch, lane, b))});
    }
  }
}

/// Sorts parts by block, and within a block by `before`. A block has few parts, so a counting sort
/// followed by small sorts costs less than one sort of all parts.
template <class P>
void sort_by_block(std::vector<P>& parts, int blocks, auto&& before) {
  std::vector<std::size_t> start(static_cast<std::size_t>(blocks) + 1, 0);
  for (const P& part : parts) ++start[static_cast<std::size_t>(part.visit) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<P> sorted(parts.size());
  std::vector<std::size_t> cursor = start;
  for (const P& part : parts) sorted[cursor[static_cast<std::size_t>(part.visit)]++] = part;
  for (std::size_t block = 0; block < cursor.size() - 1; ++block) {
    std::ranges::sort(sorted.begin() + static_cast<std::ptrdiff_t>(start[block]),
                      sorted.begin() + static_cast<std::ptrdiff_t>(start[block + 1]), before);
  }
  parts.swap(sorted);
}

void write_blocks(std::vector<Part>& parts, int blocks, GatherLists& lists) {
  sort_by_block(parts, blocks, [](const Part& p, const Part& q) {
    return p.ratio != q.ratio ? p.ratio < q.ratio : p.code < q.code;
  });
  lists.contributions.reserve(parts.size());
  lists.diagonal_stiffness.assign(static_cast<std::size_t>(blocks), 0.0);
  std::size_t next = 0;
  for (int block = 0; block < blocks; ++block) {
    lists.run_start.push_back(static_cast<std::int32_t>(lists.runs.size()));
    lists.contribution_start.push_back(static_cast<std::int32_t>(next));
    for (bool first = true; next < parts.size() && parts[next].visit == block; first = false) {
      const Part& part = parts[next++];
      if (first || lists.runs.back().ratio != part.ratio) lists.runs.push_back({0, part.ratio});
      lists.contributions.push_back(part.code);
      lists.runs.back().end = static_cast<std::int32_t>(next);
      lists.diagonal_stiffness[static_cast<std::size_t>(block)] += part.stiffness;
    }
  }
  lists.run_start.push_back(static_cast<std::int32_t>(lists.runs.size()));
  lists.contribution_start.push_back(static_cast<std::int32_t>(next));
}

/// A nodal force in a force record.
struct ForcePart {
  NodeId node;  // free number
  std::uint32_t code;
};

void write_forces(const std::vector<ForcePart>& parts, const BlockVisits& visits,
                  GatherLists& lists) {
  lists.force_start.assign(visits.visit.size() + 1, 0);
  const auto visit = [&](NodeId node) {
    return static_cast<std::size_t>(visits.visit[static_cast<std::size_t>(node)]);
  };
  for (const ForcePart& part : parts) ++lists.force_start[visit(part.node) + 1];
  std::partial_sum(lists.force_start.begin(), lists.force_start.end(), lists.force_start.begin());
  lists.force_parts.resize(parts.size());
  std::vector<std::int32_t> cursor = lists.force_start;
  for (const ForcePart& part : parts) {
    const auto place = cursor[visit(part.node)]++;
    lists.force_parts[static_cast<std::size_t>(place)] = part.code;
  }
}

/// A contribution of a block in the record of a solid element to a block of the matrix.
struct SolidPart {
  std::int32_t visit;
  std::uint32_t code;
};

/// A contribution of a product of two patch rows to a block of the matrix.
struct PatchPart {
  std::int32_t visit;
  std::array<std::uint32_t, 2> rows;
};

void append_patches(const ElementPatches& patches, std::span<const NodeId> free_index,
                    const BlockVisits& visits, std::vector<PatchPart>& parts) {
  const auto free = [&](std::int32_t row) {
    return free_index[static_cast<std::size_t>(patches.row_node[static_cast<std::size_t>(row)])];
  };
  const auto number = [&](std::int32_t row) {
    return static_cast<std::uint32_t>(patches.rows_before + row);
  };
  for (std::size_t p = 0; p < patches.volume.size(); ++p) {
    for (std::int32_t i = patches.first_row[p]; i < patches.first_row[p + 1]; ++i) {
      for (std::int32_t j = patches.first_row[p]; j < patches.first_row[p + 1]; ++j) {
        if (free(j) < 0 || free(i) < free(j)) continue;
        parts.push_back({visits.of(free(i), free(j)), {number(i), number(j)}});
      }
    }
  }
}

void write_patches(std::vector<PatchPart>& parts, int blocks, GatherLists& lists) {
  if (parts.empty()) return;
  sort_by_block(parts, blocks,
                [](const PatchPart& p, const PatchPart& q) { return p.rows < q.rows; });
  lists.patch_start.assign(static_cast<std::size_t>(blocks) + 1, 0);
  lists.patch_pairs.reserve(parts.size());
  for (const PatchPart& part : parts) {
    ++lists.patch_start[static_cast<std::size_t>(part.visit) + 1];
    lists.patch_pairs.push_back(part.rows);
  }
  std::partial_sum(lists.patch_start.begin(), lists.patch_start.end(), lists.patch_start.begin());
}

void append_solids(const SolidGroup& group, std::span<const NodeId> free_index,
                   const BlockVisits& visits, std::vector<SolidPart>& blocks,
                   std::vector<ForcePart>& forces) {
  const auto nodes = static_cast<std::size_t>(group.nodes);
  std::vector<NodeId> free(nodes);
  for (std::size_t slot = 0; slot < group.element.size(); ++slot) {
    if (group.element[slot] < 0) continue;
    for (std::size_t a = 0; a < nodes; ++a) {
      free[a] = free_index[static_cast<std::size_t>(group.node_of(slot, a))];
    }
    const auto force = static_cast<std::size_t>(group.first_force) + nodes * slot;
    const auto block = static_cast<std::size_t>(group.first_block) +
                       static_cast<std::size_t>(group.pairs()) * slot;
    for (std::size_t a = 0; a < nodes; ++a) {
      if (free[a] < 0) continue;
      forces.push_back({free[a], static_cast<std::uint32_t>(force + a)});
      for (std::size_t b = 0; b < nodes; ++b) {
        if (free[b] < 0 || free[a] < free[b]) continue;
        const bool transposed = a > b;  // the record contains (low, high)
        const int pair =
            SolidGroup::pair(static_cast<int>(std::min(a, b)), static_cast<int>(std::max(a, b)));
        const std::size_t code =
            2 * (block + static_cast<std::size_t>(pair)) + (transposed ? 1 : 0);
        blocks.push_back({visits.of(free[a], free[b]), static_cast<std::uint32_t>(code)});
      }
    }
  }
}

void write_solids(std::vector<SolidPart>& parts, int blocks, GatherLists& lists) {
  if (parts.empty()) return;
  sort_by_block(parts, blocks,
                [](const SolidPart& p, const SolidPart& q) { return p.code < q.code; });
  lists.solid_start.assign(static_cast<std::size_t>(blocks) + 1, 0);
  lists.solid_parts.reserve(parts.size());
  for (const SolidPart& part : parts) {
    ++lists.solid_start[static_cast<std::size_t>(part.visit) + 1];
    lists.solid_parts.push_back(part.code);
  }
  std::partial_sum(lists.solid_start.begin(), lists.solid_start.end(), lists.solid_start.begin());
}

}  // namespace

GatherLists make_gather_lists(const ElementBatches& elements, std::span<const SolidGroup> solids,
                              std::span<const MaterialRegion> regions,
                              std::span<const NodeId> free_index,
                              std::span<const std::int32_t> rank,
                              const linalg::BlockPattern& pattern) {
  const std::size_t slots = elements.tetrahedron.size();
  std::size_t blocks = 0;
  for (const SolidGroup& group : solids) {
    blocks = static_cast<std::size_t>(group.first_block) +
             group.element.size() * static_cast<std::size_t>(group.pairs());
  }
  // 16 s + 4 a + b and 2 block + 1 must fit 32 bits unsigned, and counts of contributions 31 bits
  if (slots > (std::size_t{1} << 27) || blocks > (std::size_t{1} << 30)) {
    throw Error(ErrorKind::size_limit, {},
                fmt::format("the mesh has {} tetrahedra and {} blocks of hyperelastic elements",
                            slots, blocks),
                "split it; at most 134 million tetrahedra or a billion blocks fit one body");
  }
  GatherLists lists;
  const BlockVisits visits(pattern, free_index, rank, lists);
  std::vector<Part> parts;
  std::vector<SolidPart> solid_parts;
  std::vector<PatchPart> patch_parts;
  std::vector<ForcePart> forces;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    if (elements.tetrahedron[slot] < 0) continue;
    const auto free = free_nodes_of(elements, slot, free_index);
    append_parts(elements, regions, slot, free, visits, parts);
    for (std::size_t a = 0; a < 4; ++a) {
      if (free[a] >= 0) forces.push_back({free[a], static_cast<std::uint32_t>(4 * slot + a)});
    }
  }
  for (const SolidGroup& group : solids) {
    append_solids(group, free_index, visits, solid_parts, forces);
    append_patches(group.patches, free_index, visits, patch_parts);
  }
  write_blocks(parts, pattern.blocks(), lists);
  write_solids(solid_parts, pattern.blocks(), lists);
  write_patches(patch_parts, pattern.blocks(), lists);
  write_forces(forces, visits, lists);
  return lists;
}

}  // namespace sinew::fem
