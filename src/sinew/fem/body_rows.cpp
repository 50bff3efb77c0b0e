#include "sinew/fem/body_rows.hpp"

#include <algorithm>

namespace sinew::fem {

BodyRows::BodyRows(const FemBodyModel& model) : model_(model), fixed_effort_(model.fixed_rows()) {}

void BodyRows::take(const mechanics::RowValues& rows, SystemWorkspace& workspace) {
  std::ranges::fill(workspace.border, 0.0);
  for (const auto& s : workspace.system.scatter) {
    double* value = workspace.border.data() + 3 * static_cast<std::size_t>(s.position);
    const Vector3& direction = rows.direction[static_cast<std::size_t>(s.entry)];
    for (int c = 0; c < 3; ++c) value[c] += s.weight * direction[c];
  }
  hold(workspace.system.border, workspace.border);
  take_transient(rows);
  hold(transient_, transient_values_);
}

void BodyRows::take_transient(const mechanics::RowValues& rows) {
  transient_.row_start.assign(1, 0);
  transient_.node.clear();
  transient_values_.clear();
  members_.clear();
  member_start_.assign(1, 0);
  const auto& own = model_.rows();
  for (std::size_t k = model_.fixed_rows(); k < own.size(); k += 3) {
    const std::int32_t row = own[k];
    if (rows.active[static_cast<std::size_t>(row)] == 0 || !rows.groups.leads(row)) continue;
    add_triple(row, rows);
  }
}

// Calls visit(free node, weight) for the free nodes of the site of an entry.
template <typename Visit>
void BodyRows::each_node(std::int32_t entry, const mechanics::RowValues& rows, Visit visit) const {
  const mechanics::Site& site = model_.world_rows().site[static_cast<std::size_t>(entry)];
  if (site.body != model_.body()) return;
  const auto free = model_.elements().free_index();
  const auto see = [&](NodeId node, double weight) {
    const std::int32_t number = node < 0 ? -1 : free[static_cast<std::size_t>(node)];
    if (number >= 0) visit(number, weight);
  };
  if (site.number == model_.surface_site()) {
    const mechanics::Patch& patch = rows.patch[static_cast<std::size_t>(entry)];
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) see(patch.nodes[k], patch.weights[k]);
    return;
  }
  const mechanics::Attachment& at = model_.attachment(site.number);
  for (std::size_t k = 0; k < at.nodes.size(); ++k) see(at.nodes[k], at.weights[k]);
}

// Lists the free nodes of a row and of the other rows in its group, ascending.
void BodyRows::list_nodes(std::int32_t row, const mechanics::RowValues& rows) {
  const auto& starts = model_.world_rows().row_start;
  nodes_.clear();
  rows.groups.for_each_member(row, [&](int member, double) {
    for (std::int32_t entry = starts[static_cast<std::size_t>(member)];
         entry < starts[static_cast<std::size_t>(member) + 1]; ++entry) {
      each_node(entry, rows, [&](std::int32_t node, double) { nodes_.push_back(node); });
    }
  });
  std::ranges::sort(nodes_);
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

// Adds the three rows of a point, which are on the same sites.
void BodyRows::add_triple(std::int32_t row, const mechanics::RowValues& rows) {
  const auto& starts = model_.world_rows().row_start;
  list_nodes(row, rows);
  for (int r = 0; r < 3; ++r) {
    const std::size_t first = transient_values_.size();
    transient_.node.insert(transient_.node.end(), nodes_.begin(), nodes_.end());
    transient_.row_start.push_back(transient_.entries());
    transient_values_.resize(first + 3 * nodes_.size(), 0.0);
    rows.groups.for_each_member(row + r, [&](int member, double share) {
      for (std::int32_t entry = starts[static_cast<std::size_t>(member)];
           entry < starts[static_cast<std::size_t>(member) + 1]; ++entry) {
        const Vector3& direction = rows.direction[static_cast<std::size_t>(entry)];
        each_node(entry, rows, [&](std::int32_t node, double weight) {
          const auto at = std::ranges::lower_bound(nodes_, node) - nodes_.begin();
          double* value = transient_values_.data() + first + 3 * static_cast<std::size_t>(at);
          for (int c = 0; c < 3; ++c) value[c] += share * weight * direction[c];
        });
      }
    });
  }
  rows.groups.for_each_member(row, [&](int member, double) { members_.push_back(member); });
  member_start_.push_back(static_cast<std::int32_t>(members_.size()));
}

double BodyRows::effort_of(std::size_t triple, int row, std::span<const double> effort) const {
  double sum = 0.0;
  for (auto m = member_start_[triple]; m < member_start_[triple + 1]; ++m) {
    sum += effort[static_cast<std::size_t>(members_[static_cast<std::size_t>(m)] + row)];
  }
  return sum;
}

// Zeroes held coordinates in rows.
void BodyRows::hold(const linalg::BorderPattern& pattern, std::vector<double>& values) const {
  const auto held = model_.elements().held();
  if (held.empty()) return;
  for (std::size_t e = 0; e < pattern.node.size(); ++e) {
    for (int c = 0; c < 3; ++c) {
      if (std::ranges::binary_search(held, 3 * pattern.node[e] + c)) {
        values[3 * e + static_cast<std::size_t>(c)] = 0.0;
      }
    }
  }
}

// Calls add(free node, effort, (3,) of H) for every entry of rows whose effort is not zero.
template <typename Add>
void BodyRows::each_entry(std::span<const double> effort, const SystemWorkspace& workspace,
                          Add add) const {
  const auto each = [&](const linalg::BorderPattern& pattern, std::span<const double> values,
                        std::size_t k, double lambda) {
    if (lambda == 0.0) return;
    for (auto e = pattern.row_start[k]; e < pattern.row_start[k + 1]; ++e) {
      const double* value = values.data() + 3 * static_cast<std::size_t>(e);
      add(pattern.node[static_cast<std::size_t>(e)], lambda, value);
    }
  };
  for (std::size_t k = 0; k < model_.fixed_rows(); ++k) {
    each(workspace.system.border, workspace.border, k,
         effort[static_cast<std::size_t>(model_.rows()[k])]);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(transient_.rows()); ++k) {
    each(transient_, transient_values_, k, effort_of(k / 3, static_cast<int>(k % 3), effort));
  }
}

void BodyRows::add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                          VectorX& sum) const {
  each_entry(effort, workspace, [&](std::int32_t node, double lambda, const double* value) {
    double* r = sum.data() + 3 * node;
    for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
  });
}

void BodyRows::add_forces(std::span<const double> effort, const SystemWorkspace& workspace,
                          Points& forces) const {
  const auto nodes = model_.elements().free_nodes();
  each_entry(effort, workspace, [&](std::int32_t node, double lambda, const double* value) {
    auto r = forces.row(nodes[static_cast<std::size_t>(node)]);
    for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
  });
}

void BodyRows::add_compliance(std::span<const int> problem_row, const SystemWorkspace& workspace,
                              MatrixX& compliance, VectorX& free_motion) const {
  const MatrixX& own = workspace.factorisation->compliance();
  const VectorX& motion = workspace.factorisation->free_motion();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto problem_row_of = [&](std::size_t i) {
    return problem_row[static_cast<std::size_t>(rows[i])];
  };
  for (std::size_t j = 0; j < fixed; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int to = problem_row_of(j);
    free_motion[to] += motion[column];
    for (std::size_t i = 0; i < fixed; ++i) {
      compliance(problem_row_of(i), to) += own(static_cast<Eigen::Index>(i), column);
    }
  }
  if (transient_.rows() > 0) {
    add_transient_compliance(problem_row, workspace, compliance, free_motion);
  }
}

// The problem's row of a row of transient_.
int BodyRows::transient_row(std::size_t k, std::span<const int> problem_row) const {
  const auto leader = static_cast<std::size_t>(member_start_[k / 3]);
  return problem_row[static_cast<std::size_t>(members_[leader]) + k % 3];
}

void BodyRows::add_free_motion(std::span<const int> problem_row, const SystemWorkspace& workspace,
                               VectorX& row_motion) const {
  const VectorX& motion = workspace.factorisation->free_motion();
  for (std::size_t k = 0; k < model_.fixed_rows(); ++k) {
    const int row = problem_row[static_cast<std::size_t>(model_.rows()[k])];
    row_motion[row] += motion[static_cast<Eigen::Index>(k)];
  }
}

void BodyRows::add_motions(std::span<const int> problem_row, const SystemWorkspace& workspace,
                           const VectorX& motion, VectorX& row_motion) const {
  const auto moves = [&](const linalg::BorderPattern& pattern, std::span<const double> values,
                         std::size_t k) {
    double sum = 0.0;
    for (auto e = pattern.row_start[k]; e < pattern.row_start[k + 1]; ++e) {
      const Eigen::Map<const Vector3> value(values.data() + 3 * static_cast<std::size_t>(e));
      sum += value.dot(motion.segment<3>(3 * pattern.node[static_cast<std::size_t>(e)]));
    }
    return sum;
  };
  for (std::size_t k = 0; k < model_.fixed_rows(); ++k) {
    const int row = problem_row[static_cast<std::size_t>(model_.rows()[k])];
    row_motion[row] += moves(workspace.system.border, workspace.border, k);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(transient_.rows()); ++k) {
    row_motion[transient_row(k, problem_row)] += moves(transient_, transient_values_, k);
  }
}

void BodyRows::add_transient_compliance(std::span<const int> problem_row,
                                        const SystemWorkspace& workspace, MatrixX& compliance,
                                        VectorX& free_motion) const {
  linalg::Factorisation& factor = *workspace.factorisation;
  factor.condense_transient(transient_, transient_values_);
  const MatrixX& own = factor.transient_compliance();
  const MatrixX& coupling = factor.transient_coupling();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto row_of = [&](Eigen::Index k) {
    return transient_row(static_cast<std::size_t>(k), problem_row);
  };
  const auto count = static_cast<Eigen::Index>(transient_.rows());
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = row_of(j);
    free_motion[column] += coupling(j, static_cast<Eigen::Index>(fixed));
    for (std::size_t i = 0; i < fixed; ++i) {
      const double value = coupling(j, static_cast<Eigen::Index>(i));
      const int to = problem_row[static_cast<std::size_t>(rows[i])];
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
