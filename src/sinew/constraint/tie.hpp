/// @file
/// Points of one body that stay on points of another.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// Pairs of material points x_a, x_b that are one at rest and stay so: rows along x, y and z of
/// each pair,
///   delta = x_b - x_a = 0,
/// whose effort is the force on b, and whose opposite acts on a. They are linear in the positions:
/// no geometric stiffness, and rotations follow from several pairs. With the nodes of one mesh tied
/// to points in the elements of another this is node-to-element collocation (the finer mesh belongs
/// on the side of the nodes: Wriggers, Computational Contact Mechanics, 2006, sec. 6.3).
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
  void add_to(ValueHash&) const override {}

  const std::vector<Pair>& pairs() const { return pairs_; }
  /// First of the three rows of a pair.
  int row(std::size_t pair) const { return first_row_ + 3 * static_cast<int>(pair); }
  /// Largest distance of any pair now, m.
  double largest_gap(const Configuration& configuration) const;

 private:
  std::vector<Pair> pairs_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
