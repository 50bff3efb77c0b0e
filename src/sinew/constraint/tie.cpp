#include "sinew/constraint/tie.hpp"

#include <algorithm>
#include <utility>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

Tie::Tie(std::string name, std::vector<Pair> pairs)
    : Constraint(std::move(name)), pairs_(std::move(pairs)) {}

void Tie::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3 * static_cast<int>(pairs_.size());
  for (const Pair& pair : pairs_) {
    for (int axis = 0; axis < 3; ++axis) rows.add_row({pair.first, pair.second});
  }
}

void Tie::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  auto* direction = values.direction.data() + first_entry_;
  int row = first_row_;
  for (const Pair& pair : pairs_) {
    const Vector3 gap = configuration.position(pair.second) - configuration.position(pair.first);
    for (int axis = 0; axis < 3; ++axis) {
      *direction++ = -Vector3::Unit(axis);
      *direction++ = Vector3::Unit(axis);
      values.delta[row++] = gap[axis];
    }
  }
}

double Tie::largest_gap(const Configuration& configuration) const {
  double largest = 0.0;
  for (const Pair& pair : pairs_) {
    const Vector3 gap = configuration.position(pair.second) - configuration.position(pair.first);
    largest = std::max(largest, gap.norm());
  }
  return largest;
}

}  // namespace sinew::constraint
