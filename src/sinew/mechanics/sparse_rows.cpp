#include "sinew/mechanics/sparse_rows.hpp"

#include <algorithm>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

namespace {

[[noreturn]] void refuse_lever() {
  throw Error(ErrorKind::internal, {}, "a body without turning sites is asked for a lever");
}

}  // namespace

Vector3 SiteLevers::lever(int, std::int32_t) const { refuse_lever(); }
Vector3 SiteLevers::surface_lever(NodeId, std::int32_t) const { refuse_lever(); }

SparseRows::SparseRows(const SparseRowPlan& plan, std::span<const std::int32_t> held,
                       const SiteLevers& levers)
    : plan_(plan),
      held_(held),
      levers_(levers),
      border_(3 * static_cast<std::size_t>(plan.border().entries()), 0.0),
      persistent_effort_(plan.persistent().size()) {}

// The part of a block in a row of direction d: d . (w dq) = w d . dq, or, where it turns the site
// with lever l, d . (w dq x l) = w (l x d) . dq.
void SparseRows::take(const RowValues& rows) {
  std::ranges::fill(border_, 0.0);
  for (const SparseRowPlan::Scatter& s : plan_.scatter()) {
    double* value = border_.data() + 3 * static_cast<std::size_t>(s.position);
    Vector3 along = rows.direction[static_cast<std::size_t>(s.entry)];
    if (s.block.turns) along = levers_.lever(s.site, s.block.block).cross(along);
    for (int c = 0; c < 3; ++c) value[c] += s.block.weight * along[c];
  }
  hold(plan_.border(), border_);
  take_transient(rows);
  hold(transient_, transient_values_);
}

void SparseRows::take_transient(const RowValues& rows) {
  transient_.row_start.assign(1, 0);
  transient_.node.clear();
  transient_values_.clear();
  members_.clear();
  member_start_.assign(1, 0);
  const auto own = plan_.transient();
  for (std::size_t k = 0; k < own.size(); k += 3) {
    const std::int32_t row = own[k];
    if (rows.active[static_cast<std::size_t>(row)] == 0 || !rows.groups.leads(row)) continue;
    add_triple(row, rows);
  }
}

// Calls visit(block, weight, lever) for the blocks of the site of an entry; the lever is that of a
// turning block.
template <typename Visit>
void SparseRows::each_block(std::int32_t entry, const RowValues& rows, Visit visit) const {
  const BlockSites& sites = plan_.sites();
  const int site = plan_.site_of(entry);
  if (site != sites.surface_site) {
    for (const SiteBlock& block : sites.attached[site]) {
      visit(block, 1.0, [&] { return levers_.lever(site, block.block); });
    }
    return;
  }
  const Patch& patch = rows.patch[static_cast<std::size_t>(entry)];
  for (std::size_t k = 0; k < patch.nodes.size() && patch.nodes[k] >= 0; ++k) {
    const NodeId node = patch.nodes[k];
    for (const SiteBlock& block : sites.surface_nodes[node]) {
      visit(block, patch.weights[k], [&] { return levers_.surface_lever(node, block.block); });
    }
  }
}

// Lists the blocks of a row and of the other rows in its group, ascending.
void SparseRows::list_blocks(std::int32_t row, const RowValues& rows) {
  blocks_.clear();
  rows.groups.for_each_member(row, [&](int member, double) {
    plan_.for_each_entry(member, [&](std::int32_t entry) {
      each_block(entry, rows, [&](const SiteBlock& block, double, const auto&) {
        blocks_.push_back(block.block);
      });
    });
  });
  std::ranges::sort(blocks_);
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
}

// Adds the three rows of a point, which are on the same sites.
void SparseRows::add_triple(std::int32_t row, const RowValues& rows) {
  list_blocks(row, rows);
  for (int r = 0; r < 3; ++r) {
    const std::size_t first = transient_values_.size();
    transient_.node.insert(transient_.node.end(), blocks_.begin(), blocks_.end());
    transient_.row_start.push_back(transient_.entries());
    transient_values_.resize(first + 3 * blocks_.size(), 0.0);
    rows.groups.for_each_member(row + r, [&](int member, double share) {
      plan_.for_each_entry(member, [&](std::int32_t entry) {
        const Vector3& direction = rows.direction[static_cast<std::size_t>(entry)];
        each_block(entry, rows, [&](const SiteBlock& block, double weight, const auto& lever) {
          const auto at = std::ranges::lower_bound(blocks_, block.block) - blocks_.begin();
          double* value = transient_values_.data() + first + 3 * static_cast<std::size_t>(at);
          const double factor = share * (weight * block.weight);
          const Vector3 along = block.turns ? lever().cross(direction) : direction;
          for (int c = 0; c < 3; ++c) value[c] += factor * along[c];
        });
      });
    });
  }
  rows.groups.for_each_member(row, [&](int member, double) { members_.push_back(member); });
  member_start_.push_back(static_cast<std::int32_t>(members_.size()));
}

double SparseRows::effort_of(std::size_t triple, int row, std::span<const double> effort) const {
  double sum = 0.0;
  for (auto m = member_start_[triple]; m < member_start_[triple + 1]; ++m) {
    sum += effort[static_cast<std::size_t>(members_[static_cast<std::size_t>(m)] + row)];
  }
  return sum;
}

// Zeroes held coordinates in rows.
void SparseRows::hold(const linalg::BorderPattern& pattern, std::vector<double>& values) const {
  if (held_.empty()) return;
  for (std::size_t e = 0; e < pattern.node.size(); ++e) {
    for (int c = 0; c < 3; ++c) {
      if (std::ranges::binary_search(held_, 3 * pattern.node[e] + c)) {
        values[3 * e + static_cast<std::size_t>(c)] = 0.0;
      }
    }
  }
}

// Calls add(block, effort, (3,) of H) for every block of rows whose effort is not zero.
template <typename Add>
void SparseRows::each_part(std::span<const double> effort, Add add) const {
  const auto each = [&](const linalg::BorderPattern& pattern, std::span<const double> values,
                        std::size_t k, double lambda) {
    if (lambda == 0.0) return;
    for (auto e = pattern.row_start[k]; e < pattern.row_start[k + 1]; ++e) {
      const double* value = values.data() + 3 * static_cast<std::size_t>(e);
      add(pattern.node[static_cast<std::size_t>(e)], lambda, value);
    }
  };
  const auto persistent = plan_.persistent();
  for (std::size_t k = 0; k < persistent.size(); ++k) {
    each(plan_.border(), border_, k, effort[static_cast<std::size_t>(persistent[k])]);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(transient_.rows()); ++k) {
    each(transient_, transient_values_, k, effort_of(k / 3, static_cast<int>(k % 3), effort));
  }
}

void SparseRows::add_forces(std::span<const double> effort, VectorX& sum) const {
  each_part(effort, [&](std::int32_t block, double lambda, const double* value) {
    double* r = sum.data() + 3 * block;
    for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
  });
}

void SparseRows::add_compliance(std::span<const int> problem_row, linalg::Factorisation& factor,
                                MatrixX& compliance, VectorX& free_motion) const {
  const MatrixX& own = factor.compliance();
  const VectorX& motion = factor.free_motion();
  const auto rows = plan_.persistent();
  const auto problem_row_of = [&](std::size_t i) {
    return problem_row[static_cast<std::size_t>(rows[i])];
  };
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int to = problem_row_of(j);
    free_motion[to] += motion[column];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      compliance(problem_row_of(i), to) += own(static_cast<Eigen::Index>(i), column);
    }
  }
  if (!in_border()) add_transient_compliance(problem_row, factor, compliance, free_motion);
}

// The problem's row of a row of transient_.
int SparseRows::transient_row(std::size_t k, std::span<const int> problem_row) const {
  const auto leader = static_cast<std::size_t>(member_start_[k / 3]);
  return problem_row[static_cast<std::size_t>(members_[leader]) + k % 3];
}

void SparseRows::add_free_motion(std::span<const int> problem_row,
                                 const linalg::Factorisation& factor, VectorX& row_motion) const {
  const VectorX& motion = factor.free_motion();
  const auto rows = plan_.persistent();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int row = problem_row[static_cast<std::size_t>(rows[k])];
    row_motion[row] += motion[static_cast<Eigen::Index>(k)];
  }
}

void SparseRows::add_motions(std::span<const int> problem_row, const VectorX& motion,
                             VectorX& row_motion) const {
  const auto moves = [&](const linalg::BorderPattern& pattern, std::span<const double> values,
                         std::size_t k) {
    double sum = 0.0;
    for (auto e = pattern.row_start[k]; e < pattern.row_start[k + 1]; ++e) {
      const Eigen::Map<const Vector3> value(values.data() + 3 * static_cast<std::size_t>(e));
      sum += value.dot(motion.segment<3>(3 * pattern.node[static_cast<std::size_t>(e)]));
    }
    return sum;
  };
  const auto rows = plan_.persistent();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int row = problem_row[static_cast<std::size_t>(rows[k])];
    row_motion[row] += moves(plan_.border(), border_, k);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(transient_.rows()); ++k) {
    row_motion[transient_row(k, problem_row)] += moves(transient_, transient_values_, k);
  }
}

void SparseRows::add_transient_compliance(std::span<const int> problem_row,
                                          linalg::Factorisation& factor, MatrixX& compliance,
                                          VectorX& free_motion) const {
  factor.condense_transient(transient_, transient_values_);
  const MatrixX& own = factor.transient_compliance();
  const MatrixX& coupling = factor.transient_coupling();
  const auto rows = plan_.persistent();
  const auto row_of = [&](Eigen::Index k) {
    return transient_row(static_cast<std::size_t>(k), problem_row);
  };
  const auto count = static_cast<Eigen::Index>(transient_.rows());
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = row_of(j);
    free_motion[column] += coupling(j, static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
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

std::span<const double> SparseRows::persistent_effort(std::span<const double> effort) {
  const auto rows = plan_.persistent();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    persistent_effort_[k] = effort[static_cast<std::size_t>(rows[k])];
  }
  return persistent_effort_;
}

std::size_t SparseRows::bytes() const {
  const std::size_t numbers = border_.size() + transient_values_.capacity();
  const std::size_t integers = members_.capacity() + member_start_.capacity() + blocks_.capacity();
  return sizeof(double) * numbers + sizeof(std::int32_t) * integers;
}

}  // namespace sinew::mechanics
