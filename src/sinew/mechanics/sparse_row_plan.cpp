#include "sinew/mechanics/sparse_row_plan.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace sinew::mechanics {

SparseRowPlan::SparseRowPlan(int body, RowPattern world, BlockSites sites)
    : body_(body), world_(std::move(world)), sites_(std::move(sites)) {
  for (int row = 0; row < world_.rows(); ++row) {
    bool mine = false;
    for_each_entry(row, [&](std::int32_t) { mine = true; });
    if (mine) rows_.push_back(row);
  }
  const auto transient = std::stable_partition(rows_.begin(), rows_.end(), [&](std::int32_t row) {
    return world_.transient[static_cast<std::size_t>(row)] == 0;
  });
  persistent_ = static_cast<std::size_t>(transient - rows_.begin());
  for (const std::int32_t row : persistent()) add_border_row(row);
}

void SparseRowPlan::add_border_row(std::int32_t row) {
  // Position of every block that the row touches, ascending by block.
  std::map<std::int32_t, std::int32_t> position;
  for_each_entry(row, [&](std::int32_t entry) {
    for (const SiteBlock& part : sites_.attached[site_of(entry)]) position[part.block] = 0;
  });
  for (auto& [block, place] : position) {
    place = border_.entries();
    border_.node.push_back(block);
  }
  border_.row_start.push_back(border_.entries());
  for_each_entry(row, [&](std::int32_t entry) {
    const int site = site_of(entry);
    for (const SiteBlock& part : sites_.attached[site]) {
      scatter_.push_back({entry, position.at(part.block), site, part});
    }
  });
}

}  // namespace sinew::mechanics
