/// @file
/// The few numeric types that every folder shares. SI units everywhere.
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace sinew {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

/// Points or vectors, one a row: (n, 3), row-major, so that it is a NumPy array as it stands.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A stored node, element or degree-of-freedom number. Sizes and loops use Eigen::Index or size_t.
using NodeId = std::int32_t;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace sinew
