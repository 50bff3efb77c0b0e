#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

void Constraint::curve(const Configuration&, std::span<const double>,
                       std::span<mechanics::RowCurvature>) const {}

}  // namespace sinew::constraint
