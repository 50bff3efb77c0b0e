#include "sinew/plan/point_derivatives.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace sinew::plan {

namespace {

constexpr std::size_t kDirections = 8, kGroup = kDirections / 2;

}  // namespace

PointDerivatives::PointDerivatives(std::shared_ptr<const pcc::Arm> arm)
    : dynamics_(std::move(arm)), n_(static_cast<std::size_t>(dynamics_.arm().coordinates())) {
  q_.resize(n_);
  rate_.resize(n_);
  still_.resize(n_);
}

template <typename Of>
void PointDerivatives::evaluate(const VectorX& q, const VectorX& rate, std::size_t variables,
                                const std::vector<pcc::ArmPoint>& points, const Of& of) {
  for (std::size_t k = 0; k < n_; ++k) {
    q_[k] = q[static_cast<Eigen::Index>(k)];
    rate_[k] = rate[static_cast<Eigen::Index>(k)];
  }
  const auto variable = [&](std::size_t k) -> Number& { return k < n_ ? q_[k] : rate_[k - n_]; };
  results_.resize(points.size());
  const auto size = static_cast<Eigen::Index>(variables);
  for (VectorDerivatives& result : results_) {
    result.jacobian.resize(3, size);
    for (MatrixX& hessian : result.hessian) hessian.resize(size, size);
  }
  // Every pair of groups shares a pass, so that every pair of variables does; one group goes alone.
  const std::size_t groups = (variables + kGroup - 1) / kGroup;
  std::array<std::size_t, kDirections> used_for{};
  for (std::size_t a = 0; a < groups; ++a) {
    for (std::size_t b = groups > 1 ? a + 1 : a; b < groups; ++b) {
      std::size_t used = 0;
      const auto take = [&](std::size_t group) {
        const std::size_t end = std::min(variables, (group + 1) * kGroup);
        for (std::size_t k = group * kGroup; k < end; ++k) used_for[used++] = k;
      };
      take(a);
      if (b != a) take(b);
      for (std::size_t d = 0; d < used; ++d) variable(used_for[d]).grad[d] = 1.0;
      dynamics_.set(std::span<const Number>(q_), std::span<const Number>(rate_),
                    std::span<const Number>(still_));
      for (std::size_t p = 0; p < points.size(); ++p) {
        const pcc::Vec3<Number> found = of(points[p]);
        const std::array<const Number*, 3> parts{&found.x, &found.y, &found.z};
        for (std::size_t x = 0; x < 3; ++x) {
          const auto row = static_cast<Eigen::Index>(x);
          results_[p].value[row] = parts[x]->value;
          for (std::size_t i = 0; i < used; ++i) {
            const auto at = static_cast<Eigen::Index>(used_for[i]);
            results_[p].jacobian(row, at) = parts[x]->grad[i];
            for (std::size_t j = 0; j < used; ++j) {
              results_[p].hessian[x](at, static_cast<Eigen::Index>(used_for[j])) =
                  parts[x]->hess[i][j];
            }
          }
        }
      }
      for (std::size_t d = 0; d < used; ++d) variable(used_for[d]).grad[d] = 0.0;
    }
  }
}

const std::vector<VectorDerivatives>& PointDerivatives::positions(
    const VectorX& q, const std::vector<pcc::ArmPoint>& points) {
  evaluate(q, VectorX::Zero(q.size()), n_, points,
           [&](const pcc::ArmPoint& point) { return dynamics_.position(point); });
  return results_;
}

const VectorDerivatives& PointDerivatives::velocity(const VectorX& q, const VectorX& rate,
                                                    const pcc::ArmPoint& point) {
  evaluate(q, rate, 2 * n_, {point},
           [&](const pcc::ArmPoint& of) { return dynamics_.velocity(of); });
  return results_.front();
}

}  // namespace sinew::plan
