/// @file
/// A kind of body that the library does not know: a point with mass on a spring to its rest
/// position, m a + k (x - x_0) = m g + forces. It has no mesh, no surface and no elements.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/dense_step.hpp"

namespace sinew::testing {

struct SpringPointSettings {
  std::string name = "point";
  Vector3 at = Vector3::Zero();  ///< m, rest position
  double mass = 0.1;             ///< kg
  double stiffness = 50.0;       ///< N/m
  Vector3 gravity{0.0, 0.0, -9.81};
};

class SpringPointModel : public mechanics::BodyModel {
 public:
  explicit SpringPointModel(SpringPointSettings settings) : own(std::move(settings)) {}

  const std::string& name() const override { return own.name; }
  int attach(const Vector3&, mesh::Outside, const std::string&) override { return sites_++; }
  int attach_ball(const Vector3&, double, mesh::Outside, const std::string&) override {
    return sites_++;
  }
  int attach_nodes(std::span<const NodeId>, std::span<const double>) override { return sites_++; }
  int attach_mean(const Points&, mesh::Outside, const std::string&) override { return sites_++; }
  std::vector<int> attach_anchors(std::span<const NodeId>) override { return {sites_++}; }
  Vector3 rest_position(int) const override { return own.at; }
  void finish(int body, const mechanics::RowPattern& rows,
              std::span<const mechanics::StiffnessPair>) override {
    own_rows = mechanics::OwnRows(body, rows);
  }
  bool couples(int, int) const override { return true; }
  std::vector<mechanics::HeldDirection> held_directions() const override {
    return mechanics::held_as_a_whole(own.at);
  }
  bool is_loaded() const override { return own.mass * own.gravity.norm() > 0.0; }
  bool has_memory() const override { return false; }
  double stiffness_scale() const override { return own.stiffness; }
  bool has_inertia() const override { return own.mass > 0.0; }
  double size() const override { return 0.01; }
  bool has_few_coordinates() const override { return true; }
  void describe(PartsVisitor& parts) const override {
    parts.part("spring")
        .add(own.at)
        .number("mass", "kg", own.mass)
        .number("stiffness", "N/m", own.stiffness)
        .number("gravity", "m/s^2", own.gravity);
  }
  std::uint64_t site_hash(int) const override { return 0; }
  std::unique_ptr<mechanics::Body> create(ThreadPool&, bool, int histories) const override;

  SpringPointSettings own;
  mechanics::OwnRows own_rows;

 private:
  int sites_ = 0;
};

class SpringPoint : public mechanics::Body, public mechanics::DenseStep {
 public:
  SpringPoint(const SpringPointModel& model, int histories)
      : DenseStep(3, model.own_rows, memory_),
        model_(model),
        memory_(model.own_rows),
        history_(static_cast<std::size_t>(histories), Vector3::Zero()) {
    SpringPoint::restart();
  }

  // Body
  const mechanics::BodyModel& model() const override { return model_; }
  Vector3 position(int) const override { return q_.row(0); }
  Vector3 velocity(int) const override { return v_.row(0); }
  const Points& positions() const override { return q_; }
  const Points& velocities() const override { return v_; }
  mechanics::Energies energies() override {
    const Vector3 moved = now() - model_.own.at;
    mechanics::Energies energies;
    energies.strain = 0.5 * model_.own.stiffness * moved.squaredNorm();
    energies.kinetic = 0.5 * model_.own.mass * v_.squaredNorm();
    energies.gravity = -model_.own.mass * model_.own.gravity.dot(moved);
    return energies;
  }
  void restart() override {
    q_.row(0) = start_.row(0) = model_.own.at.transpose();
    v_.setZero();
    for (Vector3& kept : history_) kept.setZero();
    memory_.restart();
  }
  std::size_t state_size() const override { return 6 + 3 * history_.size() + memory_.size(); }
  void save_state(std::span<double> state) const override {
    double* to = std::copy_n(q_.data(), 3, state.data());
    to = std::copy_n(v_.data(), 3, to);
    for (const Vector3& kept : history_) to = std::copy_n(kept.data(), 3, to);
    memory_.save(to);
  }
  void load_state(std::span<const double> state) override {
    const double* from = state.data();
    for (double* to : {q_.data(), v_.data()}) {
      std::copy_n(from, 3, to);
      from += 3;
    }
    for (Vector3& kept : history_) {
      std::copy_n(from, 3, kept.data());
      from += 3;
    }
    memory_.load(from);
    start_ = q_;
  }
  mechanics::StepSystem& system() override { return *this; }
  const mechanics::StepSystem& system() const override { return *this; }
  std::size_t bytes() const override { return DenseStep::bytes() + sizeof *this; }

  // StepSystem
  void begin_step() override { start_ = q_; }
  double rounding_floor() const override {
    return kEpsilon * q_.cwiseAbs().maxCoeff() * matrix().diagonal().norm();
  }
  double proposed_move() const override { return motion().cwiseAbs().maxCoeff(); }
  mechanics::MotionReport apply_motion(double scale) override {
    q_.row(0) = from_ + scale * motion().transpose();
    return {q_.allFinite(), std::abs(scale) * proposed_move(), {}};
  }
  void find_acceleration(const mechanics::StepWeights& weights,
                         std::span<double> acceleration) override {
    Eigen::Map<Vector3>(acceleration.data()) = combine(weights.acceleration);
  }
  void apply_mass(std::span<const double> motion, std::span<double> result) override {
    for (std::size_t k = 0; k < 3; ++k) result[k] = model_.own.mass * motion[k];
  }
  mechanics::StepEnd end_step(const mechanics::StepWeights& weights) override {
    if (!weights.dynamic()) {
      v_.setZero();
      return {};
    }
    const Vector3 rate = combine(weights.velocity);
    if (!history_.empty()) {
      const Vector3 first = combine(weights.first), second = combine(weights.second);
      history_ = {first, second};
    }
    v_.row(0) = rate.transpose();
    return {};
  }
  void scale_motion(double factor) override { q_ = start_ + factor * (q_ - start_); }
  void add_velocity(std::span<const double> change) override {
    v_ += Eigen::Map<const Eigen::RowVector3d>(change.data());
  }

 private:
  Vector3 now() const { return q_.row(0); }
  Vector3 combine(const mechanics::Combination& weights) const {
    Vector3 sum = weights.motion * (q_ - start_).transpose() + weights.velocity * v_.transpose();
    if (!history_.empty()) sum += weights.first * history_[0] + weights.second * history_[1];
    return sum;
  }
  double form(const mechanics::LinearisationRequest& request, VectorX& right,
              MatrixX& matrix) override {
    const Vector3 weight = model_.own.mass * model_.own.gravity;
    const Vector3 spring = model_.own.stiffness * (model_.own.at - now());
    right = weight + spring;
    matrix = model_.own.stiffness * MatrixX::Identity(3, 3);
    if (request.weights.dynamic()) {
      right -= model_.own.mass * combine(request.weights.acceleration);
      matrix.diagonal().array() += model_.own.mass * request.weights.acceleration.motion;
    }
    return 1e-6 * model_.own.stiffness * model_.size() + weight.norm() + spring.norm();
  }
  void add_row_stiffness(MatrixX&) override {}
  void site_jacobian(int, MatrixX& result) const override { result.setIdentity(3, 3); }
  double softest() const override { return 0.0; }
  void depart() override { from_ = q_; }
  void drift(double time_step, VectorX& motion) const override {
    motion = time_step * v_.transpose();
  }

  const SpringPointModel& model_;
  mechanics::RowMemory memory_;
  std::vector<Vector3> history_;
  Points q_ = Points::Zero(1, 3), v_ = Points::Zero(1, 3), start_ = q_;
  Eigen::RowVector3d from_ = Eigen::RowVector3d::Zero();
};

inline std::unique_ptr<mechanics::Body> SpringPointModel::create(ThreadPool&, bool,
                                                                 int histories) const {
  return std::make_unique<SpringPoint>(*this, histories);
}

}  // namespace sinew::testing
