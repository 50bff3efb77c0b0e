#include "sinew/sim/row_numbering.hpp"

#include <algorithm>

namespace sinew::sim {

void RowNumbering::number(std::span<const char> active) {
  model_rows_.clear();
  problem_rows_.assign(active.size(), -1);
  for (std::size_t row = 0; row < problem_rows_.size(); ++row) {
    if (active[row] == 0) continue;
    problem_rows_[row] = static_cast<int>(model_rows_.size());
    model_rows_.push_back(static_cast<int>(row));
  }
}

void RowNumbering::gather(const VectorX& all, VectorX& result) const {
  result.resize(static_cast<Eigen::Index>(model_rows_.size()));
  for (std::size_t k = 0; k < model_rows_.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = all[model_rows_[k]];
  }
}

void RowNumbering::gather(std::span<const double> all, linalg::AlignedNumbers& result) const {
  result.clear();
  for (const int row : model_rows_) result.push_back(all[static_cast<std::size_t>(row)]);
}

void RowNumbering::scatter(const linalg::AlignedNumbers& numbers, std::span<double> all) const {
  std::ranges::fill(all, 0.0);
  for (std::size_t k = 0; k < model_rows_.size(); ++k) {
    all[static_cast<std::size_t>(model_rows_[k])] = numbers[k];
  }
}

}  // namespace sinew::sim
