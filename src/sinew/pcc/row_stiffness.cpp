#include "sinew/pcc/row_stiffness.hpp"

#include <algorithm>

namespace sinew::pcc {

namespace {

using Kind = ArmBodyModel::Attachment::Kind;

}  // namespace

RowStiffness::RowStiffness(const ArmBodyModel& model)
    : model_(model),
      slopes_(model.shared_arm()),
      columns_(static_cast<std::size_t>(model.arm().coordinates())),
      q_(columns_.size()) {}

// Whether an entry has geometric stiffness. The Jacobian of a row on a coordinate is constant.
bool RowStiffness::pulls(const mechanics::OwnRows::Entry& entry, const ArmState& state) const {
  return state.memory.effort[entry.row] != 0.0 &&
         model_.attachment(entry.site).kind != Kind::coordinate;
}

void RowStiffness::add(const ArmState& state, MatrixX& matrix) {
  const auto& entries = model_.own_rows().entries;
  const auto one_pulls = [&](const auto& entry) { return pulls(entry, state); };
  if (std::ranges::none_of(entries, one_pulls)) return;
  const std::size_t n = q_.size();
  for (std::size_t k = 0; k < n; ++k) q_[k] = state.q[static_cast<Eigen::Index>(k)];
  const auto direction = [&](std::size_t k) -> Dual<8>::Lanes& { return q_[k].grad; };
  in_passes<8>(n, direction, [&](std::size_t from, std::size_t used) {
    slopes_.place(q_);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      if (!pulls(entries[e], state)) continue;
      const auto& attachment = model_.attachment(entries[e].site);
      const Vector3 pull = state.memory.effort[entries[e].row] * state.memory.directions[e];
      if (attachment.kind == Kind::point) {
        slopes_.jacobian(attachment.point, columns_);
      } else {
        slopes_.angular_jacobian(attachment.point, columns_);
      }
      for (std::size_t i = 0; i < n; ++i) {
        const auto& column = columns_[i];
        for (std::size_t d = 0; d < used; ++d) {
          matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(from + d)) -=
              pull.x() * column.x.grad[d] + pull.y() * column.y.grad[d] +
              pull.z() * column.z.grad[d];
        }
      }
    }
  });
}

}  // namespace sinew::pcc
