/// @file
/// A rigid body in a simulation.
#pragma once

#include <memory>

#include <Eigen/Geometry>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/rigid_base.hpp"

namespace sinew::rigid {

class RigidBodyModel;
class RigidNodes;
class RigidStep;
struct RigidState;

/// A rigid body: it owns its state, and the RigidStep that advances it.
class RigidBody : public mechanics::Body,
                  public mechanics::HasOrientations,
                  public mechanics::HasBase,
                  public mechanics::HasRigidBase,
                  public mechanics::HasPose,
                  public mechanics::TakesLoads,
                  public mechanics::HasSurfaceNodes {
 public:
  /// @param model must outlive the body. @param histories see mechanics::BodyModel::create().
  RigidBody(const RigidBodyModel& model, int histories);
  ~RigidBody() override;

  const mechanics::BodyModel& model() const override;
  Vector3 position(int point) const override;
  Vector3 velocity(int site) const override;
  const Points& positions() const override;
  const Points& velocities() const override;
  const Points& surface_nodes() const override;
  const Points& surface_node_velocities() const override;
  mechanics::Energies energies() override;
  void restart() override;
  std::size_t state_size() const override;
  void save_state(std::span<double> state) const override;
  void load_state(std::span<const double> state) override;
  mechanics::StepSystem& system() override;
  const mechanics::StepSystem& system() const override;
  std::size_t bytes() const override;

  bool base_can_move() const override;
  void move_base(const std::optional<mechanics::AffineField>& displacement) override;
  const std::optional<mechanics::AffineField>& base_input() const override;
  bool base_moved() const override;
  Carried carried(int site, const mechanics::Patch* patch) const override;
  void follow_base() override;
  void set_base_rate(const Vector3& linear, const Vector3& angular) override;

  void set_load_factor(int load, double factor) override;
  Vector3 load_force() const override;
  Vector3 load_moment() const override;

  Matrix3 rotation(int orientation) const override;
  Vector3 origin() const override;
  Vector3 centre_of_mass() const override;
  Matrix3 axes() const override;
  Vector3 linear_velocity() const override;
  Vector3 angular_velocity() const override;
  void put_pose(const Vector3& origin, const Eigen::Quaterniond& axes,
                std::span<double> state) const override;

 private:
  const RigidBodyModel& model_;
  std::unique_ptr<RigidState> state_;
  std::unique_ptr<RigidStep> step_;
  std::unique_ptr<RigidNodes> skin_, surface_;
};

}  // namespace sinew::rigid
