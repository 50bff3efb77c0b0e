#include "sinew/estimate/reduced_rank_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "sinew/core/whole.hpp"

namespace sinew::estimate {

namespace {

// Numbers whose deviation is below this part of the largest of their kind get less weight, since
// they are rounding.
constexpr double kNegligible = 1e-6;

// Divides rows by their norms, and all by the square root of their number.
void normalise(Eigen::Ref<MatrixX> rows) {
  const VectorX norms = rows.rowwise().norm();
  const double least = norms.size() > 0 ? kNegligible * norms.maxCoeff() : 0.0;
  if (!(least > 0.0)) return;
  const double count = std::sqrt(static_cast<double>(rows.rows()));
  for (Eigen::Index k = 0; k < rows.rows(); ++k) rows.row(k) /= count * std::max(norms[k], least);
}

}  // namespace

ReducedRankFilter::ReducedRankFilter(VectorX prior, VectorX walk, Eigen::Index readings,
                                     Eigen::Index states, int lags, Eigen::Index rank)
    : prior_(std::move(prior)),
      walk_(std::move(walk)),
      readings_(readings),
      states_(states),
      rank_(std::max(rank, prior_.size())),
      lags_(lags) {
  restart();
}

MatrixX ReducedRankFilter::covariance() const {
  const auto own = factor_.topRows(size());
  return own * own.transpose();
}

VectorX ReducedRankFilter::reading_deviation(int lag) const {
  return mean_.segment(reading_row(lag), readings_);
}

VectorX ReducedRankFilter::state_deviation() const { return mean_.tail(states_); }

void ReducedRankFilter::restart() {
  const Eigen::Index n = size();
  mean_.setZero(n + (lags_ + 1) * readings_ + states_);
  factor_.setZero(rows(), n);
  factor_.topRows(n) = prior_.asDiagonal();
}

void ReducedRankFilter::begin_step(double seconds) {
  const Eigen::Index n = size(), before = columns(), older = lags_ * readings_;
  MatrixX next = MatrixX::Zero(rows(), before + n);
  next.leftCols(before) = factor_;
  next.leftCols(before).middleRows(n + readings_, older) = factor_.middleRows(n, older);
  next.leftCols(before).middleRows(n, readings_).setZero();
  next.topRows(n).rightCols(n) = (std::sqrt(seconds) * walk_).asDiagonal();
  factor_ = std::move(next);
  const VectorX readings = mean_.segment(n, older);
  mean_.segment(n + readings_, older) = readings;
  mean_.segment(n, readings_).setZero();
}

// With L_x^T = Q R, the covariance of the inputs is R^T R. Unlike a Cholesky factorisation, QR
// needs no positive pivots, so it also gives the triangular factor of a semidefinite covariance
// (Golub & Van Loan, Matrix Computations, 4th ed. 2013, sec. 5.2). As in Cholesky's factor, the
// diagonal is made non-negative.
void ReducedRankFilter::begin_rest() {
  const Eigen::Index n = size();
  const Eigen::HouseholderQR<MatrixX> qr(factor_.topRows(n).transpose());
  MatrixX own = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>().transpose();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (own(k, k) < 0.0) own.col(k) *= -1.0;
  }
  factor_.setZero(rows(), n);
  factor_.topRows(n) = own;
  mean_.tail(rows() - n).setZero();
}

void ReducedRankFilter::put_column(Eigen::Index column, const VectorX& reading,
                                   const VectorX& state) {
  factor_.col(column).segment(size(), readings_) = reading;
  factor_.col(column).tail(states_) = state;
}

void ReducedRankFilter::end_step() { cut(); }

// The deviation is L c, where c is the shortest least-squares solution of L_x c = mean - inputs,
// with each input scaled by its prior. Inputs without variance contribute nothing.
void ReducedRankFilter::end_rest(const VectorX& inputs) {
  const Eigen::Index n = size();
  const auto scale = prior_.cwiseInverse().asDiagonal();
  const Eigen::CompleteOrthogonalDecomposition<MatrixX> own(scale * factor_.topRows(n));
  const VectorX part = own.solve(scale * (mean() - inputs));
  mean_.tail(rows() - n) = factor_.bottomRows(rows() - n) * part;
}

// Forms L Q with Q = (Q_1, Q_2) orthogonal and the rows of L_x in the span of Q_1: L_x Q_2 = 0.
void ReducedRankFilter::cut() {
  const Eigen::Index n = size(), count = columns();
  if (count <= rank_) return;
  const Eigen::HouseholderQR<MatrixX> qr(factor_.topRows(n).transpose());
  const MatrixX turned = factor_ * (qr.householderQ() * MatrixX::Identity(count, count));
  MatrixX scaled = turned.bottomRows(rows() - n).rightCols(count - n);
  normalise(scaled.topRows((lags_ + 1) * readings_));
  normalise(scaled.bottomRows(states_));
  const Eigen::SelfAdjointEigenSolver<MatrixX> principal(scaled.transpose() * scaled);
  factor_.resize(rows(), rank_);
  factor_.leftCols(n) = turned.leftCols(n);
  factor_.rightCols(rank_ - n) =
      turned.rightCols(count - n) * principal.eigenvectors().rightCols(rank_ - n);
  factor_.topRows(n).rightCols(rank_ - n).setZero();
}

// With S = R^(-1/2) L_y = U diag(s) V^T, the mean becomes mean + L S^T (S S^T + 1)^-1 R^(-1/2)
// innovation, and L becomes L (1 + S^T S)^(-1/2) = L (1 - V diag(1 - 1/sqrt(1 + s^2)) V^T), whose
// square is the corrected covariance (Bishop, Etherton & Majumdar, Mon. Weather Rev. 129 (2001)
// 420-436, sec. 2).
void ReducedRankFilter::correct(int lag, Eigen::Index first, const VectorX& innovation,
                                const VectorX& variance) {
  const VectorX weight = variance.cwiseSqrt().cwiseInverse();
  const MatrixX own =
      weight.asDiagonal() * factor_.middleRows(reading_row(lag) + first, innovation.size());
  const Eigen::JacobiSVD<MatrixX> svd(own, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd s = svd.singularValues().array();
  const MatrixX along = factor_ * svd.matrixV();
  const VectorX scaled = svd.matrixU().transpose() * weight.cwiseProduct(innovation);
  mean_ += along * (s / (1.0 + s.square()) * scaled.array()).matrix();
  factor_ -=
      along * (1.0 - (1.0 + s.square()).rsqrt()).matrix().asDiagonal() * svd.matrixV().transpose();
}

void ReducedRankFilter::save(std::vector<double>& memory) const {
  memory.push_back(static_cast<double>(columns()));
  memory.insert(memory.end(), mean_.data(), mean_.data() + mean_.size());
  memory.insert(memory.end(), factor_.data(), factor_.data() + factor_.size());
}

bool ReducedRankFilter::load(std::span<const double>& memory) {
  const auto all = static_cast<std::size_t>(rows());
  if (memory.empty() || !(memory.front() >= 0.0) ||
      !(memory.front() <= static_cast<double>(memory.size()))) {
    return false;
  }
  const auto count = whole<std::size_t>(memory.front());
  if (memory.size() < 1 + all * (1 + count)) return false;
  std::ranges::copy(memory.subspan(1, all), mean_.data());
  factor_.resize(rows(), static_cast<Eigen::Index>(count));
  std::ranges::copy(memory.subspan(1 + all, all * count), factor_.data());
  memory = memory.subspan(1 + all * (1 + count));
  return true;
}

}  // namespace sinew::estimate
