/// @file
/// Constraint rows on the free nodes of a body: its part of H, and of W.
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

/// Numbers are those of the last linearisation's system; efforts are (rows,) N of the world's rows.
/// Rows that are always there stand in the factorisation's border. Of transient rows the
/// active ones alone have their nodes listed, anew whenever they are taken; those that share a row
/// of the problem (mechanics::RowGroups) are one, with efforts in the parts of their shares.
class BodyRows {
 public:
  /// @param model must outlive this.
  explicit BodyRows(const FemBodyModel& model);

  /// Takes directions, and which of the transient rows are active.
  void take(const mechanics::RowValues& rows, SystemWorkspace& workspace);
  /// Adds H^T effort. @param effort,workspace as the class says. @param sum (3 free,) N.
  void add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                  VectorX& sum) const;
  /// The same on mesh nodes. @param effort,workspace as before. @param forces (n, 3) N.
  void add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                  Points& forces) const;
  /// See mechanics::StepSystem.
  void add_compliance(std::span<const int> problem_row, const SystemWorkspace& workspace,
                      MatrixX& compliance, VectorX& free_motion) const;
  /// Of the rows that are always there, as the factorisation counts them.
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
  double effort_of(std::size_t triple, int row, std::span<const double> effort) const;
  void hold(const linalg::BorderPattern& pattern, std::vector<double>& values) const;

  const FemBodyModel& model_;
  std::vector<double> fixed_effort_;
  linalg::BorderPattern transient_;            // triples of active rows
  std::vector<double> transient_values_;       // of them
  std::vector<std::int32_t> members_;          // the world's first rows of all triples' points
  std::vector<std::int32_t> member_start_{0};  // by triple: where its points begin; the first leads
  std::vector<std::int32_t> nodes_;            // of a triple, ascending: scratch
};

}  // namespace sinew::fem
