/// @file
/// The blocks of a matrix that pairs of points of a body touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::fem {

class FemBodyModel;
struct FemSystem;

/// Adds the Hessians of pairs of attached points (mechanics::StiffnessPair) to a matrix. Where a
/// pair reaches is found once: cables have the same pairs in every step, and to find a block takes
/// longer than to add to it. Allocates at the first use of a pair only.
class TouchedBlocks {
 public:
  /// @param model must outlive this.
  explicit TouchedBlocks(const FemBodyModel& model) : model_(model) {}
  /// Adds -w_a w_b C to the block of each node a of the first and b of the second point.
  /// @param system whose pattern the matrix has. @param first,second numbers of attachments; a pair
  /// of two points includes its transpose. @param hessian C, N/m. @param matrix of the system.
  void add(const FemSystem& system, int first, int second, const Matrix3& hessian,
           std::span<double> matrix);
  std::size_t bytes() const;

 private:
  enum class Turned { no, yes, both };  // C, its transpose, or the sum of both is added
  struct Target {
    std::int64_t begin = 0;  // of the block in the matrix
    double weight = 0.0;     // -w_a w_b
    Turned turned = Turned::no;
  };
  struct Pair {
    int second = -1;
    std::vector<Target> targets;
  };
  const Pair& find(int first, int second);
  Pair reach(int first, int second) const;

  const FemBodyModel& model_;
  const FemSystem* system_ = nullptr;     // of the targets
  std::vector<std::vector<Pair>> pairs_;  // of each first attachment
};

}  // namespace sinew::fem
