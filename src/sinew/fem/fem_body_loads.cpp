// What FemBody does with the loads of its surroundings.
#include <cmath>

#include <Eigen/QR>

#include "sinew/fem/fem_body.hpp"
#include "sinew/fem/fem_body_numbers.hpp"
#include "sinew/linalg/block_product.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/positive_part.hpp"

namespace sinew::fem {

namespace {

constexpr int kMostDirections = 60;  // of GMRES
constexpr double kTolerance = 1e-12;

}  // namespace

void FemBody::apply_loads(const mechanics::LinearisationRequest& request) {
  const LoadSet& loads = model_.loads();
  const auto& weights = request.weights;
  load_forces_.setZero();
  drag_forces_.setZero();
  load_stiffness_.clear();
  open_stiffness_.clear();
  if (loads.moves() && weights.dynamic()) {
    const auto rate = [&](const mechanics::Combination& c, Points& result) {
      result = c.motion * (positions_ - start_positions_) + c.velocity * velocities_;
      if (!history_.empty()) result += c.first * history_[0] + c.second * history_[1];
    };
    rate(weights.velocity, load_rates_);
    rate(weights.acceleration, load_accelerations_);
    // Quadratic drag has no slope where nothing moves yet: one linearisation takes it at the
    // velocity of the start, Newton at that of its iterate.
    load_gaps_.setZero(positions_.rows(), 3);
    if (!request.iterating) {
      load_gaps_ = load_rates_ - velocities_;
      load_rates_ = velocities_;
    }
  }
  const auto free = model_.elements().free_index();
  const auto keep = [&](std::vector<LoadBlock>& blocks, NodeId a, NodeId b, const Matrix3& block) {
    const auto i = free[static_cast<std::size_t>(a)], j = free[static_cast<std::size_t>(b)];
    if (i >= 0 && j >= 0) blocks.push_back({i, j, block});
  };
  LoadSet::AddBlock rest;
  const bool of_statics = !weights.dynamic() || weights.time_step == 0.0;
  if (loads.is_open() && of_statics && request.tangent == mechanics::Tangent::exact) {
    rest = [&](NodeId a, NodeId b, const Matrix3& block) { keep(open_stiffness_, a, b, block); };
  }
  loads.evaluate(
      {positions_, load_rates_, load_gaps_, load_accelerations_, weights.velocity.motion,
       weights.acceleration.motion},
      load_factors_, load_forces_, drag_forces_,
      [&](NodeId a, NodeId b, const Matrix3& block) { keep(load_stiffness_, a, b, block); }, rest);
}

void FemBody::stiffen_by_loads() {
  for (const auto& [row, column, block] : load_stiffness_) {
    if (tangent_ == mechanics::Tangent::exact) {
      active_->assembly.add_block(row, column, block);
    } else {
      add_majorant(row, column, block);
    }
  }
}

// Never less than the block and its transpose: of a diagonal block its positive part; for another
// one |C| I at both ends, since [|C| I, -C; -C^T, |C| I] is positive semi-definite (by its Schur
// complement |C| I - C^T C/|C|).
void FemBody::add_majorant(std::int32_t row, std::int32_t column, const Matrix3& block) {
  if (row == column) {
    active_->assembly.add_block(row, row, linalg::positive_part(block));
    return;
  }
  const Matrix3 bound = block.norm() * Matrix3::Identity();
  active_->assembly.add_block(row, row, bound);
  active_->assembly.add_block(column, column, bound);
}

void FemBody::multiply_blocks(const std::vector<LoadBlock>& blocks, const VectorX& x,
                              VectorX& y) const {
  y.setZero(x.size());
  for (const auto& [row, column, block] : blocks) {
    y.segment<3>(3 * row) += block * x.segment<3>(3 * column);
  }
  for (const std::int32_t held : model_.elements().held()) y[held] = 0.0;
}

// The factor knows the symmetric part A of the tangent, not the rest B that pressure on an open
// surface has: (I + A^-1 B) dq = A^-1 r by GMRES (Saad & Schultz 1986), which needs as many
// directions as the rim of the surface makes B's rank, at most.
void FemBody::correct_for_open_pressure() {
  const double size = motion_.norm();
  if (!(size > 0.0)) return;
  std::vector<VectorX> basis{motion_ / size};
  MatrixX hessenberg = MatrixX::Zero(kMostDirections + 1, kMostDirections);
  VectorX weights;
  VectorX product;
  for (int k = 0; k < kMostDirections; ++k) {
    multiply_blocks(open_stiffness_, basis.back(), product);
    active_->factorisation->solve({product.data(), static_cast<std::size_t>(product.size())},
                                  {product.data(), static_cast<std::size_t>(product.size())});
    product += basis.back();
    for (int j = 0; j <= k; ++j) {
      hessenberg(j, k) = basis[static_cast<std::size_t>(j)].dot(product);
      product -= hessenberg(j, k) * basis[static_cast<std::size_t>(j)];
    }
    hessenberg(k + 1, k) = product.norm();
    VectorX right = VectorX::Zero(k + 2);
    right[0] = size;
    const MatrixX part = hessenberg.topLeftCorner(k + 2, k + 1);
    weights = linalg::least_squares(part, right).x;
    const bool done = (part * weights - right).norm() <= kTolerance * size;
    if (done || !(hessenberg(k + 1, k) > kTolerance * part.norm())) break;
    basis.push_back(product / hessenberg(k + 1, k));
  }
  motion_.setZero();
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    motion_ += weights[k] * basis[static_cast<std::size_t>(k)];
  }
}

void FemBody::add_work(const mechanics::StepWeights& weights) {
  work_ = {};
  const auto& damping = model_.settings().damping;
  if (weights.dynamic() && (damping.mass > 0.0 || damping.stiffness > 0.0)) {
    work_.damped = rayleigh_work(weights);
  }
  if (model_.loads().moves() && weights.dynamic()) {
    // Drag as it is at the end, not as it was linearised.
    mechanics::LinearisationRequest request;
    request.weights = weights;
    request.iterating = true;
    apply_loads(request);
  }
  for (const NodeId node : model_.elements().free_nodes()) {
    const Vector3 d = (positions_.row(node) - start_positions_.row(node)).transpose();
    work_.outside += (external_forces_.row(node) + load_forces_.row(node)).dot(d.transpose());
    work_.damped -= drag_forces_.row(node).dot(d.transpose());
  }
}

// (C v) . d with C = alpha M + beta K as the step had it. K v is without the base's velocity, and
// dissipates in the motion beside the base's: the rest of its work is the base's.
double FemBody::rayleigh_work(const mechanics::StepWeights& weights) {
  const auto& damping = model_.settings().damping;
  const FemModel& elements = *active_->system.elements;
  const auto nodes = model_.elements().free_nodes();
  const auto size = static_cast<std::size_t>(scratch_.size());
  const auto moved = [&](std::int32_t i) -> Vector3 {
    const NodeId node = nodes[static_cast<std::size_t>(i)];
    return (positions_.row(node) - start_positions_.row(node)).transpose();
  };
  const auto strayed = [&](std::int32_t i) -> Vector3 {
    return carried_ ? Vector3(moved(i) - carry_.segment<3>(3 * i)) : moved(i);
  };
  const auto along = [&](const auto& motion, const VectorX& force) {
    double sum = 0.0;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(nodes.size()); ++i) {
      sum += force.segment<3>(3 * i).dot(motion(i));
    }
    return sum;
  };
  double work = 0.0;
  if (damping.mass > 0.0) {
    combine(weights.velocity, travel_);
    elements.apply_mass({travel_.data(), size}, {scratch_.data(), size});
    add_base_momentum(weights.velocity, scratch_);
    work += damping.mass * along(moved, scratch_);
  }
  if (!active_->damped) return work;
  combine_velocity(weights, travel_);
  const std::span<const double> travel(travel_.data(), size);
  const std::span<double> force(scratch_.data(), size);
  linalg::multiply(elements.pattern(), active_->start_stiffness, travel, force);
  return work + damping.stiffness * along(strayed, scratch_);
}

}  // namespace sinew::fem
