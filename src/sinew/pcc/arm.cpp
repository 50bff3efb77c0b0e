#include "sinew/pcc/arm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/gauss.hpp"

namespace sinew::pcc {

namespace {

[[noreturn]] void refuse(ErrorKind kind, const std::string& item, std::string message,
                         std::string remedy) {
  throw Error(kind, {.item = item}, std::move(message), std::move(remedy));
}

void check(const std::string& item, const char* what, double value, const char* unit,
           bool zero_allowed) {
  if (!std::isfinite(value)) {
    refuse(ErrorKind::not_finite, item, fmt::format("its {} is not finite", what), "give a number");
  }
  if (value < 0.0 || (value == 0.0 && !zero_allowed)) {
    refuse(ErrorKind::out_of_range, item, fmt::format("its {} is {:g} {}", what, value, unit),
           zero_allowed ? "give zero or more" : "give more than zero");
  }
}

void check(const std::string& item, const Segment& segment) {
  check(item, "length", segment.length, "m", false);
  check(item, "mass", segment.mass, "kg", false);
  check(item, "stiffness", segment.stiffness, "N m", true);
  check(item, "damping", segment.damping, "N m s", true);
  check(item, "dead length", segment.dead_length, "m", true);
  check(item, "axial damping", segment.axial_damping, "N s/m", true);
  if (!std::isfinite(segment.gamma)) {
    refuse(ErrorKind::not_finite, item, "its gamma is not finite", "give an angle");
  }
  if (segment.extensible) {
    if (segment.bending == Bending::planar) {
      refuse(ErrorKind::conflicting_keys, item, "a planar segment cannot be extensible",
             "choose spatial bending, or leave the extension out");
    }
    check(item, "axial stiffness", segment.axial_stiffness, "N/m", false);
  }
}

void add_masses(std::vector<Particle>& masses, int number, double mass, const ArmSettings& arm) {
  switch (arm.centre) {
    case MassCentre::arc:
      masses.push_back({number, 0.5, 1.0, mass, Vector3::Zero()});
      return;
    case MassCentre::chord:
      masses.push_back({number, 1.0, 0.5, mass, Vector3::Zero()});
      return;
    case MassCentre::distributed:
      for (const GaussPoint& point : gauss_points(arm.mass_points)) {
        masses.push_back({number, point.at, 1.0, point.weight * mass, Vector3::Zero()});
      }
      return;
  }
}

}  // namespace

Matrix3 ArmSettings::hanging() { return Vector3(1.0, -1.0, -1.0).asDiagonal(); }

Arm::Arm(ArmSettings settings) : settings_(std::move(settings)) {
  const auto& list = settings_.segments;
  const std::string& name = settings_.name;
  if (list.empty()) {
    refuse(ErrorKind::empty_list, name, "it has no segments", "give at least one");
  }
  if (settings_.mass_points < 1 || settings_.mass_points > kMaxGaussPoints) {
    refuse(ErrorKind::out_of_range, name,
           fmt::format("{} mass points a segment", settings_.mass_points),
           fmt::format("give 1 to {}", kMaxGaussPoints));
  }
  if (!settings_.gravity.allFinite() || !settings_.base.allFinite()) {
    refuse(ErrorKind::not_finite, name, "gravity or base is not finite", "give three numbers");
  }
  if (!(settings_.frame.transpose() * settings_.frame).isIdentity(1e-9) ||
      settings_.frame.determinant() < 0.0) {
    refuse(ErrorKind::out_of_range, name, "the base's frame is not a rotation",
           "give an orthogonal matrix of determinant 1");
  }
  check(name, "radius", settings_.radius, "m", false);
  std::vector<double> stiffness, damping;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Segment& segment = list[i];
    check(fmt::format("segment {} of {}", i, name), segment);
    first_.push_back(static_cast<int>(stiffness.size()));
    for (int k = segment.bending == Bending::planar ? 1 : 2; k > 0; --k) {
      stiffness.push_back(segment.stiffness);
      damping.push_back(segment.damping);
    }
    if (segment.extensible) {
      stiffness.push_back(segment.axial_stiffness);
      damping.push_back(segment.axial_damping);
    }
    add_masses(particles_, static_cast<int>(i), segment.mass, settings_);
  }
  const auto n = static_cast<Eigen::Index>(stiffness.size());
  stiffness_ = Eigen::Map<const VectorX>(stiffness.data(), n);
  damping_ = Eigen::Map<const VectorX>(damping.data(), n);
  actuation_ = settings_.actuation.size() == 0 ? MatrixX::Identity(n, n) : settings_.actuation;
  if (actuation_.rows() != n || !actuation_.allFinite()) {
    refuse(ErrorKind::wrong_length, name,
           fmt::format("the actuation has {} rows, the arm {} coordinates", actuation_.rows(), n),
           "give a finite matrix (coordinates, inputs)");
  }
  for (const PointLoad& load : settings_.loads) {
    if (load.segment < 0 || load.segment >= segments() || !(load.fraction >= 0.0) ||
        load.fraction > 1.0 || !load.force.allFinite()) {
      refuse(ErrorKind::out_of_range, name,
             fmt::format("a load on segment {} at {:g} of its length", load.segment, load.fraction),
             fmt::format("name a segment 0 to {}, a fraction 0 to 1, and a finite force",
                         segments() - 1));
    }
    particles_.push_back({load.segment, load.fraction, 1.0, 0.0, load.force});
  }
  std::stable_sort(particles_.begin(), particles_.end(),
                   [](const Particle& a, const Particle& b) { return a.segment < b.segment; });
}

double Arm::length() const {
  double sum = 0.0;
  for (const Segment& segment : settings_.segments) sum += segment.length + segment.dead_length;
  return sum;
}

VectorX channel_stiffness(double first, const VectorX& lengths) {
  return first / lengths[0] * lengths;
}

VectorX beam_stiffness(double bending, const VectorX& lengths) {
  return bending * lengths.cwiseInverse();
}

}  // namespace sinew::pcc
