/// @file
/// Dense arrays whose sizes change from step to step. Their memory grows and is kept.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/StdVector>

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// Aligned numbers for Eigen. Its order of summation depends on the alignment, so a fixed alignment
/// is needed for the same bits in every run.
using AlignedNumbers = std::vector<double, Eigen::aligned_allocator<double>>;

/// Makes room for at least `size` entries; never shrinks.
template <class Vector>
void grow(Vector& memory, std::size_t size) {
  if (memory.size() < size) memory.resize(std::max(size, 2 * memory.size()));
}

/// A matrix of changing shape that allocates only when it becomes larger than ever before.
class ScratchMatrix {
 public:
  /// Sets the shape; entries are then undefined. @param rows,columns the new shape.
  Eigen::Map<MatrixX> shape(Eigen::Index rows, Eigen::Index columns) {
    rows_ = rows;
    columns_ = columns;
    grow(numbers_, static_cast<std::size_t>(rows * columns));
    return view();
  }
  Eigen::Map<MatrixX> view() { return {numbers_.data(), rows_, columns_}; }
  Eigen::Map<const MatrixX> view() const { return {numbers_.data(), rows_, columns_}; }

 private:
  AlignedNumbers numbers_;
  Eigen::Index rows_ = 0, columns_ = 0;
};

}  // namespace sinew::linalg
