#include "sinew/constraint/chamber.hpp"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"

namespace sinew::constraint {

namespace {

// A chamber whose volume is below this, relative to area^(3/2), is a sheet.
constexpr double kFlat = 1e-9;

struct Weighted {
  std::array<std::size_t, 3> corner;
  double weight;
};

/// The volume under a quadratic triangle, 1/3 integral of x . (x_u x x_v), as a weighted sum of
/// triple products of its nodes / 6: corners 0 to 2, then the middles of the edges that start
/// there. Integrated by Gauss quadrature on a square with one side collapsed, exact for the present
/// degree 4.
std::vector<Weighted> quadratic_weights() {
  constexpr std::array kPoint = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                 0.93056815579702629};
  constexpr std::array kWeight = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                  0.17392742256872693};
  std::array<std::array<std::array<double, 6>, 6>, 6> t{};
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) {
      const double u = kPoint[p], v = kPoint[q] * (1.0 - u), r = 1.0 - u - v;
      const double w = kWeight[p] * kWeight[q] * (1.0 - u) / 3.0;
      const std::array n = {r * (2 * r - 1), u * (2 * u - 1), v * (2 * v - 1),
                            4 * r * u,       4 * u * v,       4 * v * r};
      const std::array nu = {1 - 4 * r, 4 * u - 1, 0.0, 4 * (r - u), 4 * v, -4 * v};
      const std::array nv = {1 - 4 * r, 0.0, 4 * v - 1, -4 * u, 4 * u, 4 * (r - v)};
      for (std::size_t a = 0; a < 6; ++a) {
        for (std::size_t b = 0; b < 6; ++b) {
          for (std::size_t c = 0; c < 6; ++c) t[a][b][c] += w * n[a] * nu[b] * nv[c];
        }
      }
    }
  }
  std::vector<Weighted> result;
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) {
      for (std::size_t c = b + 1; c < 6; ++c) {
        result.push_back(
            {{a, b, c},
             6.0 * (t[a][b][c] + t[b][c][a] + t[c][a][b] - t[a][c][b] - t[c][b][a] - t[b][a][c])});
      }
    }
  }
  return result;
}

}  // namespace

Chamber::Chamber(std::string name, std::vector<mechanics::MaterialPoint> points,
                 std::vector<ChamberFace> faces, const Points& points_at_rest)
    : Constraint(std::move(name)), points_(std::move(points)), faces_(std::move(faces)) {
  if (points_.size() < 4) {
    throw Error(ErrorKind::too_few_points, {.item = "chamber '" + this->name() + "'"},
                fmt::format("the surface has {} nodes", points_.size()),
                "choose a surface that encloses a volume");
  }
  check_closed(points_at_rest);
  for (const ChamberFace& face : faces_) {
    const auto [a, b, c, d] = face.corner;
    if (face.middle[0] >= 0) {
      static const std::vector<Weighted> weights = quadratic_weights();
      const std::array node = {a, b, c, face.middle[0], face.middle[1], face.middle[2]};
      for (const Weighted& w : weights) {
        triangles_.push_back({{node[w.corner[0]], node[w.corner[1]], node[w.corner[2]]}, w.weight});
      }
      continue;
    }
    if (d < 0) {
      triangles_.push_back({{a, b, c}, 1.0});
      continue;
    }
    for (const auto& corners : {std::array{a, b, c}, {a, c, d}, {a, b, d}, {b, c, d}}) {
      triangles_.push_back({corners, 0.5});
    }
  }
  list_edges();
  const Vector3 origin = points_at_rest.row(0).transpose();
  for (const Triangle& t : triangles_) {
    std::array<Vector3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = points_at_rest.row(t.corner[k]).transpose() - origin;
    }
    rest_volume_ += t.weight / 6.0 * x[0].dot(x[1].cross(x[2]));
  }
  for (const ChamberFace& face : faces_) {
    const auto at = [&](std::size_t k) -> Vector3 {
      return points_at_rest.row(face.corner[k]).transpose();
    };
    const bool quad = face.corner[3] >= 0;
    rest_area_ += 0.5 * (quad ? (at(2) - at(0)).cross(at(3) - at(1)).norm()
                              : (at(1) - at(0)).cross(at(2) - at(0)).norm());
  }
  if (!(std::abs(rest_volume_) > kFlat * std::pow(rest_area_, 1.5))) {
    throw Error(ErrorKind::zero_volume, {.item = "chamber '" + this->name() + "'"},
                fmt::format("the surface encloses {:g} m^3", rest_volume_),
                "choose a surface that encloses a volume, or push with forces");
  }
}

void Chamber::check_closed(const Points& at_rest) const {
  std::multiset<std::pair<int, int>> edges;
  for (const ChamberFace& face : faces_) {
    const std::size_t corners = face.corner[3] < 0 ? 3 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      edges.insert({face.corner[k], face.corner[(k + 1) % corners]});
    }
  }
  int open = 0;
  std::pair<int, int> first;
  for (const auto& edge : edges) {
    if (edges.count({edge.second, edge.first}) == edges.count(edge)) continue;
    if (open++ == 0) first = edge;
  }
  if (open == 0) return;
  const Vector3 a = at_rest.row(first.first), b = at_rest.row(first.second);
  throw Error(
      ErrorKind::surface_not_closed, {.item = "chamber '" + name() + "'"},
      fmt::format("the surface is open along {} edges, the first from ({:g}, {:g}, {:g}) to "
                  "({:g}, {:g}, {:g}) m",
                  open, a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
      "choose a closed surface, or close its openings with cap: true");
}

void Chamber::list_edges() {
  std::map<std::array<int, 2>, int> number;
  for (const Triangle& t : triangles_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t.corner[k], b = t.corner[(k + 1) % 3], c = t.corner[(k + 2) % 3];
      const std::array<int, 2> pair{std::min(a, b), std::max(a, b)};
      const auto [found, is_new] = number.insert({pair, static_cast<int>(pairs_.size())});
      if (is_new) pairs_.push_back(pair);
      // a to b gives -[c]x/6; seen from b it is the transpose, +[c]x/6.
      edges_.push_back({found->second, c, t.weight / 6.0 * (a < b ? -1.0 : 1.0)});
    }
  }
}

void Chamber::declare(mechanics::RowPattern& rows,
                      std::vector<mechanics::StiffnessPair>& stiffness_pairs) {
  first_entry_ = rows.entries();
  first_row_ = rows.add_row(points_);
  row_count_ = 1;
  first_stiffness_pair_ = static_cast<int>(stiffness_pairs.size());
  for (const auto& [a, b] : pairs_) {
    stiffness_pairs.push_back({points_[static_cast<std::size_t>(a)],
                               points_[static_cast<std::size_t>(b)], Matrix3::Zero()});
  }
  stiffness_pair_count_ = static_cast<int>(pairs_.size());
}

void Chamber::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  const auto direction = [&](int corner) -> Vector3& {
    return values.direction[static_cast<std::size_t>(first_entry_ + corner)];
  };
  const auto position = [&](int corner) {
    return configuration.position(points_[static_cast<std::size_t>(corner)]);
  };
  for (std::size_t k = 0; k < points_.size(); ++k) direction(static_cast<int>(k)).setZero();
  const Vector3 origin = position(0);
  double volume = 0.0;
  for (const Triangle& t : triangles_) {
    const Vector3 a = position(t.corner[0]) - origin, b = position(t.corner[1]) - origin,
                  c = position(t.corner[2]) - origin;
    const Vector3 across = b.cross(c);
    const double sixth = t.weight / 6.0;
    volume += sixth * a.dot(across);
    direction(t.corner[0]) += sixth * across;
    direction(t.corner[1]) += sixth * c.cross(a);
    direction(t.corner[2]) += sixth * a.cross(b);
  }
  values.delta[first_row_] = volume - rest_volume_;
}

void Chamber::geometric_stiffness(const Configuration& configuration,
                                  std::span<const double> effort,
                                  std::span<mechanics::StiffnessPair> stiffness_pairs) const {
  for (auto& entry : stiffness_pairs) entry.hessian.setZero();
  const double pressure = effort[static_cast<std::size_t>(first_row_)];
  const Vector3 origin = configuration.position(points_.front());
  for (const Edge& edge : edges_) {
    const Vector3 c =
        configuration.position(points_[static_cast<std::size_t>(edge.third)]) - origin;
    stiffness_pairs[static_cast<std::size_t>(edge.pair)].hessian +=
        pressure * edge.weight * cross_matrix(c);
  }
}

void Chamber::describe(PartVisitor& visitor) const {
  for (const ChamberFace& face : faces_) visitor.add(face.corner, face.middle);
}

}  // namespace sinew::constraint
