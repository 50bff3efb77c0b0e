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

/// For rows H_t, given anew at every call, X = H_t L^-T S, by panels: a row is zero but in the
/// panels on the way from its nodes to the root of the elimination tree, so that as much is
/// computed as if these rows alone were in the border. Then H_t A^-1 H_t^T = X S X^T, and with the
/// border's rows of L, which are the same of H and b, the columns between. Allocates only for more
/// rows than ever before.
class TransientRows {
 public:
  /// @param symbolic must outlive this.
  explicit TransientRows(const BlockSymbolic& symbolic);

  /// @param numeric factorised. @param rows k groups of three on the same nodes (a point).
  /// @param values of them, layout of BorderPattern.
  void condense(BlockNumeric& numeric, const BorderPattern& rows, std::span<const double> values);
  /// (3 k, 3 k) leading block of H_t A^-1 H_t^T. Only the lower triangle.
  const MatrixX& compliance() const { return compliance_; }
  /// (3 k, border rows + 1) leading rows of H_t A^-1 (H^T, b).
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
  void for_panels(const BorderPattern& rows, std::int32_t group, Visit&& visit);
  void prepare();
  void list(const BorderPattern& rows);
  void make_room(std::int32_t groups, std::size_t doubles, std::size_t entries);
  void fill(int panel, const BorderPattern& rows, std::span<const double> values);
  void update(BlockNumeric& numeric, int panel);
  void add_compliance(const BlockNumeric& numeric, int panel);
  const double* with_signs(const BlockNumeric& numeric, int panel, const double* rows, long leading,
                           int count);
  std::span<std::int32_t> members(int panel) {
    return {members_.data() + stores_[static_cast<std::size_t>(panel)].first_member,
            static_cast<std::size_t>(stores_[static_cast<std::size_t>(panel)].count)};
  }

  const BlockSymbolic* symbolic_;
  std::int32_t room_ = 0;               // groups that memory is there for
  std::vector<std::int32_t> panel_of_;  // by position in the order of elimination
  std::vector<std::int32_t> stamp_;     // by panel: the group that was there last
  std::vector<Store> stores_;
  std::vector<std::int32_t> members_;  // by panel: which of the groups, ascending
  std::vector<std::int32_t> place_;    // of a descendant's groups among the panel's
  std::vector<std::int32_t> column_place_;
  AlignedBuffer values_, product_, signed_;
  MatrixX compliance_, coupling_;
};

}  // namespace sinew::linalg
