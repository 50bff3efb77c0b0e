/// @file
/// Rows for stiffness that couples two bodies.
#pragma once

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// The relative motion of two points normal to the line between them. Two rows, whose directions
/// e_1 and e_2 form an orthonormal frame with the line: delta = e . (x_2 - x_1) = 0. The geometric
/// stiffness T/l (I - n n^T) of a cable segment between two bodies is a spring of stiffness T/l
/// along each of them (see law::StiffnessBlock).
class Coupling : public Constraint {
 public:
  Coupling(mechanics::MaterialPoint first, mechanics::MaterialPoint second);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor&) const override {}

 private:
  mechanics::MaterialPoint first_, second_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
