/// @file
/// Parts of a cone problem that W does not couple, and which of them are statically indeterminate.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/least_forces.hpp"

namespace sinew::qp {

/// What the choice of forces needs to know of a problem besides its laws.
struct ForceScales {
  std::span<const double> unit;   ///< (n,) effort per newton: 1 for forces, m for moments, 1/m^2
  std::span<const double> alone;  ///< (n,) W_ii before anything was eliminated
  std::span<const char> rigid;    ///< (cones,) whether both sides of the point have few coordinates
  double rounding = 0.0;          ///< m: motions below this are rounding
};

/// Blocks that W couples, directly or through others. Blocks are numbered: boxes, then cones.
struct ForcePart {
  int first = 0, count = 0;  ///< of ForceParts::blocks()
  int rows = 0;
  bool mixed = false;  ///< coupled with points of deformable bodies, which are no part of it
  bool large = false;  ///< above ForceParts::kMaxWork
  bool rests = false;

  /// Whether its law is solved with a small compliance first.
  bool moves_alone() const { return !rests && !mixed && !large; }
};

/// Rows of some blocks of a part: W between them, in newtons and metres, and the sets of their
/// efforts.
struct ForceRows {
  std::vector<EffortSet> sets;
  std::vector<int> rows;         ///< (m,) of the problem
  linalg::ScratchMatrix matrix;  ///< (m, m)
  std::vector<double> own;       ///< (m,) as LeastForces::factorise() needs it

  void clear();
  /// Adds the rows of a set that starts at a row of the problem.
  void add(EffortSet set, int row);
  /// Fills in `matrix` and `own`.
  void gather(const ConeProblem& problem, const ForceScales& scales);
};

/// Finds the indeterminate parts: boxes and rigid cones whose W has a rank below its rows.
class ForceParts {
 public:
  /// Rows of a part up to which it is treated.
  static constexpr int kMaxRows = 400;
  /// Rows times rank squared up to which forces are also chosen where the part moves. Beyond it
  /// that would cost more than the law.
  static constexpr double kMaxWork = 1.5e6;

  /// @param problem,scales of the step. @param solver,rows for its own use.
  void find(const ConeProblem& problem, const ForceScales& scales, LeastForces& solver,
            ForceRows& rows);
  std::span<ForcePart> parts() { return parts_; }
  std::span<const ForcePart> parts() const { return parts_; }
  /// Blocks of a part, ascending.
  std::span<const int> blocks(const ForcePart& part) const {
    return std::span(blocks_).subspan(static_cast<std::size_t>(part.first),
                                      static_cast<std::size_t>(part.count));
  }

 private:
  int root(int node);
  void unite(const ConeProblem& problem, const ForceScales& scales);
  bool is_mixed(const ConeProblem& problem, const ForceScales& scales, const ForcePart& part) const;

  std::vector<int> nodes_;   // blocks that take part
  std::vector<int> parent_;  // (nodes,)
  std::vector<int> blocks_;
  std::vector<ForcePart> parts_;
};

/// Row of a block, and the number of its rows that its law concerns: without friction, a contact
/// has one.
struct BlockRows {
  int row, count;
};
BlockRows rows_of(const ConeProblem& problem, int block);

}  // namespace sinew::qp
