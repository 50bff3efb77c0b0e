/// @file
/// Ties points of one body to points of another.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// Pairs of material points x_a, x_b that coincide at rest and are held together by rows along x, y
/// and z,
///   delta = x_b - x_a = 0.
/// The effort is the force on b; the opposite force acts on a. The rows are linear in the
/// positions, so there is no geometric stiffness; several pairs also hold rotations. If the nodes
/// of one mesh are tied to points in the elements of another, this is node-to-element collocation
/// (the finer mesh should have the nodes: Wriggers, Computational Contact Mechanics, 2006, sec.
/// 6.3).
class Tie : public Constraint {
 public:
  struct Pair {
    mechanics::MaterialPoint first, second;
  };

  /// @param name for messages. @param pairs at least one.
  Tie(std::string name, std::vector<Pair> pairs);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor&) const override {}

  const std::vector<Pair>& pairs() const { return pairs_; }
  /// First of the three rows of a pair.
  int row(std::size_t pair) const { return first_row_ + 3 * static_cast<int>(pair); }
  /// Largest present distance of any pair, m.
  double largest_gap(const Configuration& configuration) const;

 private:
  std::vector<Pair> pairs_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
