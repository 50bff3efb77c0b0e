/// @file
/// Rows that come and go beside a factorisation L S L^T: forward substitution of as many of them as
/// there are now, and their part of the compliance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_numeric.hpp"

namespace sinew::linalg {

/// For rows H_p, chosen anew at every call, X = H_p L^-T S, by panels: a row is zero but in the
/// panels on the way from its nodes to the root of the elimination tree, so that as much is
/// computed as if these rows alone were in the border. Then H_p A^-1 H_p^T = X S X^T, and with the
/// border's rows of L, which are the same of H and b, the columns between. Allocates only for more
/// rows than ever before.
class PassingRows {
 public:
  /// @param symbolic must outlive this. @param rows all that may come, in groups of three rows on
  /// the same nodes (a point).
  PassingRows(const BlockSymbolic& symbolic, const BorderPattern& rows);

  /// @param numeric factorised. @param values of all rows, layout of BorderPattern.
  /// @param groups which groups are there, ascending; k of them.
  void condense(BlockNumeric& numeric, std::span<const double> values,
                std::span<const std::int32_t> groups);
  /// (3 k, 3 k) leading block of H_p A^-1 H_p^T. Only the lower triangle.
  const MatrixX& compliance() const { return compliance_; }
  /// (3 k, border rows + 1) leading rows of H_p A^-1 (H^T, b).
  const MatrixX& coupling() const { return coupling_; }
  std::size_t bytes() const;

 private:
  struct Store {
    std::int64_t offset = 0;       // of a panel's X in values_, column-major
    std::size_t first_member = 0;  // in members_
    std::int32_t count = 0;        // groups in it now
    std::int32_t leading = 0;
  };
  template <typename Visit>
  void for_panels(std::int32_t group, Visit&& visit);
  void list(std::span<const std::int32_t> groups);
  void make_room(std::int32_t groups, std::size_t doubles, std::size_t entries);
  void fill(int panel, std::span<const double> values, std::span<const std::int32_t> groups);
  void update(BlockNumeric& numeric, int panel);
  void add_compliance(const BlockNumeric& numeric, int panel);
  const double* with_signs(const BlockNumeric& numeric, int panel, const double* rows, long leading,
                           int count);
  std::span<std::int32_t> members(int panel) {
    return {members_.data() + stores_[static_cast<std::size_t>(panel)].first_member,
            static_cast<std::size_t>(stores_[static_cast<std::size_t>(panel)].count)};
  }

  const BlockSymbolic* symbolic_;
  BorderPattern rows_;
  std::size_t groups_ = 0;
  std::int32_t room_ = 0;               // groups that memory is there for
  std::vector<std::int32_t> panel_of_;  // by position in the order of elimination
  std::vector<std::int32_t> stamp_;     // by panel: the group that was there last
  std::vector<Store> stores_;
  std::vector<std::int32_t> members_;  // by panel: which of the present groups, ascending
  std::vector<std::int32_t> place_;    // of a descendant's groups among the panel's
  std::vector<std::int32_t> column_place_;
  AlignedBuffer values_, product_, signed_;
  MatrixX compliance_, coupling_;
};

}  // namespace sinew::linalg
