#include "sinew/high_rate/force_estimate.hpp"

#include <cmath>

namespace sinew::high_rate {

ForceEstimate::ForceEstimate(const HighRateSettings& settings)
    : settings_(settings),
      program_(qp::QuadraticProgram::sized(static_cast<int>(settings.unknown.size()), 0)),
      solver_(static_cast<int>(settings.unknown.size()), 0),
      factor_(static_cast<Eigen::Index>(settings.unknown.size())),
      column_(VectorX::Zero(static_cast<Eigen::Index>(settings.unknown.size()))),
      deviation_(column_) {
  for (Eigen::Index k = 0; k < column_.size(); ++k) {
    const UnknownRow& row = settings.unknown[static_cast<std::size_t>(k)];
    program_.lower[k] = row.min / row.prior;
    program_.upper[k] = row.max / row.prior;
    deviation_[k] = row.prior;
  }
}

double ForceEstimate::misfit(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
                             const VectorX& unknown) const {
  double sum = 0.0;
  for (Eigen::Index k = 0; k < unknown.size(); ++k) {
    const double part = unknown[k] / settings_.unknown[static_cast<std::size_t>(k)].prior;
    sum += 0.5 * part * part;
  }
  for (std::size_t s = 0; s < settings_.sensors.size(); ++s) {
    const SensorRow& sensor = settings_.sensors[s];
    const double reading = readings[static_cast<Eigen::Index>(s)];
    if (!std::isfinite(reading)) continue;
    const auto row = law.compliance().row(sensor.row);
    const double gap = law.free()[sensor.row] - reading + row.head(driven.size()).dot(driven) +
                       row.tail(unknown.size()).dot(unknown);
    sum += 0.5 * (gap / sensor.noise) * (gap / sensor.noise);
  }
  return sum;
}

// The unknowns are forces divided by their priors, so that the prior's Hessian is the identity.
bool ForceEstimate::solve(const TouchLaw& law, const VectorX& driven, const VectorX& readings,
                          Eigen::Ref<VectorX> unknown) {
  const Eigen::Index count = column_.size();
  program_.hessian.setIdentity();
  program_.gradient.setZero();
  for (std::size_t s = 0; s < settings_.sensors.size(); ++s) {
    const SensorRow& sensor = settings_.sensors[s];
    const double reading = readings[static_cast<Eigen::Index>(s)];
    if (!std::isfinite(reading)) continue;
    double gap = law.free()[sensor.row] - reading;
    gap += law.compliance().row(sensor.row).head(driven.size()).dot(driven);
    for (Eigen::Index k = 0; k < count; ++k) {
      const double prior = settings_.unknown[static_cast<std::size_t>(k)].prior;
      column_[k] = law.compliance()(sensor.row, driven.size() + k) * prior / sensor.noise;
    }
    program_.hessian.noalias() += column_ * column_.transpose();
    program_.gradient += (gap / sensor.noise) * column_;
  }
  const qp::QpResult& result = solver_.solve(program_);
  if (result.status != qp::QpStatus::optimal || !factor_.compute(program_.hessian)) return false;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double prior = settings_.unknown[static_cast<std::size_t>(k)].prior;
    unknown[k] = prior * result.x[k];
    column_.setZero();
    column_[k] = 1.0;
    factor_.solve(column_, column_);
    deviation_[k] = prior * std::sqrt(column_[k]);
  }
  return true;
}

}  // namespace sinew::high_rate
