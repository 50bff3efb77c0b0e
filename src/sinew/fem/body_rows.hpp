/// @file
/// Constraint rows on the free nodes of a body: the body's part of H and of W.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/system_workspace.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::fem {

/// The body's part of H and of W. `workspace` is that of the last linearisation, and `effort` is
/// (rows,) N over all rows of the world. Persistent rows are the border of the factorisation. The
/// nodes of active transient rows are listed anew whenever rows are taken. Transient rows that
/// share one row of the problem (mechanics::RowGroups) form a single row here, each with its share.
class BodyRows {
 public:
  /// @param model must outlive this.
  explicit BodyRows(const FemBodyModel& model);

  /// Takes the directions of the rows, and which transient rows are active.
  void take(const mechanics::RowValues& rows, SystemWorkspace& workspace);
  /// Adds H^T effort. @param effort,workspace see the class. @param sum (3 free,) N.
  void add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                  VectorX& sum) const;
  /// The same on mesh nodes. @param effort,workspace as before. @param forces (n, 3) N.
  void add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                  Points& forces) const;
  /// See mechanics::StepSystem.
  void add_compliance(std::span<const int> problem_row, const SystemWorkspace& workspace,
                      MatrixX& compliance, VectorX& free_motion) const;
  /// Whether any transient row is active.
  bool has_transient() const { return transient_.rows() > 0; }
  /// Adds the factor's H A^-1 b of the persistent rows. @param problem_row see
  /// mechanics::StepSystem. @param workspace see the class. @param row_motion (rows of the
  /// problem,).
  void add_free_motion(std::span<const int> problem_row, const SystemWorkspace& workspace,
                       VectorX& row_motion) const;
  /// Adds H motion. @param problem_row,workspace as before. @param motion (3 free,) m.
  /// @param row_motion (rows of the problem,).
  void add_motions(std::span<const int> problem_row, const SystemWorkspace& workspace,
                   const VectorX& motion, VectorX& row_motion) const;
  /// Efforts of the persistent rows, in the order of the factorisation's border.
  std::span<const double> fixed_effort(std::span<const double> effort);

 private:
  template <typename Add>
  void each_entry(std::span<const double> effort, const SystemWorkspace& workspace, Add add) const;
  template <typename Visit>
  void each_node(std::int32_t entry, const mechanics::RowValues& rows, Visit visit) const;
  void add_transient_compliance(std::span<const int> problem_row, const SystemWorkspace& workspace,
                                MatrixX& compliance, VectorX& free_motion) const;
  void take_transient(const mechanics::RowValues& rows);
  void add_triple(std::int32_t row, const mechanics::RowValues& rows);
  void list_nodes(std::int32_t row, const mechanics::RowValues& rows);
  int transient_row(std::size_t k, std::span<const int> problem_row) const;
  double effort_of(std::size_t triple, int row, std::span<const double> effort) const;
  void hold(const linalg::BorderPattern& pattern, std::vector<double>& values) const;

  const FemBodyModel& model_;
  std::vector<double> fixed_effort_;
  linalg::BorderPattern transient_;            // triples of active rows
  std::vector<double> transient_values_;       // their values
  std::vector<std::int32_t> members_;          // first world row of each point of all triples
  std::vector<std::int32_t> member_start_{0};  // by triple: its first point, which is the leader
  std::vector<std::int32_t> nodes_;            // nodes of a triple, ascending: scratch
};

}  // namespace sinew::fem
