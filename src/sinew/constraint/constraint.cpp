#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

void Constraint::geometric_stiffness(const Configuration&, std::span<const double>,
                                     std::span<mechanics::StiffnessPair>) const {}

}  // namespace sinew::constraint
