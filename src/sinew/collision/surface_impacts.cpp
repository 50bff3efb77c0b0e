#include "sinew/collision/surface_impacts.hpp"

#include <algorithm>

#include "sinew/collision/impact.hpp"

namespace sinew::collision {

namespace {

constexpr int kImpactGrain = 64;

class ImpactSearch {
 public:
  ImpactSearch(const SurfaceTree& first, const SurfaceTree& second, double separation,
               std::vector<SurfaceImpact>& found)
      : first_(first),
        second_(second),
        separation_(separation),
        same_(&first == &second),
        found_(found) {}

  void look_at(const TrianglePair& pair) {
    for (const NodeId node : first_.topology().own_nodes(pair.first)) {
      const auto time = vertex_and_face(first_, node, second_, pair.second);
      keep(FeatureKind::vertex, node, FeatureKind::face, pair.second, time);
    }
    for (const NodeId node : second_.topology().own_nodes(pair.second)) {
      const auto time = vertex_and_face(second_, node, first_, pair.first);
      keep(FeatureKind::face, pair.first, FeatureKind::vertex, node, time);
    }
    for (const int e : first_.topology().own_edges(pair.first)) {
      for (const int f : second_.topology().own_edges(pair.second)) {
        keep(FeatureKind::edge, e, FeatureKind::edge, f, edge_and_edge(e, f));
      }
    }
  }

 private:
  std::optional<double> vertex_and_face(const SurfaceTree& own, NodeId node,
                                        const SurfaceTree& other, int triangle) const {
    const auto& [a, b, c] = other.topology().triangles()[static_cast<std::size_t>(triangle)];
    if (same_ && (node == a || node == b || node == c)) return std::nullopt;
    Box box;
    box.extend(own.at(node));
    box.extend(own.at_end(node));
    if (box.is_apart(other.box(triangle), separation_)) return std::nullopt;
    return vertex_face_impact({own.at(node), other.at(a), other.at(b), other.at(c)},
                              {own.at_end(node), other.at_end(a), other.at_end(b), other.at_end(c)},
                              separation_);
  }

  std::optional<double> edge_and_edge(int e, int f) const {
    const auto& [a, b] = first_.topology().edges()[static_cast<std::size_t>(e)];
    const auto& [c, d] = second_.topology().edges()[static_cast<std::size_t>(f)];
    if (same_ && (a == c || a == d || b == c || b == d)) return std::nullopt;
    return edge_edge_impact(
        {first_.at(a), first_.at(b), second_.at(c), second_.at(d)},
        {first_.at_end(a), first_.at_end(b), second_.at_end(c), second_.at_end(d)}, separation_);
  }

  void keep(FeatureKind first_kind, int first, FeatureKind second_kind, int second,
            const std::optional<double>& time) {
    if (time) found_.push_back({first_kind, second_kind, first, second, *time});
  }

  const SurfaceTree& first_;
  const SurfaceTree& second_;
  double separation_;
  bool same_;
  std::vector<SurfaceImpact>& found_;
};

}  // namespace

SurfaceImpacts::SurfaceImpacts(ThreadPool& pool) : near_(pool), impacts_(pool) {}

std::span<const SurfaceImpact> SurfaceImpacts::between(const SurfaceTree& first,
                                                       const SurfaceTree& second,
                                                       double separation) {
  return collect(first, second, near_.between(first, second, separation), separation);
}

std::span<const SurfaceImpact> SurfaceImpacts::within(const SurfaceTree& surface,
                                                      double separation) {
  return collect(surface, surface, near_.within(surface, separation), separation);
}

std::span<const SurfaceImpact> SurfaceImpacts::collect(const SurfaceTree& first,
                                                       const SurfaceTree& second,
                                                       std::span<const TrianglePair> near,
                                                       double separation) {
  return impacts_.collect(static_cast<int>(near.size()), kImpactGrain,
                          [&](int begin, int end, std::vector<SurfaceImpact>& found) {
                            ImpactSearch search(first, second, separation, found);
                            for (int k = begin; k < end; ++k) {
                              search.look_at(near[static_cast<std::size_t>(k)]);
                            }
                          });
}

std::optional<double> earliest(std::span<const SurfaceImpact> impacts) {
  if (impacts.empty()) return std::nullopt;
  return std::ranges::min_element(impacts, {}, &SurfaceImpact::time)->time;
}

}  // namespace sinew::collision
