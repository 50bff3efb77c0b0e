#include "sinew/estimate/random_walk_filter.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace sinew::estimate {

RandomWalkFilter::RandomWalkFilter(VectorX prior, VectorX walk, int lags)
    : prior_(std::move(prior)), walk_(std::move(walk)), lags_(lags) {
  restart();
}

Eigen::VectorBlock<const VectorX> RandomWalkFilter::mean(int lag) const {
  return mean_.segment(lag * size(), size());
}

MatrixX RandomWalkFilter::covariance() const { return covariance_.topLeftCorner(size(), size()); }

void RandomWalkFilter::restart() {
  const Eigen::Index n = size(), blocks = lags_ + 1;
  mean_.setZero(n * blocks);
  const MatrixX own = prior_.cwiseAbs2().asDiagonal();
  covariance_ = own.replicate(blocks, blocks);
}

void RandomWalkFilter::predict(double seconds) {
  const Eigen::Index n = size(), kept = n * lags_;
  const MatrixX earlier = covariance_.topLeftCorner(kept, kept);
  const MatrixX beside = covariance_.topRows(n).leftCols(kept);
  const VectorX means = mean_.head(kept);
  mean_.tail(kept) = means;
  covariance_.bottomRightCorner(kept, kept) = earlier;
  covariance_.topRows(n).rightCols(kept) = beside;
  covariance_.leftCols(n).bottomRows(kept) = beside.transpose();
  covariance_.diagonal().head(n) += walk_.cwiseAbs2() * seconds;
}

void RandomWalkFilter::correct(int lag, const MatrixX& sensitivity, const VectorX& innovation,
                               const VectorX& variance) {
  const Eigen::Index n = size(), first = lag * n;
  const MatrixX spread = sensitivity * covariance_.middleRows(first, n);  // H P
  MatrixX own = spread.middleCols(first, n) * sensitivity.transpose();
  own.diagonal() += variance;
  const MatrixX gain = own.llt().solve(spread).transpose();
  mean_ += gain * innovation;
  // (I - K H) P (I - K H)^T + K R K^T
  const MatrixX left = covariance_ - gain * spread;
  const MatrixX half = left.middleCols(first, n) * sensitivity.transpose();
  const MatrixX next = left + (gain * variance.asDiagonal() - half) * gain.transpose();
  covariance_ = 0.5 * (next + next.transpose());
}

void RandomWalkFilter::save(std::vector<double>& memory) const {
  memory.insert(memory.end(), mean_.data(), mean_.data() + mean_.size());
  memory.insert(memory.end(), covariance_.data(), covariance_.data() + covariance_.size());
}

bool RandomWalkFilter::load(std::span<const double>& memory) {
  const auto means = static_cast<std::size_t>(mean_.size());
  const auto all = means + static_cast<std::size_t>(covariance_.size());
  if (memory.size() < all) return false;
  std::ranges::copy(memory.first(means), mean_.data());
  std::ranges::copy(memory.subspan(means, all - means), covariance_.data());
  memory = memory.subspan(all);
  return true;
}

}  // namespace sinew::estimate
