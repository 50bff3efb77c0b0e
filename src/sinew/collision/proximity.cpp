#include "sinew/collision/proximity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/collision/local_minimum.hpp"
#include "sinew/collision/point_query.hpp"

namespace sinew::collision {

namespace {

constexpr int kProximityGrain = 64;
// A way out of a body is a different one if it is shorter than this part of the depth: for a
// vertex, and for features on ridges.
constexpr double kSameWay = 1.0 - 1e-6;
constexpr double kBelowRidge = 0.3;
// Relative to the search distance: points within this of each other coincide. If the sum of two
// unit normals is shorter, neither defines the outward direction.
constexpr double kSamePlace = 1e-6, kOpposite = 1e-6;
// Lines are too far apart, whatever the rounding of their points, if the square of their distance
// exceeds this times the squared reach plus the second part of the square of the lengths from which
// it is computed.
constexpr double kTooFar = 1.001, kRounding2 = 1e-20;
// Sine of the angle within which a line lies in a plane.
constexpr double kParallel = 1e-6;
// With a larger slack for edges, cones of normals exclude nothing.
constexpr double kNegligibleSlack = 1e-6;
// Distance from a place at which the outside is examined, relative to the depth, and at least,
// relative to the search distance: less than the separation of surfaces in contact.
constexpr double kOutside = 1e-6, kLeastOutside = 1e-9;
// A slack that allows all neighbours, whatever the rounding of the sine.
constexpr double kAnySlack = 2.0;

SurfacePoint on_vertex(const SurfaceTree& surface, NodeId node) {
  return {FeatureKind::vertex, node, {node, -1, -1}, {1.0, 0.0, 0.0}, surface.at(node)};
}

SurfacePoint on_edge(const SurfaceTree& surface, int edge, double share) {
  const Edge& ends = surface.topology().edges()[static_cast<std::size_t>(edge)];
  const Vector3 from = surface.at(ends[0]);
  return {FeatureKind::edge,
          edge,
          {ends[0], ends[1], -1},
          {1.0 - share, share, 0.0},
          from + share * (surface.at(ends[1]) - from)};
}

SurfacePoint on_face(const SurfaceTree& surface, int triangle, const Vector3& weights) {
  const Corners x = surface.corners(triangle);
  const Vector3 unit = weights / weights.sum();
  return {FeatureKind::face, triangle,
          surface.topology().triangles()[static_cast<std::size_t>(triangle)], unit,
          unit[0] * x[0] + unit[1] * x[1] + unit[2] * x[2]};
}

// Distance of boxes that may contain a pair.
double reach(const ProximitySettings& settings) {
  return std::max(settings.distance, settings.depth);
}

bool share_node(const SurfacePoint& a, const SurfacePoint& b) {
  return std::ranges::any_of(a.nodes, [&](NodeId node) {
    return node >= 0 && std::ranges::find(b.nodes, node) != b.nodes.end();
  });
}

// Triangles of a vertex or edge.
std::span<const int> triangles_at(const SurfaceTopology& topology, const SurfacePoint& place) {
  return place.kind == FeatureKind::vertex ? topology.triangles_of_node(place.number)
                                           : topology.triangles_of_edge(place.number);
}

// Whether the neighbourhood of a surface point lies below the plane through it.
bool is_below(const SurfaceTree& surface, const SurfacePoint& place, const Vector3& normal) {
  const SurfaceTopology& topology = surface.topology();
  return std::ranges::all_of(triangles_at(topology, place), [&](int number) {
    const Triangle& nodes = topology.triangles()[static_cast<std::size_t>(number)];
    return std::ranges::all_of(nodes, [&](NodeId node) {
      const Vector3 way = surface.at(node) - place.point;
      return normal.dot(way) <= kParallel * way.norm();
    });
  });
}

// For two coinciding points: the sum of the normals of faces that separate both surfaces there,
// pointing out of the second one. Zero if there are none.
Vector3 dividing_normal(const SurfaceTree& first, const SurfacePoint& p, const SurfaceTree& second,
                        const SurfacePoint& q) {
  Vector3 sum = Vector3::Zero();
  const auto add = [&](const Vector3& normal) {
    if (is_below(second, q, normal) && is_below(first, p, -normal)) sum += normal;
  };
  const auto normal_of = [](const SurfaceTree& surface, int triangle) -> Vector3 {
    const Corners x = surface.corners(triangle);
    return (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  };
  for (const int t : triangles_at(second.topology(), q)) add(normal_of(second, t));
  for (const int t : triangles_at(first.topology(), p)) add(-normal_of(first, t));
  return sum;
}

// Examines the features that two triangles own.
class PairSearch {
 public:
  PairSearch(const SurfaceTree& first, const SurfaceTree& second, const ProximitySettings& settings,
             std::vector<ProximityPair>& found)
      : first_(first, settings.slack),
        second_(second, settings.slack),
        first_edges_(first, settings.edge_slack.value_or(settings.slack)),
        second_edges_(second, settings.edge_slack.value_or(settings.slack)),
        settings_(settings),
        same_(&first == &second),
        found_(found) {}

  void look_at(const TrianglePair& pair) {
    set_distance(first_.surface().motion(pair.first) + second_.surface().motion(pair.second));
    from_vertices(first_, second_, pair.first, pair.second, false);
    from_vertices(second_, first_, pair.second, pair.first, true);
    for (const NodeId v : first_.surface().topology().own_nodes(pair.first)) {
      for (const NodeId w : second_.surface().topology().own_nodes(pair.second)) vertices(v, w);
    }
    const SurfaceTopology &first = first_.surface().topology(),
                          &second = second_.surface().topology();
    for (const int e : first.own_edges(pair.first)) {
      if (first.is_flat(e)) continue;
      for (const int f : second.own_edges(pair.second)) {
        if (!second.is_flat(f)) edges(e, f);
      }
    }
  }

  void look_at_edges(int e, int f) {
    set_distance(0.0);
    edges(e, f);
  }

 private:
  // @param motion m, of both features.
  void set_distance(double motion) {
    distance_ = std::max(settings_.distance, motion);
    reach_ = std::max(distance_, settings_.depth);
    reach2_ = reach_ * reach_;
  }

  // The triangle's own vertices over the other triangle and over its own edges.
  void from_vertices(const LocalMinimum& own, const LocalMinimum& other, int triangle,
                     int other_triangle, bool swapped) {
    for (const NodeId node : own.surface().topology().own_nodes(triangle)) {
      const Vector3 x = own.surface().at(node);
      Box box;
      box.extend(x);
      if (box.is_apart(other.surface().box(other_triangle), reach_)) continue;
      over_face(own, node, x, other, other_triangle, swapped);
      for (const int edge : other.surface().topology().own_edges(other_triangle)) {
        over_edge(own, node, x, other, edge, swapped);
      }
    }
  }

  void over_face(const LocalMinimum& own, NodeId node, const Vector3& x, const LocalMinimum& other,
                 int triangle, bool swapped) {
    const Vector3 weights = other.weights(triangle, x);
    if (!LocalMinimum::over_face(weights)) return;
    const SurfacePoint p = on_vertex(own.surface(), node);
    const SurfacePoint q = on_face(other.surface(), triangle, weights);
    const Vector3 outward = other.face_normal(triangle).normalized();
    consider({own, node}, p, q, outward, outward.dot(x - q.point) < 0.0 ? -outward : outward,
             swapped);
  }

  void over_edge(const LocalMinimum& own, NodeId node, const Vector3& x, const LocalMinimum& other,
                 int edge, bool swapped) {
    const double share = other.share(edge, x);
    if (!LocalMinimum::inside_edge(share, 1.0)) return;
    const SurfacePoint p = on_vertex(own.surface(), node);
    const SurfacePoint q = on_edge(other.surface(), edge, share);
    if (!is_near(p.point, q.point)) return;
    const Vector3 outward = other.edge_normal(edge), inward = -own.vertex_normal(node);
    if (!other.over_edge(edge, x, can_touch(inward))) return;
    const Vector3 away = direction(x - q.point, inward, outward, [&] {
      return dividing_normal(own.surface(), p, other.surface(), q);
    });
    consider({own, node}, p, q, outward, away, swapped);
  }

  // A vertex over a face or an edge. @param away (3,) from the nearest point to the vertex.
  struct OwnVertex {
    const LocalMinimum& of;
    NodeId node;
  };
  void consider(const OwnVertex& own, const SurfacePoint& p, const SurfacePoint& q,
                const Vector3& outward, const Vector3& away, bool swapped) {
    if (!is_near(p.point, q.point)) return;
    const Vector3 inward = -own.of.vertex_normal(own.node);
    const Vector3 normal = signed_normal(away, inward, outward);
    if (!is_pair(p, q, normal)) return;
    if (!own.of.vertex_is_nearest(own.node, q.point, -normal)) return;
    if (!is_seen(inward, outward, normal)) return;
    if (swapped) {
      keep({q, -outward}, {p, -inward}, -normal);
    } else {
      keep({p, inward}, {q, outward}, normal);
    }
  }

  void vertices(NodeId v, NodeId w) {
    if (!is_near(first_.surface().at(v), second_.surface().at(w))) return;
    const SurfacePoint p = on_vertex(first_.surface(), v), q = on_vertex(second_.surface(), w);
    const Vector3 outward = second_.vertex_normal(w), inward = -first_.vertex_normal(v);
    const Vector3 away = direction(p.point - q.point, inward, outward, [&] {
      return dividing_normal(first_.surface(), p, second_.surface(), q);
    });
    const Vector3 normal = signed_normal(away, inward, outward);
    if (!is_pair(p, q, normal)) return;
    const bool nearest = (second_.over_vertex(w, p.point, can_touch(inward)) &&
                          first_.vertex_is_nearest(v, q.point, -normal)) ||
                         (first_.over_vertex(v, q.point, can_touch(-outward)) &&
                          second_.vertex_is_nearest(w, p.point, normal));
    if (nearest && is_seen(inward, outward, normal)) keep({p, inward}, {q, outward}, normal);
  }

  // With c the common perpendicular of the lines a(s) and b(t), s = ((b0 - a0) x v).c / c.c, and
  // likewise t. The projection of the end a0 on b, seen from a, is at s sin^2: below the border,
  // that end stands for the edge. Edges at an angle of less than 3e-5 are all border, like parallel
  // ones.
  void edges(int e, int f) {
    const auto ends = [](const SurfaceTree& surface, int edge) {
      const Edge& own = surface.topology().edges()[static_cast<std::size_t>(edge)];
      return std::pair(surface.at(own[0]), surface.at(own[1]));
    };
    const auto [a0, a1] = ends(first_.surface(), e);
    const auto [b0, b1] = ends(second_.surface(), f);
    const Vector3 u = a1 - a0, v = b1 - b0, c = u.cross(v), w = b0 - a0;
    const double across2 = c.squaredNorm(), height_across = -w.dot(c);
    const double far2 = kTooFar * reach2_ + kRounding2 * w.squaredNorm();
    if (!(across2 > 0.0) || height_across * height_across > far2 * across2) return;
    const double product = u.squaredNorm() * v.squaredNorm();
    const double s = w.cross(v).dot(c) / across2, t = w.cross(u).dot(c) / across2;
    const double sine2 = across2 / product;
    if (!LocalMinimum::inside_edge(s, sine2) || !LocalMinimum::inside_edge(t, sine2)) return;
    const SurfacePoint p = on_edge(first_.surface(), e, s), q = on_edge(second_.surface(), f, t);
    const double height = height_across / std::sqrt(across2);
    if (!is_near(p.point, q.point)) return;
    const Vector3 outward = second_.edge_normal(f), inward = -first_.edge_normal(e);
    const double side = height != 0.0 ? height : between(inward, outward).dot(c);
    const Vector3 normal =
        signed_normal(c.normalized() * (side < 0.0 ? -1.0 : 1.0), inward, outward);
    if (!is_pair(p, q, normal)) return;
    const bool e_is_ridge = LocalMinimum::is_ridge(inward),
               f_is_ridge = LocalMinimum::is_ridge(outward), ridges = e_is_ridge && f_is_ridge;
    const LocalMinimum &first = ridges ? first_ : first_edges_,
                       &second = ridges ? second_ : second_edges_;
    if (!first.edge_is_nearest(e, p.point, q.point, -normal)) return;
    if (!second.edge_is_nearest(f, q.point, p.point, normal)) return;
    // Edges in a face that cross at a right angle to it, where one body penetrates the other by
    // next to nothing, are not separated by anything.
    const double faces = normal.dot(inward) + normal.dot(outward);
    const bool across = !settings_.facing || faces > kParallel;
    if (across && is_seen(inward, outward, normal)) {
      keep({p, inward}, {q, outward}, normal, !e_is_ridge && !f_is_ridge);
    }
  }

  // Reverses the direction between features that have passed each other.
  Vector3 signed_normal(const Vector3& away, const Vector3& inward, const Vector3& outward) const {
    const bool passed = settings_.depth > 0.0 && away.dot(inward) < 0.0 && away.dot(outward) < 0.0;
    return passed ? Vector3(-away) : away;
  }

  bool is_near(const Vector3& p, const Vector3& q) const {
    return (p - q).squaredNorm() <= reach2_ * (1.0 + 1e-12);
  }

  // Distance along the normal, m. Without a depth, normals lead from one point to the other, so a
  // negative distance is rounding.
  double distance_along(const Vector3& normal, const SurfacePoint& p, const SurfacePoint& q) const {
    const double along = normal.dot(p.point - q.point);
    return settings_.depth > 0.0 ? along : std::max(0.0, along);
  }

  bool is_pair(const SurfacePoint& p, const SurfacePoint& q, const Vector3& normal) const {
    const double distance = distance_along(normal, p, q);
    return distance <= distance_ && distance >= -settings_.depth && !(same_ && share_node(p, q));
  }

  // Direction from one point to the other. For coinciding points, it is normal to the faces that
  // separate the surfaces there: where the rims of two blocks lie on each other, across these and
  // not along. Without such faces, it is half-way between the outward directions of both surfaces.
  template <class Divide>
  Vector3 direction(const Vector3& gap, const Vector3& inward, const Vector3& outward,
                    Divide&& divide) const {
    const double length = gap.norm();
    if (length > kSamePlace * reach(settings_)) return gap / length;
    const Vector3 across = divide();
    return across.norm() > kOpposite ? across.normalized() : between(inward, outward);
  }
  static Vector3 between(const Vector3& inward, const Vector3& outward) {
    const Vector3 sum = inward.normalized() + outward.normalized();
    const double length = sum.norm();
    return length > kOpposite ? (sum / length).eval() : outward.normalized();
  }

  bool is_seen(const Vector3& inward, const Vector3& outward, const Vector3& normal) const {
    return !settings_.facing || (normal.dot(inward) >= 0.0 && normal.dot(outward) >= 0.0);
  }

  // The inward direction for which flush triangles do not count. All triangles count if nothing may
  // have passed, if sides do not matter, and on one surface, whose flat parts are flush with
  // themselves.
  Vector3 can_touch(const Vector3& inward) const {
    return settings_.facing && settings_.depth > 0.0 && !same_ ? inward : Vector3(Vector3::Zero());
  }

  // A point, and a direction (3,) of any length: into the body for the first surface, out of it for
  // the second.
  struct Placed {
    const SurfacePoint& point;
    Vector3 direction;
  };
  void keep(const Placed& p, const Placed& q, const Vector3& normal, bool between_flat = false) {
    const double distance = distance_along(normal, p.point, q.point);
    if (distance < 0.0 && !(leads_out(p, q, -distance) && has_passed(p, q, -distance))) return;
    found_.push_back({p.point, q.point, normal, distance, between_flat});
  }

  // Two places of one surface that face away from each other have either passed each other, or the
  // straight way between them is material: a wall, or an element that is compressed to less than
  // the depth. In the first case, just outside of one place is the other part of the body. With a
  // closed surface, its winding number there tells: 1 or more, or 0.
  bool has_passed(const Placed& p, const Placed& q, double depth) const {
    if (!same_ || !first_.surface().topology().closed()) return true;
    const double step = std::max(kOutside * depth, kLeastOutside * reach_);
    return is_covered(p.point.point - step * p.direction.normalized()) ||
           is_covered(q.point.point + step * q.direction.normalized());
  }
  bool is_covered(const Vector3& point) const {
    return winding_number(first_.surface(), point) > 0;
  }

  // Whether features that have passed each other have no shorter way out. Next to an edge of a
  // body, one of its faces is near, and the other face is a way through much of the body. Seen from
  // below ridges, the faces of ridges are nearer than the ridges.
  bool leads_out(const Placed& p, const Placed& q, double depth) const {
    const bool p_is_vertex = p.point.kind == FeatureKind::vertex,
               q_is_vertex = q.point.kind == FeatureKind::vertex;
    const bool p_stands = p_is_vertex && !q_is_vertex, q_stands = q_is_vertex && !p_is_vertex;
    const double shorter = depth * (p_stands || q_stands ? kSameWay : kBelowRidge);
    return (q_stands ||
            !has_shorter_way(p.point, q.point, second_, can_touch(p.direction), shorter)) &&
           (p_stands ||
            !has_shorter_way(q.point, p.point, first_, can_touch(-q.direction), shorter));
  }

  // The faces of the edge that a point has passed do not count: on a ridge they may pass through
  // it. Neither do those that are flush with the point.
  bool has_shorter_way(const SurfacePoint& point, const SurfacePoint& passed,
                       const LocalMinimum& of, const Vector3& inward, double reach) const {
    const auto& triangles = of.surface().topology().triangles();
    const auto skips = [&](int number) {
      if (of.flush(number, point.point, inward)) return true;
      const Triangle& own = triangles[static_cast<std::size_t>(number)];
      const auto has = [&](NodeId node) { return std::ranges::find(own, node) != own.end(); };
      const bool at_edge =
          passed.kind == FeatureKind::edge && has(passed.nodes[0]) && has(passed.nodes[1]);
      return at_edge || (same_ && std::ranges::any_of(point.nodes, has));
    };
    return nearest_on_surface(of.surface(), point.point, reach, skips).triangle >= 0;
  }

  LocalMinimum first_, second_, first_edges_, second_edges_;
  const ProximitySettings& settings_;
  double distance_ = 0.0, reach_ = 0.0, reach2_ = 0.0;  // m, m, m^2; of the pair of triangles
  bool same_;
  std::vector<ProximityPair>& found_;
};

}  // namespace

Proximity::Proximity(ThreadPool& pool) : pool_(pool), near_(pool), pairs_(pool) {}

std::span<const ProximityPair> Proximity::between(const SurfaceTree& first,
                                                  const SurfaceTree& second,
                                                  const ProximitySettings& settings) {
  return collect(first, second, near_.between(first, second, reach(settings)), settings);
}

std::span<const ProximityPair> Proximity::within(const SurfaceTree& surface,
                                                 const ProximitySettings& settings) {
  const bool excludes =
      settings.facing && settings.edge_slack.value_or(settings.slack) <= kNegligibleSlack;
  if (excludes) cones_.update(surface, pool_);
  const auto near = near_.within(surface, reach(settings), excludes ? &cones_ : nullptr);
  return collect(surface, surface, near, settings);
}

std::span<const ProximityPair> Proximity::crossings(const SurfaceTree& first,
                                                    const SurfaceTree& second,
                                                    std::span<const std::array<int, 2>> edges,
                                                    ProximitySettings settings) {
  settings.slack = settings.edge_slack.emplace(kAnySlack);
  crossings_.clear();
  PairSearch search(first, second, settings, crossings_);
  for (const auto& [e, f] : edges) search.look_at_edges(e, f);
  return crossings_;
}

std::span<const ProximityPair> Proximity::collect(const SurfaceTree& first,
                                                  const SurfaceTree& second,
                                                  std::span<const TrianglePair> near,
                                                  const ProximitySettings& settings) {
  return pairs_.collect(static_cast<int>(near.size()), kProximityGrain,
                        [&](int begin, int end, std::vector<ProximityPair>& found) {
                          PairSearch search(first, second, settings, found);
                          for (int k = begin; k < end; ++k) {
                            search.look_at(near[static_cast<std::size_t>(k)]);
                          }
                        });
}

}  // namespace sinew::collision
