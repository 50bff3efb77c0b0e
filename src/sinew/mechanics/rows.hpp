/// @file
/// Rows of the constraint Jacobian H in terms of sites, written by constraints and read by bodies.
/// The motion of row k, which is conjugate to its effort, changes by
///   d(delta_k) = sum direction_e . dx_e
/// over its entries e, where dx_e is the motion of the site of entry e.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rolling_point.hpp"
#include "sinew/mechanics/site.hpp"

namespace sinew::mechanics {

/// The sites of each row, fixed when the model is built. Entry e belongs to row k if
/// row_start[k] <= e < row_start[k + 1].
struct RowPattern {
  std::vector<std::int32_t> row_start{0};
  std::vector<Site> site;
  std::vector<char> transient;  ///< (rows,) 1: transient rows, three for each point

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int entries() const { return static_cast<int>(site.size()); }
  /// Adds a row on `sites`, a range of any kind of site, and returns its number.
  template <class Sites = std::initializer_list<Site>>
  int add_row(const Sites& sites, bool is_transient = false) {
    transient.push_back(is_transient ? 1 : 0);
    site.insert(site.end(), sites.begin(), sites.end());
    row_start.push_back(entries());
    return rows() - 1;
  }
};

/// Geometric stiffness of a loaded constraint between two points of one body or, for a cable
/// between bodies, of two. `hessian` is the sum over the rows of the constraint of effort
/// d2(delta)/d(x_first)d(x_second), N/m. The pair (second, first) is the transpose and is not
/// listed.
struct StiffnessPair {
  MaterialPoint first, second;
  Matrix3 hessian = Matrix3::Zero();
};

/// A point of a surface, which changes from step to step, as a weighted mean of nodes of its body.
struct Patch {
  std::array<NodeId, 4> nodes{-1, -1, -1, -1};  ///< one to four nodes; the rest -1
  std::array<double, 4> weights{};              ///< their weights, sum 1

  /// (3,) weighted mean of a nodal quantity such as position. @param of (n, 3).
  Vector3 mean(const Points& of) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < nodes.size() && nodes[k] >= 0; ++k) {
      sum += weights[k] * of.row(nodes[k]).transpose();
    }
    return sum;
  }
};

/// Groups of active transient rows that act as one row of the problem of a step. The motion of that
/// row is the mean of theirs, weighted by their shares, and its effort is distributed by the same
/// shares. All members of a group touch the same sites in the same order.
struct RowGroups {
  std::vector<int> leader;    ///< (rows,) the first row of the group; itself for single rows
  std::vector<int> next;      ///< (rows,) the next row of the group; -1 for the last
  std::vector<double> share;  ///< (rows,) >= 0, sum 1 in a group

  /// Whether there are no groups; all lists are then empty.
  bool empty() const { return leader.empty(); }
  /// Makes every row a group of its own. @param rows number of rows.
  void begin(std::size_t rows) {
    leader.resize(rows);
    std::iota(leader.begin(), leader.end(), 0);
    next.assign(rows, -1);
    share.assign(rows, 1.0);
  }
  void clear() {
    leader.clear();
    next.clear();
    share.clear();
  }
  bool leads(int row) const { return empty() || leader[static_cast<std::size_t>(row)] == row; }
  double share_of(int row) const { return empty() ? 1.0 : share[static_cast<std::size_t>(row)]; }
  /// Calls visit(row, share) for all rows of the group whose leader is `first`.
  template <class Visit>
  void for_each_member(int first, Visit&& visit) const {
    if (empty()) return visit(first, 1.0);
    for (int row = first; row >= 0; row = next[static_cast<std::size_t>(row)]) {
      visit(row, share[static_cast<std::size_t>(row)]);
    }
  }
};

/// The values of all rows in one linearisation, in the layout of RowPattern. Allocated once.
struct RowValues {
  RowValues() = default;
  explicit RowValues(const RowPattern& pattern) { resize(pattern); }

  std::vector<Vector3> direction;  ///< one per entry; see site.hpp
  VectorX delta;                   ///< (rows,) motion of each row at the current state, m
  /// (rows,) m, for contacts only: their rows are delta = direction . x + offset during a step, and
  /// `reference` is the value for a point carried by the surface (see constraint::Contact).
  VectorX offset, reference;
  /// (rows,) 0: an inactive transient row, whose motion and compliance are not computed.
  std::vector<char> active;
  /// (entries,) for contacts of rigid bodies, at the entry of the centre of such a body; empty
  /// without such contacts. See constraint::RigidSide.
  std::vector<Vector3> arm;            ///< m, watched point from the centre, in axes at rest
  std::vector<Vector3> lever;          ///< m, the same arm now, in world axes
  std::vector<Vector3> watched_start;  ///< m, watched point at the start of the step
  std::vector<Vector3> start;  ///< (rows,) m, at the first row of a point: its start position
  /// (rows / 3, rounded up) of contacts of the shapes of rigid bodies, at a third of the first row
  /// of a point; empty without such contacts.
  std::vector<RollingPoint> rolling;
  /// Whether the step is the first half of a step of the midpoint rule, whose motion will be
  /// repeated: slips are then those of the velocity in the middle (see RollingPoint).
  bool halved = false;
  /// (entries,) for contacts between surfaces, at entries whose site is a SurfaceSite; empty
  /// without such contacts.
  std::vector<Patch> patch;
  RowGroups groups;

  void resize(const RowPattern& pattern) {
    direction.assign(static_cast<std::size_t>(pattern.entries()), Vector3::Zero());
    delta.setZero(pattern.rows());
    offset.setZero(pattern.rows());
    reference.setZero(pattern.rows());
    active.assign(static_cast<std::size_t>(pattern.rows()), 1);
  }
};

}  // namespace sinew::mechanics
