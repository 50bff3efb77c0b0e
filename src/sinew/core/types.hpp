/// @file
/// Numeric types that all folders share. All values are in SI units.
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace sinew {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

/// Points or vectors, one per row: (n, 3), row-major, the layout of a NumPy array.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A stored number of a node, element or degree of freedom. Sizes and loops use Eigen::Index or
/// size_t.
using NodeId = std::int32_t;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace sinew
