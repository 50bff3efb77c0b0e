#include "sinew/fem/block_gather.hpp"

#include "sinew/fem/element_kernel.hpp"
#include "sinew/fem/transpose.hpp"

namespace sinew::fem {

namespace {

/// A 3x3 block by columns; fourth rows are padding.
struct Block {
  Quad column[3] = {};

  /// += x y^T.
  SINEW_INLINE void add_product(const Quad& x, const double* y) {
    for (int c = 0; c < 3; ++c) column[c] += x * y[c];
  }
  SINEW_INLINE void add(double scale, const Block& other) {
    for (int c = 0; c < 3; ++c) column[c] += scale * other.column[c];
  }
  /// += (trace of other) I: of sum h_a h_b^T, the sum of h_a . h_b.
  SINEW_INLINE void add_trace(const Block& other) {
    const double trace = (other.column[0][0] + other.column[1][1]) + other.column[2][2];
    for (int c = 0; c < 3; ++c) column[c][c] += trace;
  }
  SINEW_INLINE void add_transposed(const Block& other) {
    const Quad &c0 = other.column[0], &c1 = other.column[1], &c2 = other.column[2], zero = {};
    const Quad even = __builtin_shufflevector(c0, c1, 0, 4, 2, 6);
    const Quad odd = __builtin_shufflevector(c0, c1, 1, 5, 3, 7);
    const Quad even2 = __builtin_shufflevector(c2, zero, 0, 4, 2, 6);
    const Quad odd2 = __builtin_shufflevector(c2, zero, 1, 5, 3, 7);
    column[0] += __builtin_shufflevector(even, even2, 0, 1, 4, 5);
    column[1] += __builtin_shufflevector(odd, odd2, 0, 1, 4, 5);
    column[2] += __builtin_shufflevector(even, even2, 2, 3, 6, 7);
  }
  /// target = scale * this + diagonal I, padding 0.
  SINEW_INLINE void store(double scale, double diagonal, double* target) const {
    const Quad unit[3] = {{diagonal, 0, 0, 0}, {0, diagonal, 0, 0}, {0, 0, diagonal, 0}};
    for (int c = 0; c < 3; ++c) {
      store_quad(target + 4 * c, without_padding(scale * column[c]) + unit[c]);
    }
  }
};

/// += h_a h_b^T of the contribution `code` of an element with this record.
SINEW_INLINE void add_outer_product(const double* record, std::uint32_t code, Block& sum) {
  sum.add_product(load_quad(record + (code & 12)), record + 4 * (code & 3));
}

/// += (kappa/mu) ((h_a . p_b) G - p_b p_a^T), in two sums that do not wait for each other.
SINEW_INLINE void add_rotation_terms(const double* record, std::uint32_t code, Block& sum,
                                     Block& other) {
  const double pair = record[kPairPosition[code & 15]];
  const Quad p = load_quad(record + kStretchedPosition + 4 * (code & 3)) * record[kKappaPosition];
  sum.add_product(p, record + kStretchedPosition + (code & 12));
  for (int c = 0; c < 3; ++c) {
    other.column[c] += pair * load_quad(record + kColumnsPosition + 4 * c);
  }
}

/// K without its constant diagonal part, which K of Tangent::rates does not have. One loop over
/// contributions forms all of its terms: blocks have few, and the ends of loops are mispredicted.
template <Tangent tangent>
SINEW_INLINE Block gather_block(const GatherLists& lists, std::size_t visit,
                                const double* records) {
  constexpr std::size_t kRecord = tangent == Tangent::exact ? kExactRecord : kCorotatedRecord;
  std::int32_t k = lists.contribution_start[visit];
  Block result;
  Block turning, stretching;
  for (std::int32_t r = lists.run_start[visit]; r < lists.run_start[visit + 1]; ++r) {
    const ContributionRun& run = lists.runs[static_cast<std::size_t>(r)];
    Block products;
    for (; k < run.end; ++k) {
      const std::uint32_t code = lists.contributions[static_cast<std::size_t>(k)];
      const double* const record = records + kRecord * (code >> 4);
      add_outer_product(record, code, products);
      if constexpr (tangent == Tangent::exact)
        add_rotation_terms(record, code, turning, stretching);
    }
    result.add(run.ratio, products);
    if constexpr (tangent != Tangent::exact) result.add_transposed(products);
    if constexpr (tangent == Tangent::rates) result.add_trace(products);
  }
  if constexpr (tangent == Tangent::exact) {
    result.add(1.0, turning);
    result.add(1.0, stretching);
  }
  return result;
}

/// Adds the blocks of hyperelastic elements.
SINEW_INLINE void add_solids(const GatherLists& lists, std::size_t visit, const double* solids,
                             Block& sum) {
  for (std::int64_t p = lists.solid_start[visit]; p < lists.solid_start[visit + 1]; ++p) {
    const std::uint32_t code = lists.solid_parts[static_cast<std::size_t>(p)];
    const double* at = solids + std::size_t{kSolidBlock} * (code >> 1);
    Block part;
    for (int c = 0; c < 3; ++c) part.column[c] = load_quad(at + 4 * c);
    if ((code & 1) != 0) {
      sum.add_transposed(part);
    } else {
      sum.add(1.0, part);
    }
  }
}

/// Adds the coupling by the shared dilatation of patches.
SINEW_INLINE void add_patches(const GatherLists& lists, std::size_t visit, const double* rows,
                              Block& sum) {
  for (std::int64_t p = lists.patch_start[visit]; p < lists.patch_start[visit + 1]; ++p) {
    const auto& [first, second] = lists.patch_pairs[static_cast<std::size_t>(p)];
    sum.add_product(load_quad(rows + std::size_t{4} * first), rows + std::size_t{4} * second);
  }
}

template <Tangent tangent>
void gather_columns(const GatherLists& lists, const linalg::BlockPattern& pattern, int begin,
                    int end, const double* records, const double* solids, const double* patch_rows,
                    const AssemblyWeights& weights, const double* node_mass,
                    const double* block_mass, double* matrix) {
  constexpr double kDiagonal =
      tangent == Tangent::exact ? 2.0 : (tangent == Tangent::corotated ? 1.0 : 0.0);
  const double diagonal = weights.stiffness * kDiagonal;
  for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
    const auto j = static_cast<std::size_t>(lists.column[k]);
    const auto first = static_cast<std::size_t>(pattern.column_start[j]);
    const auto last = static_cast<std::size_t>(pattern.column_start[j + 1]);
    auto visit = static_cast<std::size_t>(lists.block_visit[k]);
    for (std::size_t b = first; b < last; ++b, ++visit) {
      double mass = b == first && node_mass != nullptr ? node_mass[j] : 0.0;
      if (block_mass != nullptr) mass = block_mass[b];
      Block block = gather_block<tangent>(lists, visit, records);
      if (solids != nullptr) add_solids(lists, visit, solids, block);
      if (patch_rows != nullptr) add_patches(lists, visit, patch_rows, block);
      block.store(weights.stiffness,
                  diagonal * lists.diagonal_stiffness[visit] + weights.mass * mass,
                  matrix + linalg::kBlockStride * b);
    }
  }
}

}  // namespace

void gather_blocks(const GatherLists& lists, const linalg::BlockPattern& pattern, int begin,
                   int end, const double* records, const double* solids, const double* patch_rows,
                   const AssemblyWeights& weights, const double* node_mass,
                   const double* block_mass, double* matrix) {
  if (weights.tangent == Tangent::exact || weights.tangent == Tangent::projected) {
    gather_columns<Tangent::exact>(lists, pattern, begin, end, records, solids, patch_rows, weights,
                                   node_mass, block_mass, matrix);
  } else if (weights.tangent == Tangent::corotated) {
    gather_columns<Tangent::corotated>(lists, pattern, begin, end, records, solids, patch_rows,
                                       weights, node_mass, block_mass, matrix);
  } else if (weights.tangent == Tangent::rates) {
    gather_columns<Tangent::rates>(lists, pattern, begin, end, records, solids, patch_rows, weights,
                                   node_mass, block_mass, matrix);
  }
}

void gather_forces(const GatherLists& lists, int begin, int end, const double* records,
                   double* forces) {
  for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
    Quad sum = {};
    for (std::int32_t p = lists.force_start[k]; p < lists.force_start[k + 1]; ++p) {
      sum += load_quad(records + std::size_t{4} * lists.force_parts[static_cast<std::size_t>(p)]);
    }
    const auto i = static_cast<std::size_t>(lists.column[k]);
    for (std::size_t c = 0; c < 3; ++c) forces[3 * i + c] = sum[c];
  }
}

}  // namespace sinew::fem
