#include "sinew/constraint/electrode_probe.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

namespace {

struct Triangle {
  Vector3 middle, area;  // m; m^2 along the normal
};

Triangle place(const Configuration& configuration, const ElectrodeTriangle& triangle) {
  const Vector3 a = configuration.position(triangle.corners[0]),
                b = configuration.position(triangle.corners[1]),
                c = configuration.position(triangle.corners[2]);
  return {(a + b + c) / 3.0, 0.5 * (b - a).cross(c - a)};
}

}  // namespace

CapacitanceProbe::CapacitanceProbe(std::string name,
                                   std::array<std::vector<ElectrodeTriangle>, 2> electrodes,
                                   double permittivity)
    : Probe(std::move(name), {{"", "F"}}),
      electrodes_(std::move(electrodes)),
      permittivity_(permittivity) {}

void CapacitanceProbe::measure(const Configuration& configuration, std::span<double> values) const {
  double sum = 0.0;  // of A^2/(d A), both electrodes
  for (const auto& electrode : electrodes_) {
    for (const ElectrodeTriangle& one : electrode) {
      const Triangle here = place(configuration, one);
      const double volume =
          std::abs(here.area.dot(configuration.position(one.opposite) - here.middle));
      sum += here.area.squaredNorm() / volume;
    }
  }
  values[0] = 0.5 * permittivity_ * sum;
}

Points CapacitanceProbe::marks(const Configuration& configuration) const {
  Points result(2, 3);
  for (std::size_t k = 0; k < 2; ++k) {
    Vector3 moment = Vector3::Zero();
    double area = 0.0;
    for (const ElectrodeTriangle& one : electrodes_[k]) {
      const Triangle here = place(configuration, one);
      moment += here.area.norm() * here.middle;
      area += here.area.norm();
    }
    result.row(static_cast<Eigen::Index>(k)) = (moment / area).transpose();
  }
  return result;
}

}  // namespace sinew::constraint
