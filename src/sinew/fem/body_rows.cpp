#include "sinew/fem/body_rows.hpp"

#include <algorithm>

namespace sinew::fem {

BodyRows::BodyRows(const FemBodyModel& model) : model_(model), fixed_effort_(model.fixed_rows()) {
  passing_.reserve((model.rows().size() - model.fixed_rows()) / 3);
}

void BodyRows::take(const mechanics::RowValues& rows, SystemNumbers& numbers) {
  std::ranges::fill(numbers.border, 0.0);
  for (const auto& s : numbers.system.scatter) {
    double* value = numbers.border.data() + 3 * static_cast<std::size_t>(s.position);
    const Vector3& direction = rows.direction[static_cast<std::size_t>(s.entry)];
    for (int c = 0; c < 3; ++c) value[c] += s.weight * direction[c];
  }
  take_presence(rows);
  hold(numbers);
}

void BodyRows::take_presence(const mechanics::RowValues& rows) {
  passing_.clear();
  const auto& own = model_.rows();
  for (std::size_t k = model_.fixed_rows(); k < own.size(); k += 3) {
    if (rows.present[static_cast<std::size_t>(own[k])] == 0) continue;
    passing_.push_back(static_cast<std::int32_t>((k - model_.fixed_rows()) / 3));
  }
}

// Takes held coordinates out of the border.
void BodyRows::hold(SystemNumbers& numbers) const {
  const auto held = model_.elements().held();
  if (held.empty()) return;
  const auto& nodes = numbers.system.border.node;
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    for (int c = 0; c < 3; ++c) {
      if (std::ranges::binary_search(held, 3 * nodes[e] + c)) {
        numbers.border[3 * e + static_cast<std::size_t>(c)] = 0.0;
      }
    }
  }
}

// Calls add(free node, row's effort, (3,) of H) for every entry of rows that have an effort.
template <typename Add>
void BodyRows::each_entry(std::span<const double> effort, const SystemNumbers& numbers,
                          Add add) const {
  const auto& border = numbers.system.border;
  for (std::size_t k = 0; k < model_.rows().size(); ++k) {
    const double lambda = effort[static_cast<std::size_t>(model_.rows()[k])];
    if (lambda == 0.0) continue;
    for (auto e = border.row_start[k]; e < border.row_start[k + 1]; ++e) {
      const double* value = numbers.border.data() + 3 * static_cast<std::size_t>(e);
      add(border.node[static_cast<std::size_t>(e)], lambda, value);
    }
  }
}

void BodyRows::add_forces(std::span<const double> effort, const SystemNumbers& numbers,
                          VectorX& sum) const {
  each_entry(effort, numbers, [&](std::int32_t node, double lambda, const double* value) {
    double* r = sum.data() + 3 * node;
    for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
  });
}

void BodyRows::add_forces(std::span<const double> effort, const SystemNumbers& numbers,
                          Points& forces) const {
  const auto nodes = model_.elements().free_nodes();
  each_entry(effort, numbers, [&](std::int32_t node, double lambda, const double* value) {
    auto r = forces.row(nodes[static_cast<std::size_t>(node)]);
    for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
  });
}

void BodyRows::add_compliance(std::span<const int> place, const SystemNumbers& numbers,
                              MatrixX& compliance, VectorX& free_motion) const {
  const MatrixX& own = numbers.factorisation->compliance();
  const VectorX& motion = numbers.factorisation->free_motion();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto place_of = [&](std::size_t i) { return place[static_cast<std::size_t>(rows[i])]; };
  for (std::size_t j = 0; j < fixed; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int to = place_of(j);
    free_motion[to] += motion[column];
    for (std::size_t i = 0; i < fixed; ++i) {
      compliance(place_of(i), to) += own(static_cast<Eigen::Index>(i), column);
    }
  }
  if (!passing_.empty()) add_passing_compliance(place, numbers, compliance, free_motion);
}

void BodyRows::add_passing_compliance(std::span<const int> place, const SystemNumbers& numbers,
                                      MatrixX& compliance, VectorX& free_motion) const {
  linalg::Factorisation& factor = *numbers.factorisation;
  const std::span<const double> border(numbers.border);
  factor.pass(border.subspan(3 * numbers.system.fixed_entries), passing_);
  const MatrixX& own = factor.passing_compliance();
  const MatrixX& coupling = factor.passing_coupling();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto row_of = [&](Eigen::Index k) {
    const auto group = static_cast<std::size_t>(passing_[static_cast<std::size_t>(k / 3)]);
    const std::int32_t row = rows[fixed + 3 * group + static_cast<std::size_t>(k % 3)];
    return place[static_cast<std::size_t>(row)];
  };
  const auto count = 3 * static_cast<Eigen::Index>(passing_.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = row_of(j);
    free_motion[column] += coupling(j, static_cast<Eigen::Index>(fixed));
    for (std::size_t i = 0; i < fixed; ++i) {
      const double value = coupling(j, static_cast<Eigen::Index>(i));
      const int to = place[static_cast<std::size_t>(rows[i])];
      compliance(to, column) += value;
      compliance(column, to) += value;
    }
    compliance(column, column) += own(j, j);
    for (Eigen::Index i = j + 1; i < count; ++i) {
      const int row = row_of(i);
      compliance(row, column) += own(i, j);
      compliance(column, row) += own(i, j);
    }
  }
}

std::span<const double> BodyRows::fixed_effort(std::span<const double> effort) {
  for (std::size_t k = 0; k < fixed_effort_.size(); ++k) {
    fixed_effort_[k] = effort[static_cast<std::size_t>(model_.rows()[k])];
  }
  return fixed_effort_;
}

}  // namespace sinew::fem
