/// @file
/// What constraint rows make an arm stiffer by.
#pragma once

#include <memory>
#include <vector>

#include "sinew/core/dual.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/pcc/arm_state.hpp"

namespace sinew::pcc {

/// Points move on curves: what rows pull with changes as the arm bends even where its direction
/// stays.
class RowStiffness {
 public:
  /// @param model must outlive this.
  explicit RowStiffness(const ArmBodyModel& model);

  /// A -= sum over entries of effort direction . d2x/dq2, at the efforts and directions known last.
  /// @param state of the arm now. @param matrix A, (coordinates, coordinates).
  void add(const ArmState& state, MatrixX& matrix);

 private:
  bool pulls(const mechanics::OwnRows::Entry& entry, const ArmState& state) const;

  const ArmBodyModel& model_;
  ArmDynamics<Dual<8>> slopes_;
  std::vector<Vec3<Dual<8>>> columns_;
  std::vector<Dual<8>> q_;
};

}  // namespace sinew::pcc
