/// @file
/// A finite-element robot in one simulation.
#pragma once

#include <memory>

#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"

namespace sinew {
class ThreadPool;
}

namespace sinew::fem {

class FemBodyModel;
struct FemState;
class FemStep;

/// A finite-element body in one simulation: a FemState, and a FemStep for its steps.
class FemBody : public mechanics::Body,
                public mechanics::TakesForces,
                public mechanics::HasBase,
                public mechanics::TakesLoads,
                public mechanics::HasSurfaceNodes,
                public mechanics::ScalesStiffness,
                public HasMaterial {
 public:
  /// @param model,pool must outlive the body.
  /// @param with_geometric_stiffness,histories see mechanics::BodyModel::create().
  FemBody(const FemBodyModel& model, ThreadPool& pool, bool with_geometric_stiffness,
          int histories = 0);
  ~FemBody() override;

  const mechanics::BodyModel& model() const override;
  Vector3 position(int point) const override;
  Vector3 velocity(int point) const override;
  const Points& positions() const override;
  const Points& velocities() const override;
  const Points& surface_nodes() const override { return positions(); }
  const Points& surface_node_velocities() const override { return velocities(); }
  mechanics::Energies energies() override;
  void restart() override;
  std::size_t state_size() const override;
  void save_state(std::span<double> state) const override;
  void load_state(std::span<const double> state) override;
  mechanics::StepSystem& system() override;
  const mechanics::StepSystem& system() const override;
  std::size_t bytes() const override;

  Points& external_forces() override;
  const Points& external_forces() const override;
  void set_tether(const std::optional<mechanics::Tether>& tether) override;
  const std::optional<mechanics::Tether>& tether() const override;
  Vector3 tether_point() const override;

  bool base_can_move() const override;
  void move_base(const std::optional<mechanics::AffineField>& displacement) override;
  const std::optional<mechanics::AffineField>& base_input() const override;

  bool base_moved() const override;
  Carried carried(int site, const mechanics::Patch* patch) const override;

  void set_load_factor(int load, double factor) override;
  Vector3 load_force() const override;
  Points load_forces() const override;

  const HasElements& material() const override;
  const ElementHistory& history() const override;
  double stiffness_factor() const override;
  void set_stiffness_factor(double factor) override;
  void add_row_forces(std::span<const double> effort, Points& forces) const override;

 private:
  std::unique_ptr<FemState> state_;
  std::unique_ptr<FemStep> step_;
};

}  // namespace sinew::fem
