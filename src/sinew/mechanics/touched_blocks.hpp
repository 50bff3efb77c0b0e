/// @file
/// The blocks of a matrix that pairs of sites of a body touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/mechanics/block_sites.hpp"

namespace sinew::mechanics {

class SiteLevers;

/// Adds the Hessians of pairs of attached sites (StiffnessPair) to a matrix. Where a pair reaches
/// is found once: cables have the same pairs in every step, and to find a block takes longer than
/// to add to it. Allocates at the first use of a pair only.
class TouchedBlocks {
 public:
  /// @param sites,levers must outlive this.
  TouchedBlocks(const BlockList& sites, const SiteLevers& levers)
      : sites_(sites), levers_(levers) {}
  /// Adds -J_a^T C J_b to the block of each part a of the first and b of the second site, with J
  /// their weights, or weighted turns about their levers.
  /// @param pattern of the matrix. @param first,second numbers of attached sites; a pair of two
  /// sites includes its transpose. @param hessian C, N/m. @param matrix with that pattern.
  void add(const linalg::BlockPattern& pattern, int first, int second, const Matrix3& hessian,
           std::span<double> matrix);
  std::size_t bytes() const;

 private:
  enum class Turned { no, yes, both };  // C, its transpose, or the sum of both is added
  struct Target {
    std::int64_t begin = 0;  // of the block in the matrix
    double weight = 0.0;     // -w_a w_b
    Turned turned = Turned::no;
    SiteBlock first, second;
  };
  struct Pair {
    int second = -1;
    bool turns = false;  // whether any of its blocks turns
    std::vector<Target> targets;
  };
  const Pair& find(int first, int second);
  Pair reach(int first, int second) const;
  Matrix3 turn(const Target& target, int first, int second, const Matrix3& hessian) const;

  const BlockList& sites_;
  const SiteLevers& levers_;
  const linalg::BlockPattern* pattern_ = nullptr;  // of the targets
  std::vector<std::vector<Pair>> pairs_;           // of each first site
};

}  // namespace sinew::mechanics
