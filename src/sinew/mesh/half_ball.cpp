#include "sinew/mesh/half_ball.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace sinew::mesh {

namespace {

constexpr double kPi = std::numbers::pi;

/// Collects nodes, starting with those of the base.
class NodeList {
 public:
  explicit NodeList(const Section& base) {
    for (std::size_t i = 0; i < base.radius.size(); ++i) {
      add(Vector3(base.radius[i] * std::cos(base.angle[i]),
                  base.radius[i] * std::sin(base.angle[i]), 0.0));
    }
  }
  NodeId add(const Vector3& at) {
    nodes_.push_back(at);
    return static_cast<NodeId>(nodes_.size()) - 1;
  }
  const Vector3& at(NodeId node) const { return nodes_[static_cast<std::size_t>(node)]; }

  void finish(HalfBall& half) const {
    constexpr double kRounding = 1e-12;
    half.nodes.resize(static_cast<Eigen::Index>(nodes_.size()), 3);
    for (NodeId i = 0; i < static_cast<NodeId>(nodes_.size()); ++i) {
      half.nodes.row(i) = at(i).transpose();
      if (at(i).norm() > 1.0 - kRounding) half.outside.push_back(i);
    }
  }

 private:
  std::vector<Vector3> nodes_;
};

/// Half a ball of six tetrahedra with a corner at the centre and one at the pole, each split into
/// n^3. Shell r has the radius r/n. Its row c, at a latitude of 90 degrees c/r, has 6 (r - c) nodes
/// at equal longitudes; the pole is one node. The base is disc_section(n).
class TetrahedralHalf {
 public:
  explicit TetrahedralHalf(int rings) : rings_(rings), list_(disc_section(rings)) {
    for (int r = 1; r <= rings_; ++r) {
      for (int c = 1; c <= r; ++c) add_row(r, c);
    }
  }

  HalfBall make() {
    for (int sixth = 0; sixth < 6; ++sixth) {
      for (int k = 0; k < rings_; ++k) {
        for (int j = 0; j + k < rings_; ++j) {
          for (int i = 0; i + j + k < rings_; ++i) add_cells(sixth, i, j, k);
        }
      }
    }
    list_.finish(half_);
    return std::move(half_);
  }

 private:
  void add_row(int r, int c) {
    const int count = std::max(1, 6 * (r - c));
    const double latitude = 0.5 * kPi * c / r, radius = static_cast<double>(r) / rings_;
    const double out = c == r ? 0.0 : std::cos(latitude);
    for (int q = 0; q < count; ++q) {
      const double longitude = 2.0 * kPi * q / count;
      const NodeId node =
          list_.add(radius * Vector3(out * std::cos(longitude), out * std::sin(longitude),
                                     std::sin(latitude)));
      if (q == 0) row_[{r, c}] = node;
    }
  }

  /// Node of a lattice point of a sixth: i steps towards its first corner, j its second, k the
  /// pole.
  NodeId node(int sixth, int i, int j, int k) const {
    const int row = i + j, r = row + k;
    const int place = row == 0 ? 0 : (sixth * row + j) % (6 * row);
    if (k > 0) return row_.at({r, k}) + place;
    return r == 0 ? 0 : 1 + 3 * r * (r - 1) + place;
  }

  /// Adds the cells whose lowest corner is (i, j, k): a tetrahedron, an octahedron cut along its
  /// shortest diagonal, and an inverted tetrahedron.
  void add_cells(int sixth, int i, int j, int k) {
    const auto at = [&](int a, int b, int c) { return node(sixth, i + a, j + b, k + c); };
    half_.tetrahedra.push_back({at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)});
    if (i + j + k + 2 > rings_) return;
    add_octahedron(
        {{{at(1, 0, 0), at(0, 1, 1)}, {at(0, 1, 0), at(1, 0, 1)}, {at(0, 0, 1), at(1, 1, 0)}}});
    if (i + j + k + 3 > rings_) return;
    half_.tetrahedra.push_back({at(1, 1, 0), at(1, 0, 1), at(0, 1, 1), at(1, 1, 1)});
  }

  void add_octahedron(std::array<std::array<NodeId, 2>, 3> diagonals) {
    const auto length = [&](const std::array<NodeId, 2>& ends) {
      return (list_.at(ends[0]) - list_.at(ends[1])).norm();
    };
    std::iter_swap(diagonals.begin(), std::ranges::min_element(diagonals, {}, length));
    const auto& [cut, b, c] = diagonals;
    const std::array<NodeId, 5> around = {b[0], c[0], b[1], c[1], b[0]};
    for (std::size_t q = 0; q < 4; ++q) {
      half_.tetrahedra.push_back({cut[0], cut[1], around[q], around[q + 1]});
    }
  }

  int rings_;
  NodeList list_;
  std::map<std::pair<int, int>, NodeId> row_;  // first node of row c > 0 of shell r
  HalfBall half_;
};

/// Half a ball of hexahedra: a rounded half cube in the middle, and shells from it to the outside
/// in the directions of the equiangular cubed sphere (Ronchi, Iacono, Paolucci, J. Comput. Phys.
/// 124, 1996). The base is disc_section_of_quadrilaterals(rings).
class HexahedralHalf {
 public:
  explicit HexahedralHalf(int rings)
      : inner_((rings + 1) / 2),
        outer_(rings - inner_),
        half_width_(static_cast<double>(inner_) / rings),
        list_(disc_section_of_quadrilaterals(rings)) {
    for (int k = 0; k <= inner_; ++k) {
      for (int j = 0; j <= cells(); ++j) {
        for (int i = 0; i <= cells(); ++i) add_core_node({i, j, k});
      }
    }
    for (int shell = 1; shell <= outer_; ++shell) {
      for (const auto& [point, node] : core_) add_shell_node(point, shell);
    }
  }

  HalfBall make() {
    for (int k = 0; k < inner_; ++k) {
      for (int j = 0; j < cells(); ++j) {
        for (int i = 0; i < cells(); ++i) add_core_cell({i, j, k});
      }
    }
    list_.finish(half_);
    return std::move(half_);
  }

 private:
  using Lattice = std::array<int, 3>;
  using Square = std::array<Lattice, 4>;

  int cells() const { return 2 * inner_; }
  bool is_side(int i) const { return i == 0 || i == cells(); }
  bool is_outside(const Lattice& p) const {
    return is_side(p[0]) || is_side(p[1]) || p[2] == inner_;
  }
  Vector3 in_cube(const Lattice& p) const {
    return Vector3(p[0] - inner_, p[1] - inner_, p[2]) / inner_;
  }

  /// Maps a cube onto a ball, blended with the cube itself. At z = 0, this is the elliptical map of
  /// a square onto a disc in disc_section_of_quadrilaterals().
  Vector3 core_position(const Lattice& p) const {
    constexpr double kRoundness = 0.6;
    const Vector3 x = in_cube(p), s = x.cwiseProduct(x);
    Vector3 at;
    for (int a = 0; a < 3; ++a) {
      const double b = s[(a + 1) % 3], c = s[(a + 2) % 3];
      at[a] = std::lerp(x[a], x[a] * std::sqrt(1.0 - 0.5 * b - 0.5 * c + b * c / 3.0), kRoundness);
    }
    return half_width_ * at;
  }

  void add_core_node(const Lattice& p) {
    core_[p] = p[2] == 0 ? p[1] * (cells() + 1) + p[0] : list_.add(core_position(p));
  }

  /// Place of a node in a ring of the base, counter-clockwise from the lowest corner.
  int place_in_ring(const Lattice& p) const {
    const int n = cells();
    if (p[1] == 0 && p[0] < n) return p[0];
    if (p[0] == n && p[1] < n) return n + p[1];
    return p[1] == n && p[0] > 0 ? 3 * n - p[0] : 4 * n - p[1];
  }

  void add_shell_node(const Lattice& p, int shell) {
    if (!is_outside(p)) return;
    NodeId& node = shell_[{p, shell}];
    if (p[2] == 0) {
      const int square = (cells() + 1) * (cells() + 1);
      node = square + (shell - 1) * 4 * cells() + place_in_ring(p);
      return;
    }
    const Vector3 direction = (0.25 * kPi * in_cube(p).array()).tan().matrix().normalized();
    const double part = static_cast<double>(shell) / outer_;
    node = list_.add((1.0 - part) * list_.at(core_.at(p)) + part * direction);
  }

  NodeId node(const Lattice& p, int shell) const {
    return shell == 0 ? core_.at(p) : shell_.at({p, shell});
  }

  /// Adds a cell of the core, and the cells between it and the outside.
  void add_core_cell(const Lattice& p) {
    const auto at = [&](int a, int b, int c) { return Lattice{p[0] + a, p[1] + b, p[2] + c}; };
    const Square low = {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)};
    const Square high = {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
    add_cell(low, 0, high, 0);
    for (std::size_t q = 0; q < 4; ++q) {
      const std::size_t r = (q + 1) % 4;
      add_shells({low[q], low[r], high[r], high[q]});
    }
    add_shells(high);
  }

  void add_shells(const Square& face) {
    for (const int a : {0, 1, 2}) {
      const int end = a == 2 ? inner_ : cells();
      for (const int side : {0, end}) {
        if (a == 2 && side == 0) continue;  // the base
        const auto lies_there = [&](const Lattice& p) {
          return p[static_cast<std::size_t>(a)] == side;
        };
        if (!std::ranges::all_of(face, lies_there)) continue;
        for (int shell = 0; shell < outer_; ++shell) add_cell(face, shell, face, shell + 1);
      }
    }
  }

  void add_cell(const Square& one, int shell, const Square& other, int other_shell) {
    Hexahedron& nodes = half_.hexahedra.emplace_back();
    for (std::size_t q = 0; q < 4; ++q) {
      nodes[q] = node(one[q], shell);
      nodes[q + 4] = node(other[q], other_shell);
    }
  }

  int inner_, outer_;
  double half_width_;
  NodeList list_;
  std::map<Lattice, NodeId> core_;
  std::map<std::pair<Lattice, int>, NodeId> shell_;
  HalfBall half_;
};

}  // namespace

HalfBall half_ball(int rings, Cells cells) {
  return cells == Cells::hexahedra ? HexahedralHalf(rings).make() : TetrahedralHalf(rings).make();
}

}  // namespace sinew::mesh
