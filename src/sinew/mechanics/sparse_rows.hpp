/// @file
/// Constraint rows on the blocks of a body with many coordinates: the body's part of H and of W.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/sparse_row_plan.hpp"

namespace sinew::mechanics {

/// Levers of the sites that blocks turn (SiteBlock::turns), at the present state. Bodies without
/// such sites need not define them.
class SiteLevers {
 public:
  virtual ~SiteLevers() = default;
  /// (3,) m from the centre of a turning block to a site. @param site,block numbers on the body.
  virtual Vector3 lever(int site, std::int32_t block) const;
  /// The same to a node of the surface. @param node,block numbers on the body.
  virtual Vector3 surface_lever(NodeId node, std::int32_t block) const;
};

/// The body's part of H and of W. `effort` is (rows,) N over all rows of the world. Persistent rows
/// are the border of the factorisation. The blocks of active transient rows are listed anew
/// whenever rows are taken. Transient rows that share one row of the problem (RowGroups) form a
/// single row here, each with its share.
class SparseRows {
 public:
  /// @param plan,levers must outlive this. @param held coordinates that do not move, ascending;
  /// must
  ///   outlive this.
  SparseRows(const SparseRowPlan& plan, std::span<const std::int32_t> held,
             const SiteLevers& levers);

  /// Takes the directions of the rows, and which transient rows are active.
  void take(const RowValues& rows);
  /// Adds H^T effort. @param effort see the class. @param sum (size,) N.
  void add_forces(std::span<const double> effort, VectorX& sum) const;
  /// See StepSystem. @param problem_row,compliance,free_motion as there.
  /// @param factor bordered by border().
  void add_compliance(std::span<const int> problem_row, linalg::Factorisation& factor,
                      MatrixX& compliance, VectorX& free_motion) const;
  /// Whether all rows taken are in the border.
  bool in_border() const { return transient_.rows() == 0; }
  /// Adds the factor's H A^-1 b of the persistent rows. @param problem_row see StepSystem.
  /// @param factor bordered by border(). @param row_motion (rows of the problem,).
  void add_free_motion(std::span<const int> problem_row, const linalg::Factorisation& factor,
                       VectorX& row_motion) const;
  /// Adds H motion. @param problem_row as before. @param motion (size,).
  /// @param row_motion (rows of the problem,).
  void add_motions(std::span<const int> problem_row, const VectorX& motion,
                   VectorX& row_motion) const;
  /// Efforts of the persistent rows, in the order of the factorisation's border.
  std::span<const double> persistent_effort(std::span<const double> effort);

  const SparseRowPlan& plan() const { return plan_; }
  /// Values of the persistent rows, in the layout of linalg::BorderPattern.
  std::span<const double> border() const { return border_; }
  std::size_t bytes() const;

 private:
  template <typename Add>
  void each_part(std::span<const double> effort, Add add) const;
  template <typename Visit>
  void each_block(std::int32_t entry, const RowValues& rows, Visit visit) const;
  void add_transient_compliance(std::span<const int> problem_row, linalg::Factorisation& factor,
                                MatrixX& compliance, VectorX& free_motion) const;
  void take_transient(const RowValues& rows);
  void add_triple(std::int32_t row, const RowValues& rows);
  void list_blocks(std::int32_t row, const RowValues& rows);
  int transient_row(std::size_t k, std::span<const int> problem_row) const;
  double effort_of(std::size_t triple, int row, std::span<const double> effort) const;
  void hold(const linalg::BorderPattern& pattern, std::vector<double>& values) const;

  const SparseRowPlan& plan_;
  std::span<const std::int32_t> held_;
  const SiteLevers& levers_;
  std::vector<double> border_;
  std::vector<double> persistent_effort_;
  linalg::BorderPattern transient_;            // triples of active rows
  std::vector<double> transient_values_;       // their values
  std::vector<std::int32_t> members_;          // first world row of each point of all triples
  std::vector<std::int32_t> member_start_{0};  // by triple: its first point, which is the leader
  std::vector<std::int32_t> blocks_;           // blocks of a triple, ascending: scratch
};

}  // namespace sinew::mechanics
