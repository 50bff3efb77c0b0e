/// @file
/// How the sites of a body with many coordinates move with them. The coordinates come in blocks of
/// three: the position of a node, or the rotation of a section in world axes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sinew::mechanics {

/// The part of one block dq in the motion of a site: weight dq; or, where the block turns the site
/// about a centre, weight dq x lever, with the lever of the present state (SparseStep::lever()).
struct SiteBlock {
  std::int32_t block = -1;
  double weight = 1.0;
  bool turns = false;
};

/// Blocks by site: those of site k are blocks[start[k]] .. blocks[start[k+1]-1]. Coordinates that
/// are fixed are in no block.
class BlockList {
 public:
  std::size_t size() const { return start_.size() - 1; }
  std::span<const SiteBlock> operator[](int site) const {
    const auto k = static_cast<std::size_t>(site);
    const auto begin = static_cast<std::size_t>(start_[k]);
    return std::span(blocks_).subspan(begin, static_cast<std::size_t>(start_[k + 1]) - begin);
  }
  /// Adds a block to the site that next() will complete.
  void add(const SiteBlock& block) { blocks_.push_back(block); }
  /// Completes a site, which may have no block.
  void next() { start_.push_back(static_cast<std::int32_t>(blocks_.size())); }

 private:
  std::vector<std::int32_t> start_{0};
  std::vector<SiteBlock> blocks_;
};

/// The sites of one body.
struct BlockSites {
  BlockList attached;       ///< by number of the site; none for the surface
  BlockList surface_nodes;  ///< by node, of which a Patch is a mean; empty without a surface
  int surface_site = -1;    ///< number of the SurfaceSite; -1: none
};

}  // namespace sinew::mechanics
