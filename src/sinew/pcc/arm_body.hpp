/// @file
/// The body of a constant-curvature arm in a simulation.
#pragma once

#include <memory>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew::pcc {

class ArmBodyModel;
class ArmPose;
struct ArmState;
class ArmStep;

/// The state and kinematics of an arm, and ArmStep for its steps.
class ArmBody : public mechanics::Body,
                public mechanics::HasOrientations,
                public mechanics::HasCoordinates {
 public:
  /// @param model must outlive the body. @param histories see mechanics::BodyModel::create().
  ArmBody(const ArmBodyModel& model, int histories);
  ~ArmBody() override;

  const mechanics::BodyModel& model() const override;
  Vector3 position(int point) const override;
  Vector3 velocity(int site) const override;
  const Points& positions() const override;
  const Points& velocities() const override;
  mechanics::Energies energies() override;
  void restart() override;
  std::size_t state_size() const override;
  void save_state(std::span<double> state) const override;
  void load_state(std::span<const double> state) override;
  mechanics::StepSystem& system() override;
  const mechanics::StepSystem& system() const override;
  std::size_t bytes() const override;

  Matrix3 rotation(int orientation) const override;
  double coordinate(int site) const override;
  const VectorX& coordinates() const override;
  const VectorX& rates() const override;
  void set_coordinates(const VectorX& q, const VectorX& rate) override;

 private:
  const ArmBodyModel& model_;
  std::unique_ptr<ArmState> state_;
  std::unique_ptr<ArmPose> pose_;
  std::unique_ptr<ArmStep> step_;
  double rest_gravity_energy_ = 0.0;  // J
};

}  // namespace sinew::pcc
