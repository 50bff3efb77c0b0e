/// @file
/// The geometric stiffness of constraint rows on an arm.
#pragma once

#include <memory>
#include <vector>

#include "sinew/core/dual.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/arm_state.hpp"

namespace sinew::pcc {

/// Computes the geometric stiffness of rows. Points move on curves, so the generalised force of a
/// row changes with the coordinates even if its direction is constant.
class RowStiffness {
 public:
  /// @param model must outlive this.
  explicit RowStiffness(const ArmBodyModel& model);

  /// Computes A -= sum over entries of effort direction . d2x/dq2, with the last efforts and
  /// directions of the rows. @param state of the arm. @param matrix A, (coordinates, coordinates).
  void add(const ArmState& state, MatrixX& matrix);

 private:
  bool pulls(const mechanics::OwnRows::Entry& entry, const ArmState& state) const;

  const ArmBodyModel& model_;
  ArmDynamics<Dual<8>> slopes_;
  std::vector<Vec3<Dual<8>>> columns_;
  std::vector<Dual<8>> q_;
};

}  // namespace sinew::pcc
