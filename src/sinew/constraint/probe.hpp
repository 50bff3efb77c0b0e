/// @file
/// Probes: quantities measured on the robot's present shape. They have no rows, so a run gives the
/// same bits with and without them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// One number of a probe.
struct ProbeComponent {
  std::string name;  ///< "x", "length", "3.x"; empty for a probe's only number
  const char* unit;  ///< "m", "rad", "1/m"; empty for a ratio
};

/// A quantity measured on the bodies, with named components.
class Probe {
 public:
  virtual ~Probe() = default;
  const std::string& name() const { return name_; }
  /// "point", "line", "bend", "distance" or "extent"; further kinds for quantities of sensors.
  virtual const char* kind() const = 0;
  /// The numbers that measure() writes.
  const std::vector<ProbeComponent>& components() const { return components_; }
  /// @param configuration of the bodies now. @param values (components,), replaced.
  virtual void measure(const Configuration& configuration, std::span<double> values) const = 0;
  /// Points that show where it measures, (k, 3) m; lines join those of a line or a distance.
  virtual Points marks(const Configuration& configuration) const = 0;
  /// Number of rows of marks().
  virtual std::size_t mark_count() const { return 2; }

 protected:
  /// @param name of the probe. @param components the numbers that it measures.
  Probe(std::string name, std::vector<ProbeComponent> components)
      : name_(std::move(name)), components_(std::move(components)) {}

 private:
  std::string name_;
  std::vector<ProbeComponent> components_;
};

/// Position of a material point, or of the mean of a set attached as one: x, y, z, m.
class PointProbe : public Probe {
 public:
  /// @param name for headings. @param point whose position is measured.
  PointProbe(std::string name, mechanics::MaterialPoint point);
  const char* kind() const override { return "point"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return 1; }

 private:
  mechanics::MaterialPoint point_;
};

/// Length and points of a line of material points. The length is the sum of the distances between
/// neighbours. Order: length, 0.x, 0.y, 0.z, 1.x, ...; m.
class LineProbe : public Probe {
 public:
  /// @param name for headings. @param points in order, two or more.
  LineProbe(std::string name, std::vector<mechanics::MaterialPoint> points);
  const char* kind() const override { return "line"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return points_.size(); }

 private:
  std::vector<mechanics::MaterialPoint> points_;
};

/// The distance between two material points, m.
class DistanceProbe : public Probe {
 public:
  /// @param name for headings. @param points both points.
  DistanceProbe(std::string name, std::array<mechanics::MaterialPoint, 2> points);
  const char* kind() const override { return "distance"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;

 private:
  std::array<mechanics::MaterialPoint, 2> points_;
};

/// A face or a cross-section: its nodes, and its normal at rest.
struct ProbeFace {
  std::vector<mechanics::MaterialPoint> points;
  Points rest;                    ///< (n, 3) m
  std::optional<Vector3> normal;  ///< at rest; none: of the best-fit plane of the nodes
};

/// Angle between the normals of two faces, rad, 0 to pi. With an axis, the right-handed angle about
/// it from the first normal to the second, -pi to pi, of the components normal to the axis. At
/// rest, both normals point from the centre of the first face to that of the second. If one of them
/// is normal to this line, so that the line cannot orient it, both point to the same side.
///
/// The present normal of a face is R n: n is its normal at rest, and R is the rotation that fits
/// its nodes best, argmin sum |x - x_mean - R (X - X_mean)|^2 with det R = 1 (Kabsch, Acta Cryst.
/// A32, 1976; sign from Umeyama, IEEE PAMI 13, 1991). A plane face may have any shape but a line.
/// For a cross-section that warps, R is its mean rotation.
class BendProbe : public Probe {
 public:
  /// @param name for headings. @param faces both faces. @param about the axis, or none.
  /// Throws Error: degenerate-orientation for a face that is a line or fits no plane better than
  /// another, and for a normal along the axis.
  BendProbe(std::string name, std::array<ProbeFace, 2> faces, const std::optional<Vector3>& about);
  const char* kind() const override { return "bend"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;

 private:
  struct Pose {
    Vector3 middle, normal;
  };
  Pose pose(const Configuration& configuration, std::size_t face) const;

  std::array<ProbeFace, 2> faces_;
  std::array<Vector3, 2> normals_;  // at rest
  std::optional<Vector3> about_;
};

/// Extent of a set of nodes, m: along an axis, the largest coordinate minus the smallest; across
/// it, the smallest or largest such extent over all directions normal to the axis. The smallest is
/// the width measured by a calliper (Toussaint, Proc. IEEE MELECON, 1983), the largest the
/// diameter.
class ExtentProbe : public Probe {
 public:
  enum class Way { along, smallest_across, largest_across };
  /// @param name for headings. @param points the nodes. @param axis unit length.
  /// @param way along or across the axis.
  ExtentProbe(std::string name, std::vector<mechanics::MaterialPoint> points, const Vector3& axis,
              Way way);
  const char* kind() const override { return "extent"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;

 private:
  // An extent, and the two nodes between which it was measured.
  struct Span {
    double reach = 0.0;
    std::array<std::size_t, 2> ends{};
  };
  using Points2 = std::vector<Eigen::Vector2d>;
  static Span largest_span(const Points2& points, const std::vector<std::size_t>& hull);
  static Span smallest_span(const Points2& points, const std::vector<std::size_t>& hull,
                            const Span& largest);
  Span span_of(const Configuration& configuration) const;

  std::vector<mechanics::MaterialPoint> points_;
  Vector3 axis_;
  Way way_;
};

}  // namespace sinew::constraint
