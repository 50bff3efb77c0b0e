/// @file
/// Probes: numbers read off the robot's present shape. They only look: they have no rows, and a run
/// takes the same bits with and without them.
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
  const char* unit;  ///< "m", "rad", "1/m"; empty of a ratio
};

class Probe {
 public:
  virtual ~Probe() = default;
  const std::string& name() const { return name_; }
  /// "point", "line", "bend", "distance" or "extent"; others of what sensors measure.
  virtual const char* kind() const = 0;
  /// What measure() writes.
  const std::vector<ProbeComponent>& components() const { return components_; }
  /// @param configuration of the bodies now. @param values (components,), replaced.
  virtual void measure(const Configuration& configuration, std::span<double> values) const = 0;
  /// (k, 3) m: points that show where it measures; joined by lines where it is a line or a
  /// distance.
  virtual Points marks(const Configuration& configuration) const = 0;
  /// Rows of marks().
  virtual std::size_t mark_count() const { return 2; }

 protected:
  /// @param name of the probe. @param components what it measures.
  Probe(std::string name, std::vector<ProbeComponent> components)
      : name_(std::move(name)), components_(std::move(components)) {}

 private:
  std::string name_;
  std::vector<ProbeComponent> components_;
};

/// Where a material point, or the mean of a set attached as one, is: x, y, z, m.
class PointProbe : public Probe {
 public:
  /// @param name for headings. @param point what is measured.
  PointProbe(std::string name, mechanics::MaterialPoint point);
  const char* kind() const override { return "point"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return 1; }

 private:
  mechanics::MaterialPoint point_;
};

/// Material points along a line: its length, the sum of the distances from each to the next, and
/// every point: length, 0.x, 0.y, 0.z, 1.x, ...; m.
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
  /// @param name for headings. @param points both.
  DistanceProbe(std::string name, std::array<mechanics::MaterialPoint, 2> points);
  const char* kind() const override { return "distance"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;

 private:
  std::array<mechanics::MaterialPoint, 2> points_;
};

/// A face or a cross-section: nodes and its normal at rest.
struct ProbeFace {
  std::vector<mechanics::MaterialPoint> points;
  Points rest;                    ///< (n, 3) m
  std::optional<Vector3> normal;  ///< at rest; none: that of the plane that fits the nodes best
};

/// The angle between the normals of two faces, rad, 0 to pi; or, about an axis, from the first to
/// the second by the right hand, -pi to pi, of the normals' parts across that axis. At rest both
/// normals point from the first face's middle to that of the second; where one lies across this
/// line, so that it says nothing, to the same side of each other.
///
/// A face's normal now is R n: n is its normal at rest, R the rotation that fits its nodes best,
/// argmin sum |x - x_mean - R (X - X_mean)|^2 with det R = 1 (Kabsch, Acta Cryst. A32, 1976; the
/// sign by Umeyama, IEEE PAMI 13, 1991). A plane face may have any shape that is no line; of a
/// cross-section that warps this is the mean.
class BendProbe : public Probe {
 public:
  /// @param name for headings. @param faces both. @param about the axis, or none.
  /// Throws Error(degenerate-orientation) for a face that is a line or has no plane of its own, and
  /// for a normal along the axis.
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

/// How far a set of nodes reaches, m: along an axis, the largest coordinate less the smallest; or
/// across it, the least or the greatest such reach of all directions normal to it. The least is
/// that of a calliper (Toussaint, Proc. IEEE MELECON, 1983), the greatest the diameter.
class ExtentProbe : public Probe {
 public:
  enum class Way { along, smallest_across, largest_across };
  /// @param name for headings. @param points the nodes. @param axis unit length. @param way see
  ///   the class.
  ExtentProbe(std::string name, std::vector<mechanics::MaterialPoint> points, const Vector3& axis,
              Way way);
  const char* kind() const override { return "extent"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;

 private:
  // Two nodes between which it was measured, and the reach.
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
