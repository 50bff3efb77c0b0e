// A point x(q) moving with q' has v = J q', dv/dq_k = J_k' and dv/dq'_k = J_k. So the columns of
// its Jacobian along the motion contain all first derivatives, and with dual numbers the second
// ones.
#include "sinew/plan/point_derivatives.hpp"

#include <span>
#include <utility>

namespace sinew::plan {

namespace {

constexpr std::size_t kDirections = 8;

void resize(VectorDerivatives& result, Eigen::Index variables) {
  result.jacobian.resize(3, variables);
  for (MatrixX& hessian : result.hessian) hessian.resize(variables, variables);
}

/// Coordinate by coordinate.
template <typename T>
std::array<const T*, 3> parts(const pcc::Vec3<T>& v) {
  return {&v.x, &v.y, &v.z};
}

}  // namespace

PointDerivatives::PointDerivatives(std::shared_ptr<const pcc::Arm> arm)
    : dynamics_(std::move(arm)),
      n_(static_cast<std::size_t>(dynamics_.arm().coordinates())),
      q_(n_),
      columns_(n_) {}

template <typename Take>
void PointDerivatives::pass(const VectorX& q, const VectorX& rate, Eigen::Index variables,
                            const Take& take) {
  for (std::size_t k = 0; k < n_; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    q_[k] = {q[i], rate[i], 0.0, 0.0};
  }
  const auto direction = [&](std::size_t k) -> First::Lanes& {
    return k < n_ ? q_[k].value.grad : q_[k - n_].rate.grad;
  };
  in_passes<kDirections>(static_cast<std::size_t>(variables), direction,
                         [&](std::size_t from, std::size_t used) {
                           dynamics_.place(std::span<const Moving>(q_));
                           take(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(used));
                         });
}

const std::vector<VectorDerivatives>& PointDerivatives::positions(
    const VectorX& q, const std::vector<pcc::ArmPoint>& points) {
  const Eigen::Index n = q.size();
  positions_.resize(points.size());
  for (VectorDerivatives& result : positions_) resize(result, n);
  pass(q, VectorX::Zero(n), n, [&](Eigen::Index from, Eigen::Index used) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      VectorDerivatives& result = positions_[p];
      const pcc::Vec3<Moving> position = dynamics_.position(points[p]);
      dynamics_.jacobian(points[p], columns_);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto row = static_cast<Eigen::Index>(c);
        result.value[row] = parts(position)[c]->value.value;
        for (Eigen::Index k = 0; k < n; ++k) {
          const Moving& slope = *parts(columns_[static_cast<std::size_t>(k)])[c];
          result.jacobian(row, k) = slope.value.value;
          for (Eigen::Index d = 0; d < used; ++d) {
            result.hessian[c](k, from + d) = slope.value.grad[d];
          }
        }
      }
    }
  });
  return positions_;
}

const VectorDerivatives& PointDerivatives::velocity(const VectorX& q, const VectorX& rate,
                                                    const pcc::ArmPoint& point) {
  const Eigen::Index n = q.size();
  resize(velocity_, 2 * n);
  pass(q, rate, 2 * n, [&](Eigen::Index from, Eigen::Index used) {
    const pcc::Vec3<Moving> position = dynamics_.position(point);
    dynamics_.jacobian(point, columns_);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto row = static_cast<Eigen::Index>(c);
      velocity_.value[row] = parts(position)[c]->rate.value;
      for (Eigen::Index k = 0; k < n; ++k) {
        const Moving& slope = *parts(columns_[static_cast<std::size_t>(k)])[c];
        velocity_.jacobian(row, k) = slope.rate.value;
        velocity_.jacobian(row, n + k) = slope.value.value;
        for (Eigen::Index d = 0; d < used; ++d) {
          velocity_.hessian[c](k, from + d) = slope.rate.grad[d];
          velocity_.hessian[c](n + k, from + d) = slope.value.grad[d];
        }
      }
    }
  });
  return velocity_;
}

}  // namespace sinew::plan
