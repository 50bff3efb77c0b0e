#include "sinew/constraint/line_probe.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

namespace {

Points positions(const Configuration& configuration,
                 const std::vector<mechanics::MaterialPoint>& points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t k = 0; k < points.size(); ++k) {
    result.row(static_cast<Eigen::Index>(k)) = configuration.position(points[k]).transpose();
  }
  return result;
}

double length_of(const Configuration& configuration,
                 const std::vector<mechanics::MaterialPoint>& points) {
  double length = 0.0;
  Vector3 before = configuration.position(points.front());
  for (const mechanics::MaterialPoint& point : points) {
    const Vector3 here = configuration.position(point);
    length += (here - before).norm();
    before = here;
  }
  return length;
}

std::vector<ProbeComponent> numbered(std::size_t count, const char* unit) {
  if (count == 1) return {{"", unit}};
  std::vector<ProbeComponent> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back({fmt::format("{}", k), unit});
  return result;
}

}  // namespace

CurvatureProbe::CurvatureProbe(std::string name, std::vector<Triple> places,
                               const std::optional<Vector3>& about)
    : Probe(std::move(name), numbered(places.size(), "1/m")),
      places_(std::move(places)),
      about_(about) {}

void CurvatureProbe::measure(const Configuration& configuration, std::span<double> values) const {
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Vector3 middle = configuration.position(places_[k][1]);
    const Vector3 a = middle - configuration.position(places_[k][0]);
    const Vector3 b = configuration.position(places_[k][2]) - middle;
    const double sides = a.norm() * b.norm() * (a + b).norm();
    const Vector3 curvature = 2.0 * a.cross(b) / sides;
    values[k] = about_ ? curvature.dot(*about_) : curvature.norm();
  }
}

Points CurvatureProbe::marks(const Configuration& configuration) const {
  Points result(static_cast<Eigen::Index>(places_.size()), 3);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    result.row(static_cast<Eigen::Index>(k)) = configuration.position(places_[k][1]).transpose();
  }
  return result;
}

StretchProbe::StretchProbe(std::string name, std::vector<mechanics::MaterialPoint> points,
                           double rest_length, const Law& law)
    : Probe(std::move(name), {{"", law.unit}}),
      points_(std::move(points)),
      rest_length_(rest_length),
      law_(law) {}

void StretchProbe::measure(const Configuration& configuration, std::span<double> values) const {
  values[0] = law_.offset + law_.gain * (length_of(configuration, points_) / rest_length_ - 1.0);
}

Points StretchProbe::marks(const Configuration& configuration) const {
  return positions(configuration, points_);
}

AttenuationProbe::AttenuationProbe(std::string name, std::vector<mechanics::MaterialPoint> points,
                                   const Loss& loss)
    : Probe(std::move(name), {{"", "dB"}}), points_(std::move(points)), loss_(loss) {}

void AttenuationProbe::measure(const Configuration& configuration, std::span<double> values) const {
  double turn = 0.0;
  for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
    const Vector3 middle = configuration.position(points_[k]);
    const Vector3 a = middle - configuration.position(points_[k - 1]);
    const Vector3 b = configuration.position(points_[k + 1]) - middle;
    turn += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  values[0] = loss_.per_length * length_of(configuration, points_) + loss_.per_turn * turn;
}

Points AttenuationProbe::marks(const Configuration& configuration) const {
  return positions(configuration, points_);
}

}  // namespace sinew::constraint
