#include "sinew/pcc/drive_cylinder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

void require(bool good, ErrorKind kind, const std::string& message, const char* remedy) {
  if (!good) throw Error(kind, {.item = "drive cylinder"}, message, remedy);
}

}  // namespace

DriveCylinder DriveCylinder::second_order(double gain, double frequency, double damping,
                                          double sample_time) {
  require(frequency > 0.0 && damping >= 0.0 && sample_time > 0.0 && std::isfinite(gain),
          ErrorKind::out_of_range,
          fmt::format("gain {:g}, {:g} rad/s, damping {:g}, sampled by {:g} s", gain, frequency,
                      damping, sample_time),
          "give frequency and sample time above zero, damping zero or more");
  // exp of [F G; 0 0] h is [A B; 0 1] (Van Loan, IEEE Trans. Automatic Control 23, 1978).
  Matrix3 continuous = Matrix3::Zero();
  continuous(0, 1) = frequency;
  continuous(1, 0) = -frequency;
  continuous(1, 1) = -2.0 * damping * frequency;
  continuous(1, 2) = frequency;
  const Matrix3 held = (sample_time * continuous).exp();
  DriveCylinder cylinder;
  cylinder.a = held.topLeftCorner<2, 2>();
  cylinder.b = held.topRightCorner<2, 1>();
  cylinder.c << gain, 0.0;
  cylinder.sample_time = sample_time;
  return cylinder;
}

void DriveCylinder::check() const {
  require(a.allFinite() && b.allFinite() && c.allFinite() && std::isfinite(d),
          ErrorKind::not_finite, "a coefficient is not finite", "give numbers");
  require(sample_time > 0.0 && std::isfinite(sample_time), ErrorKind::out_of_range,
          fmt::format("the sample time is {:g} s", sample_time), "give more than zero");
  require(spectral_radius() < 1.0, ErrorKind::out_of_range,
          fmt::format("an eigenvalue of A has size {:g}", spectral_radius()),
          "a cylinder is stable: all are below 1");
  require(lowest_input < highest_input && lowest_volume < highest_volume,
          ErrorKind::contradictory_limits,
          fmt::format("commands {:g} to {:g}, volumes {:g} to {:g}", lowest_input, highest_input,
                      lowest_volume, highest_volume),
          "give lowest < highest");
}

double DriveCylinder::gain() const { return c.dot(rest(1.0)) + d; }

Eigen::Vector2d DriveCylinder::rest(double command) const {
  return (Eigen::Matrix2d::Identity() - a).inverse() * b * command;
}

double DriveCylinder::spectral_radius() const { return a.eigenvalues().cwiseAbs().maxCoeff(); }

VectorX DriveCylinder::simulate(const VectorX& command, const Eigen::Vector2d& start) const {
  check();
  VectorX volume(command.size());
  Eigen::Vector2d x = start;
  for (Eigen::Index k = 0; k < command.size(); ++k) {
    const double u = std::clamp(command[k], lowest_input, highest_input);
    volume[k] = std::clamp(c.dot(x) + d * u, lowest_volume, highest_volume);
    x = a * x + b * u;
  }
  return volume;
}

}  // namespace sinew::pcc
