#include "sinew/contact/row_numbering.hpp"

#include <algorithm>

namespace sinew::contact {

void RowNumbering::number(const mechanics::RowValues& rows) {
  model_rows_.clear();
  members_.clear();
  problem_rows_.assign(rows.active.size(), -1);
  for (std::size_t row = 0; row < problem_rows_.size(); ++row) {
    if (rows.active[row] == 0 || !rows.groups.leads(static_cast<int>(row))) continue;
    const auto own = static_cast<int>(model_rows_.size());
    rows.groups.for_each_member(static_cast<int>(row), [&](int member, double share) {
      problem_rows_[static_cast<std::size_t>(member)] = own;
      if (!rows.groups.empty()) members_.push_back({member, own, share});
    });
    model_rows_.push_back(static_cast<int>(row));
  }
}

void RowNumbering::gather_motions(const VectorX& all, VectorX& result) const {
  result.resize(static_cast<Eigen::Index>(model_rows_.size()));
  if (members_.empty()) {
    for (std::size_t k = 0; k < model_rows_.size(); ++k) {
      result[static_cast<Eigen::Index>(k)] = all[model_rows_[k]];
    }
    return;
  }
  result.setZero();
  for (const Member& member : members_) {
    result[member.problem_row] += member.share * all[member.row];
  }
}

void RowNumbering::gather_efforts(std::span<const double> all,
                                  linalg::AlignedNumbers& result) const {
  result.assign(model_rows_.size(), 0.0);
  if (members_.empty()) {
    for (std::size_t k = 0; k < model_rows_.size(); ++k) {
      result[k] = all[static_cast<std::size_t>(model_rows_[k])];
    }
    return;
  }
  for (const Member& member : members_) {
    result[static_cast<std::size_t>(member.problem_row)] +=
        all[static_cast<std::size_t>(member.row)];
  }
}

void RowNumbering::scatter_efforts(const linalg::AlignedNumbers& numbers,
                                   std::span<double> all) const {
  std::ranges::fill(all, 0.0);
  if (members_.empty()) {
    for (std::size_t k = 0; k < model_rows_.size(); ++k) {
      all[static_cast<std::size_t>(model_rows_[k])] = numbers[k];
    }
    return;
  }
  for (const Member& member : members_) {
    all[static_cast<std::size_t>(member.row)] =
        member.share * numbers[static_cast<std::size_t>(member.problem_row)];
  }
}

void RowNumbering::spread(int row, double effort, std::span<double> all) const {
  if (members_.empty()) {
    all[static_cast<std::size_t>(model_row_of(row))] = effort;
    return;
  }
  for (const Member& member : members_) {
    if (member.problem_row == row) {
      all[static_cast<std::size_t>(member.row)] = member.share * effort;
    }
  }
}

}  // namespace sinew::contact
