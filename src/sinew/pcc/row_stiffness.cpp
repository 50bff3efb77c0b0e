#include "sinew/pcc/row_stiffness.hpp"

namespace sinew::pcc {

RowStiffness::RowStiffness(const ArmBodyModel& model)
    : model_(model),
      slopes_(model.shared_arm()),
      columns_(static_cast<std::size_t>(model.arm().coordinates())),
      q_(columns_.size()) {}

void RowStiffness::add(const ArmState& state, MatrixX& matrix) {
  if (state.memory.effort.size() == 0 || state.memory.effort.isZero(0.0)) return;
  const std::size_t n = q_.size();
  using Kind = ArmBodyModel::Attachment::Kind;
  for (std::size_t k = 0; k < n; ++k) q_[k] = state.q[static_cast<Eigen::Index>(k)];
  const auto direction = [&](std::size_t k) -> Dual<8>::Lanes& { return q_[k].grad; };
  in_passes<8>(n, direction, [&](std::size_t from, std::size_t used) {
    slopes_.place(q_);
    for (std::size_t e = 0; e < model_.own_rows().entries.size(); ++e) {
      const auto& entry = model_.own_rows().entries[e];
      const auto& attachment = model_.attachment(entry.site);
      const double effort = state.memory.effort[entry.row];
      if (effort == 0.0 || attachment.kind == Kind::coordinate) continue;
      const Vector3 pull = effort * state.memory.directions[e];
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
