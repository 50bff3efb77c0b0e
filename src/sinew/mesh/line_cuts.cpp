#include "sinew/mesh/line_cuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

/// Tolerance on the parameters of a face and of the line: closer cuts are merged, and a line that
/// misses a face by less still meets it.
constexpr double kTolerance = 1e-9;
/// Sine of the angle between a line and a face below which the line counts as lying in the face.
constexpr double kParallel = 1e-12;

class Cutter {
 public:
  Cutter(const Mesh& mesh, const Vector3& from, const Vector3& to)
      : mesh_(mesh), from_(from), along_(to - from), box_(from.cwiseMin(to), from.cwiseMax(to)) {
    const double margin = kTolerance * along_.norm();
    box_.min().array() -= margin;
    box_.max().array() += margin;
  }

  bool misses(std::span<const NodeId> nodes) const {
    Eigen::AlignedBox3d box;
    for (const NodeId node : nodes) box.extend(at(node));
    return !box_.intersects(box);
  }

  void meet(const Triangle& face) {
    const Vector3 a = at(face[0]), u = at(face[1]) - a, v = at(face[2]) - a;
    const Vector3 normal = u.cross(v);
    const double slope = normal.dot(along_);
    if (std::abs(slope) <= kParallel * normal.norm() * along_.norm()) return;
    const double share = normal.dot(a - from_) / slope;
    const Vector3 offset = from_ + share * along_ - a;
    const double area = normal.squaredNorm();
    const double r = offset.cross(v).dot(normal) / area, s = u.cross(offset).dot(normal) / area;
    if (std::min({r, s, 1.0 - r - s}) >= -kTolerance) keep(share);
  }

  // x(r, s) = a + r u + s v + r s w on the line: across it, along two directions p and q,
  //   p.(a - from) + r p.u + s p.v + r s p.w = 0, and with q; without s a quadratic equation in r
  // (Ramsey, Potter & Hansen, J. Graphics Tools 9 (2004) 41).
  void meet(const std::array<NodeId, 4>& face) {
    const Vector3 a = at(face[0]), u = at(face[1]) - a, v = at(face[3]) - a;
    const Vector3 w = at(face[2]) - at(face[1]) - v, start = a - from_;
    const Vector3 p = along_.unitOrthogonal(), q = along_.normalized().cross(p);
    const double pa = p.dot(start), pu = p.dot(u), pv = p.dot(v), pw = p.dot(w);
    const double qa = q.dot(start), qu = q.dot(u), qv = q.dot(v), qw = q.dot(w);
    const double c2 = pu * qw - qu * pw, c1 = pa * qw - qa * pw + pu * qv - qu * pv;
    const double c0 = pa * qv - qa * pv;
    for (const double r : roots(c2, c1, c0)) {
      const double pd = pv + r * pw, qd = qv + r * qw;
      const double divisor = std::abs(pd) > std::abs(qd) ? pd : qd;
      if (divisor == 0.0) continue;
      const double s = -(std::abs(pd) > std::abs(qd) ? pa + r * pu : qa + r * qu) / divisor;
      if (std::min({r, s, 1.0 - r, 1.0 - s}) < -kTolerance) continue;
      keep((start + r * u + s * v + r * s * w).dot(along_) / along_.squaredNorm());
    }
  }

  std::vector<double> cuts() {
    std::ranges::sort(cuts_);
    std::vector<double> result{0.0};
    for (const double cut : cuts_) {
      if (cut > result.back() + kTolerance && cut < 1.0 - kTolerance) result.push_back(cut);
    }
    result.push_back(1.0);
    return result;
  }

 private:
  Vector3 at(NodeId node) const { return mesh_.nodes.row(node).transpose(); }
  void keep(double share) { cuts_.push_back(share); }

  // Real roots of c2 r^2 + c1 r + c0, without cancellation.
  static std::vector<double> roots(double c2, double c1, double c0) {
    const double discriminant = c1 * c1 - 4.0 * c2 * c0;
    if (discriminant < 0.0) return {};
    const double sum = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    std::vector<double> result;
    if (sum != 0.0) result.push_back(c0 / sum);
    if (c2 != 0.0) result.push_back(sum / c2);
    return result;
  }

  const Mesh& mesh_;
  Vector3 from_, along_;
  Eigen::AlignedBox3d box_;
  std::vector<double> cuts_;
};

}  // namespace

std::vector<double> line_cuts(const Mesh& mesh, const Vector3& from, const Vector3& to) {
  if (!((to - from).norm() > 0.0)) return {0.0, 1.0};
  Cutter cutter(mesh, from, to);
  for (const Tetrahedron& tetrahedron : mesh.tetrahedra) {
    if (cutter.misses(tetrahedron)) continue;
    for (const Triangle& face : faces_of(tetrahedron)) cutter.meet(face);
  }
  for (const Hexahedron& hexahedron : mesh.hexahedra) {
    if (cutter.misses(hexahedron)) continue;
    for (const auto& face : faces_of(hexahedron)) cutter.meet(face);
  }
  return cutter.cuts();
}

}  // namespace sinew::mesh
