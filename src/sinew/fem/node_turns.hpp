/// @file
/// Rotations of the material around nodes since a factorisation.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::fem {

class FemModel;

/// Lets a factor of A be used at a later state. Where the material around nodes has turned by R
/// (block-diagonal, over free nodes) and strained little, the matrix there is about
///   A' = R A R^T,   hence   A'^-1 r = R A^-1 R^T r,
/// as the stiffness of every corotated element (M. Mueller, M. Gross, Graphics Interface 2004).
/// Without R, the axial forces by which a slender robot opposes a rotation t would seem to push
/// across it: A^-1 r is then too large by t (L/h)^2, and does not contract.
/// R is that of one element at each node: the rotation of its deformation since the factorisation,
/// to first order in strain and rotation.
class NodeTurns {
 public:
  explicit NodeTurns(const FemModel& model);

  /// Starts at the positions of a factorisation. @param positions (n, 3) m.
  void start(const Points& positions);
  /// Measures the rotations since. @param positions (n, 3) m.
  void measure(const Points& positions);
  /// v = R^T v, and v = R v. @param v (3 free nodes,).
  void turn_back(VectorX& v) const;
  void turn(VectorX& v) const;
  std::size_t bytes() const;

 private:
  std::vector<std::array<NodeId, 4>> elements_;  // four nodes of each element that is used
  std::vector<int> element_of_;  // (free nodes,) index in elements_; -1: the node does not turn
  Points start_;                 // (n, 3) m
  bool measures_ = false;        // whether the next are known for start_
  std::vector<Matrix3> start_inverse_;  // (elements_,) of the edges there, 1/m
  std::vector<Matrix3> rotations_;      // (elements_,)
};

}  // namespace sinew::fem
