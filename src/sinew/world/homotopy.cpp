#include "sinew/world/homotopy.hpp"

#include "sinew/world/bodies.hpp"

namespace sinew::world {

void Homotopy::keep_residual(std::span<const double> effort) {
  bodies_.imbalance(effort, residual_);
}

void Homotopy::set_fraction(double fraction) {
  if (fraction == 0.0) return bodies_.subtract_residual({});
  lessened_ = fraction * residual_;
  bodies_.subtract_residual({lessened_.data(), static_cast<std::size_t>(lessened_.size())});
}

}  // namespace sinew::world
