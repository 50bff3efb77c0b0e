/// @file
/// Conversions between Eigen matrices and lanes, and deformation gradients for tests.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/material/lanes.hpp"

namespace sinew::material {

inline void set_lane(Lanes3x3& target, int lane, const Matrix3& m) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) target[r][c][lane] = m(r, c);
  }
}

inline Lanes3x3 broadcast(const Matrix3& m) {
  Lanes3x3 result{};
  for (int lane = 0; lane < kLanes; ++lane) set_lane(result, lane, m);
  return result;
}

inline Matrix3 lane_of(const Lanes3x3& m, int lane) {
  Matrix3 result;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = m[r][c][lane];
  }
  return result;
}

class RandomMatrices {
 public:
  Matrix3 entries(double size) {
    return Matrix3::NullaryExpr(
        [&](Eigen::Index, Eigen::Index) { return size * uniform_(random_); });
  }
  Matrix3 rotation() {
    Eigen::Quaterniond q(normal_(random_), normal_(random_), normal_(random_), normal_(random_));
    return q.normalized().toRotationMatrix();
  }
  Matrix3 with_stretches(double a, double b, double c) {
    return rotation() * Vector3(a, b, c).asDiagonal() * rotation().transpose();
  }
  double uniform() { return uniform_(random_); }

 private:
  std::mt19937 random_{3};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  std::normal_distribution<double> normal_;
};

/// Named deformation gradients that cover all cases in which the derivative of R exists.
inline std::vector<std::pair<std::string, Matrix3>> deformation_gradients() {
  RandomMatrices random;
  std::vector<std::pair<std::string, Matrix3>> result{{"identity", Matrix3::Identity()}};
  for (int k = 0; k < 5; ++k) {
    result.emplace_back("near identity", Matrix3::Identity() + random.entries(1e-3));
    result.emplace_back("moderate", Matrix3::Identity() + random.entries(0.4));
    result.emplace_back("large rotation",
                        random.rotation() * (Matrix3::Identity() + random.entries(0.1)));
    result.emplace_back("half turn", Vector3(-1.0, -1.0, 1.0).asDiagonal() *
                                         (Matrix3::Identity() + random.entries(0.1)));
    result.emplace_back("two equal stretches", random.with_stretches(1.3, 1.3, 0.7));
    result.emplace_back("three equal stretches", random.with_stretches(0.8, 0.8, 0.8));
    result.emplace_back("near inverted", random.with_stretches(1.2, 0.9, 0.01));
    result.emplace_back("flat", random.with_stretches(1.2, 0.9, 0.0));
    result.emplace_back("inverted", random.with_stretches(1.1, 0.9, -0.3));
    result.emplace_back("strongly inverted", random.with_stretches(1.2, 1.0, -0.8));
    result.emplace_back("stretched threefold", random.with_stretches(3.0, 0.6, 0.55));
    result.emplace_back("crushed to a needle", random.with_stretches(1.0, 0.05, 0.04));
  }
  return result;
}

}  // namespace sinew::material
