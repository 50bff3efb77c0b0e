#include "sinew/mesh/rigid_parts.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

// Nodes that are nearer to a line than this fraction of its length lie on it.
constexpr double kStraight = 1e-6;
// Smaller singular values, relative to the largest, belong to free motions.
constexpr double kFreeMotion = 1e-6;
// Parts whose motions together give a problem that is too large: left to the matrix of a step.
constexpr std::size_t kMostParts = 150;
// Least part of a unit motion that counts as a motion of a part.
constexpr double kMoves = 1e-3;

// Disjoint sets of elements, with the lowest as representative.
class PartSets {
 public:
  explicit PartSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  bool join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::size_t> parent_;
};

// All elements in one order: tetrahedra, then hexahedra.
std::vector<std::vector<NodeId>> elements_of(const Mesh& mesh) {
  std::vector<std::vector<NodeId>> all;
  all.reserve(mesh.tetrahedra.size() + mesh.hexahedra.size());
  if (mesh.quadratic.empty()) {
    for (const Tetrahedron& t : mesh.tetrahedra) all.emplace_back(t.begin(), t.end());
  }
  for (const QuadraticTetrahedron& t : mesh.quadratic) all.emplace_back(t.begin(), t.end());
  for (const Hexahedron& h : mesh.hexahedra) all.emplace_back(h.begin(), h.end());
  return all;
}

void join_faces(const Mesh& mesh, PartSets& sets) {
  const std::vector<FaceUse> uses = face_uses(mesh);
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].key != uses[i - 1].key) continue;
    sets.join(static_cast<std::size_t>(uses[i].tetrahedron),
              static_cast<std::size_t>(uses[i - 1].tetrahedron));
  }
  std::map<std::array<NodeId, 4>, std::size_t> first;
  for (std::size_t e = 0; e < mesh.hexahedra.size(); ++e) {
    for (std::array<NodeId, 4> face : faces_of(mesh.hexahedra[e])) {
      std::ranges::sort(face);
      const std::size_t element = mesh.tetrahedra.size() + e;
      const auto [found, added] = first.try_emplace(face, element);
      if (!added) sets.join(found->second, element);
    }
  }
}

// Ends of the longest distance between nodes, from the first one, and whether the others lie on the
// line through them.
struct Line {
  Line(const Points& points, std::span<const NodeId> nodes) {
    const Vector3 start = points.row(nodes[0]).transpose();
    const auto far = [&](NodeId n) { return (points.row(n).transpose() - start).squaredNorm(); };
    last = *std::ranges::max_element(nodes, {}, far);
    const auto from_last = [&](NodeId n) {
      return (points.row(n) - points.row(last)).squaredNorm();
    };
    first = *std::ranges::max_element(nodes, {}, from_last);
    const Vector3 span = (points.row(last) - points.row(first)).transpose();
    for (const NodeId node : nodes) {
      const Vector3 r = (points.row(node) - points.row(first)).transpose();
      straight = straight && span.cross(r).norm() <= kStraight * span.squaredNorm();
    }
  }
  NodeId first = -1, last = -1;
  bool straight = true;
};

// The parts of each node, distinct and ascending.
std::vector<std::vector<std::size_t>> parts_of_nodes(
    const Mesh& mesh, const std::vector<std::vector<NodeId>>& elements, PartSets& sets) {
  std::vector<std::vector<std::size_t>> parts(static_cast<std::size_t>(mesh.node_count()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::size_t part = sets.find(e);
    for (const NodeId node : elements[e]) {
      auto& own = parts[static_cast<std::size_t>(node)];
      if (std::ranges::find(own, part) == own.end()) own.push_back(part);
    }
  }
  for (auto& own : parts) std::ranges::sort(own);
  return parts;
}

// Joins parts that share three nodes that are not on one line. @return whether any were joined.
bool join_touching(const Mesh& mesh, const std::vector<std::vector<NodeId>>& elements,
                   PartSets& sets) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<NodeId>> shared;
  const auto parts = parts_of_nodes(mesh, elements, sets);
  for (std::size_t n = 0; n < parts.size(); ++n) {
    for (std::size_t i = 0; i < parts[n].size(); ++i) {
      for (std::size_t j = i + 1; j < parts[n].size(); ++j) {
        shared[{parts[n][i], parts[n][j]}].push_back(static_cast<NodeId>(n));
      }
    }
  }
  bool joined = false;
  for (const auto& [pair, nodes] : shared) {
    if (nodes.size() < 3 || Line(mesh.nodes, nodes).straight) continue;
    joined = sets.join(pair.first, pair.second) || joined;
  }
  return joined;
}

// Rigid motions of parts, 6 columns each: u = t + w x (x - centre)/radius.
class PartMotions {
 public:
  PartMotions(const Mesh& mesh, const std::vector<RigidPart>& parts) : mesh_(mesh), parts_(parts) {
    for (const RigidPart& part : parts) {
      const Points own = mesh.nodes(part.nodes, Eigen::all);
      centre_.emplace_back(own.colwise().mean().transpose());
      radius_.push_back((own.rowwise() - centre_.back().transpose()).rowwise().norm().maxCoeff());
    }
    const auto columns = 6 * static_cast<Eigen::Index>(parts.size());
    normal_.setZero(columns, columns);
  }

  void hold(std::size_t part, NodeId node, int axis) { add({{part, 1.0}}, node, axis); }
  void hold_whole(std::size_t part) {
    normal_.diagonal().segment<6>(6 * static_cast<Eigen::Index>(part)).array() += 1.0;
  }
  void join(std::size_t one, std::size_t other, NodeId node) {
    for (int axis = 0; axis < 3; ++axis) add({{one, 1.0}, {other, -1.0}}, node, axis);
  }
  // (6 parts, free motions): orthonormal.
  MatrixX free_motions() const {
    const linalg::SymmetricSpectrum spectrum(normal_);
    const double least = kFreeMotion * kFreeMotion * spectrum.values().tail<1>()[0];
    const Eigen::Index count = (spectrum.values().array() <= least).count();
    return spectrum.vectors().leftCols(count);
  }

 private:
  struct Side {
    std::size_t part;
    double sign;
  };
  void add(std::initializer_list<Side> sides, NodeId node, int axis) {
    VectorX row = VectorX::Zero(normal_.rows());
    for (const auto& [part, sign] : sides) {
      const auto at = 6 * static_cast<Eigen::Index>(part);
      const Vector3 r = (mesh_.nodes.row(node).transpose() - centre_[part]) / radius_[part];
      row.segment<3>(at) += sign * Vector3::Unit(axis);
      row.segment<3>(at + 3) += sign * r.cross(Vector3::Unit(axis));
    }
    normal_.noalias() += row * row.transpose();
  }

  const Mesh& mesh_;
  const std::vector<RigidPart>& parts_;
  std::vector<Vector3> centre_;
  std::vector<double> radius_;
  MatrixX normal_;
};

int rank_of(const MatrixX& block) {
  const MatrixX square = block * block.transpose();
  const linalg::SymmetricSpectrum spectrum(square);
  return static_cast<int>((spectrum.values().array() > kMoves * kMoves).count());
}

}  // namespace

std::vector<RigidPart> rigid_parts(const Mesh& mesh) {
  const std::vector<std::vector<NodeId>> elements = elements_of(mesh);
  PartSets sets(elements.size());
  join_faces(mesh, sets);
  while (join_touching(mesh, elements, sets)) {
  }
  std::map<std::size_t, RigidPart> parts;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    RigidPart& part = parts[sets.find(e)];
    ++part.elements;
    part.nodes.insert(part.nodes.end(), elements[e].begin(), elements[e].end());
  }
  std::vector<RigidPart> result;
  for (auto& [first, part] : parts) {
    std::ranges::sort(part.nodes);
    part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
    result.push_back(std::move(part));
  }
  std::ranges::stable_sort(result, std::ranges::greater{}, &RigidPart::elements);
  return result;
}

std::vector<std::vector<int>> parts_of_nodes(const Mesh& mesh, std::span<const RigidPart> parts) {
  std::vector<std::vector<int>> result(static_cast<std::size_t>(mesh.node_count()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const NodeId node : parts[p].nodes) {
      result[static_cast<std::size_t>(node)].push_back(static_cast<int>(p));
    }
  }
  return result;
}

std::vector<LooseJoint> loose_joints(const Mesh& mesh, std::span<const HeldAxis> held) {
  const std::vector<RigidPart> parts = rigid_parts(mesh);
  if ((parts.size() < 2 && held.empty()) || parts.size() > kMostParts) return {};
  const std::vector<std::vector<int>> owners = parts_of_nodes(mesh, parts);
  PartMotions motions(mesh, parts);
  std::vector<std::vector<NodeId>> shared(parts.size());
  PartSets connected(parts.size());
  for (std::size_t n = 0; n < owners.size(); ++n) {
    for (const int owner : owners[n]) {
      if (owners[n].size() < 2) continue;
      const auto part = static_cast<std::size_t>(owner);
      const auto first = static_cast<std::size_t>(owners[n].front());
      shared[part].push_back(static_cast<NodeId>(n));
      if (part == first) continue;
      motions.join(first, part, static_cast<NodeId>(n));
      connected.join(first, part);
    }
  }
  for (const HeldAxis& one : held) {
    const auto& own = owners[static_cast<std::size_t>(one.node)];
    if (!own.empty()) motions.hold(static_cast<std::size_t>(own.front()), one.node, one.axis);
  }
  if (held.empty()) {  // the largest part of each component stays
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (connected.find(p) == p) motions.hold_whole(p);
    }
  }
  const MatrixX free = motions.free_motions();
  std::vector<LooseJoint> result;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const MatrixX own = free.middleRows(6 * static_cast<Eigen::Index>(p), 6);
    const int count = own.cols() > 0 ? rank_of(own) : 0;
    if (count == 0) continue;
    const Vector3 centre = mesh.nodes(parts[p].nodes, Eigen::all).colwise().mean().transpose();
    result.push_back({parts[p].elements, centre, shared[p], count});
  }
  return result;
}

std::string describe(const LooseJoint& loose, const Mesh& mesh) {
  const auto place = [](const Vector3& x) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x(), x.y(), x.z());
  };
  const auto node = [&](NodeId n) {
    return fmt::format("node {} at {}", n, place(mesh.nodes.row(n).transpose()));
  };
  std::string text = fmt::format("{} element{} around {} m ", loose.elements,
                                 loose.elements == 1 ? "" : "s", place(loose.centre));
  text += loose.elements == 1 ? "is" : "are";
  if (loose.shared.empty()) return text + " connected to nothing";
  if (loose.shared.size() == 1) {
    return text + fmt::format(" joined to the others only at {} m", node(loose.shared[0]));
  }
  const Line line(mesh.nodes, loose.shared);
  if (line.straight) {
    return text + fmt::format(" joined to the others only along the edge from {} m to {} m",
                              node(line.first), node(line.last));
  }
  return text + fmt::format(" joined to the others only at edges and nodes, such as {} m",
                            node(loose.shared[0]));
}

}  // namespace sinew::mesh
