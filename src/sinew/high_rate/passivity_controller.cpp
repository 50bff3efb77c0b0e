#include "sinew/high_rate/passivity_controller.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::high_rate {

PassivityController::PassivityController(const HighRateSettings& settings)
    : settings_(settings),
      before_(VectorX::Constant(static_cast<Eigen::Index>(settings.hands.size()),
                                std::numeric_limits<double>::quiet_NaN())),
      motion_(VectorX::Zero(before_.size())),
      force_(motion_) {}

void PassivityController::observe(const VectorX& places, double stored) {
  double put_in = 0.0;
  for (Eigen::Index h = 0; h < places.size(); ++h) {
    const double moved = places[h] - before_[h];
    motion_[h] = std::isfinite(moved) ? moved : 0.0;
    put_in += force_[h] * motion_[h];
    before_[h] = places[h];
  }
  created_ -= put_in;
  budget_ += put_in - (stored - stored_);
  stored_ = stored;
  if (stored == 0.0 && force_.isZero(0.0)) budget_ = std::min(budget_, 0.0);
}

void PassivityController::damp(const MatrixX& stiffness, Eigen::Ref<VectorX> force) {
  damping_ = 0.0;
  const double square = motion_.squaredNorm();
  double twice = 0.0;  // d^T K d, of twice the energy that is foreseen
  for (Eigen::Index h = 0; h < force.size(); ++h) {
    twice += motion_[h] * stiffness.row(h).dot(motion_);
  }
  if (twice > 0.0) {
    const PassivitySettings& passivity = settings_.passivity;
    if (passivity.enabled) {
      const double need = 0.5 * (1.0 + passivity.reserve) * twice - budget_;
      const double least = std::min(need, 0.5 * passivity.damping_limit * twice);
      damping_ = std::max(least, 0.0) / square * settings_.period;
    }
    ++touched_;
    damping_sum_ += damping_;
  }
  for (Eigen::Index h = 0; h < force.size(); ++h) {
    const HandRow& hand = settings_.hands[static_cast<std::size_t>(h)];
    const bool held = stiffness(h, h) > 0.0;
    if (held) force[h] += damping_ / settings_.period * motion_[h];
    force[h] = std::clamp(force[h], hand.min, hand.max);
    force_[h] = force[h];
  }
}

}  // namespace sinew::high_rate
