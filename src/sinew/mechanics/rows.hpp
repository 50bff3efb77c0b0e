/// @file
/// Rows of the constraint Jacobian H in terms of sites: what constraints write and bodies read.
/// Row k of H is the sum over its entries of direction . (motion of the entry's site), so that the
/// motion conjugate to the row's effort changes by d(delta_k) = sum direction_e . dx_e.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/site.hpp"

namespace sinew::mechanics {

/// Which sites each row touches; fixed when the model is built. Entry e of row k stands at
/// row_start[k] <= e < row_start[k + 1].
struct RowPattern {
  std::vector<std::int32_t> row_start{0};
  std::vector<Site> site;
  std::vector<char> transient;  ///< (rows,) 1: rows that come and go, three by three, on one point

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int entries() const { return static_cast<int>(site.size()); }
  /// Closes a row that touches `sites`, a range of any kind of them; returns its number.
  template <class Sites = std::initializer_list<Site>>
  int add_row(const Sites& sites, bool is_transient = false) {
    transient.push_back(is_transient ? 1 : 0);
    site.insert(site.end(), sites.begin(), sites.end());
    row_start.push_back(entries());
    return rows() - 1;
  }
};

/// Second derivative of a constraint's loads (a loaded cable's geometric stiffness), which couples
/// two points, of one body or, along a cable between bodies, of two: `hessian` is the sum over
/// the constraint's rows of effort d2(delta)/d(x_first)d(x_second), N/m; the pair (second, first)
/// is its transpose and is not listed.
struct StiffnessPair {
  MaterialPoint first, second;
  Matrix3 hessian = Matrix3::Zero();
};

/// A point of a surface that is found anew in every step, by the nodes of its body's mesh.
struct Patch {
  std::array<NodeId, 4> nodes{-1, -1, -1, -1};  ///< one to four; the rest -1
  std::array<double, 4> weights{};              ///< of them, sum 1

  /// (3,) of something that nodes have, such as positions. @param of (n, 3).
  Vector3 mean(const Points& of) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < nodes.size() && nodes[k] >= 0; ++k) {
      sum += weights[k] * of.row(nodes[k]).transpose();
    }
    return sum;
  }
};

/// Active transient rows that act as one row of a step's problem: its motion is the mean of theirs
/// by their shares, and its effort is spread among them in these parts. All members of a group
/// touch the same sites in the same order.
struct RowGroups {
  std::vector<int> leader;    ///< (rows,) the first row of the group; itself for rows on their own
  std::vector<int> next;      ///< (rows,) the next row of the group; -1 for the last
  std::vector<double> share;  ///< (rows,) >= 0, sum 1 in a group

  /// Where no row shares, all are empty.
  bool empty() const { return leader.empty(); }
  /// Makes every row one on its own. @param rows how many there are.
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
  /// Calls visit(row, share) for a leader and its group.
  template <class Visit>
  void for_each_member(int first, Visit&& visit) const {
    if (empty()) return visit(first, 1.0);
    for (int row = first; row >= 0; row = next[static_cast<std::size_t>(row)]) {
      visit(row, share[static_cast<std::size_t>(row)]);
    }
  }
};

/// The numbers of one linearisation, in the layout of RowPattern. Allocated once.
struct RowValues {
  RowValues() = default;
  explicit RowValues(const RowPattern& pattern) { resize(pattern); }

  std::vector<Vector3> direction;  ///< one per entry; see site.hpp
  VectorX delta;                   ///< (rows,) value of the row's motion at the current state, m
  /// (rows,) m, of contacts alone, whose rows are delta = direction . x + offset through a step,
  /// and `reference` where the point would be carried by the surface (see constraint::Contact).
  VectorX offset, reference;
  /// (rows,) 0: a transient row that is left out; its motion and compliance are not computed.
  std::vector<char> active;
  /// (entries,) of contacts of rigid bodies, at the entry of such a body's centre; empty where
  /// there are none. See constraint::RigidSide.
  std::vector<Vector3> arm;            ///< m, of the watched point from the centre, in axes at rest
  std::vector<Vector3> lever;          ///< m, the same now, in the world
  std::vector<Vector3> watched_start;  ///< m, where the point was when the step began
  std::vector<Vector3> start;  ///< (rows,) m, at the first of a point's rows: the point then
  /// (entries,) of contacts between surfaces, where an entry's site is a SurfaceSite; empty where
  /// there are none.
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
