#include "sinew/qp/complementary_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sinew::qp {

namespace {

// A pivot below this part of the entry's own diagonal is rounding.
constexpr double kNothing = 1e-11;
// Values in [1/2, 3/2) that differ between neighbours: fractional parts of multiples of the golden
// ratio (Knuth, The Art of Computer Programming 3, 1998, 6.4).
double scattered(Eigen::Index entry) {
  const double multiple = 0.6180339887498949 * static_cast<double>(entry + 1);
  return 0.5 + multiple - std::floor(multiple);
}

}  // namespace

ComplementaryPath::ComplementaryPath(MatrixX matrix, VectorX slope, const std::vector<char>& held,
                                     VectorX value, double blur)
    : matrix_(std::move(matrix)),
      slope_(std::move(slope)),
      value_(std::move(value)),
      scale_(matrix_.diagonal().cwiseAbs()),
      held_(held.size(), 0) {
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    if (held[static_cast<std::size_t>(i)] == 0) continue;
    if (moves(i)) exchange(i);  // otherwise others hold it already
  }
  lift(blur);
}

bool ComplementaryPath::moves(Eigen::Index entry) const {
  const double pivot = std::abs(matrix_(entry, entry)), own = scale_[entry];
  return is_held(entry) ? pivot * own > kNothing : pivot > kNothing * own;
}

void ComplementaryPath::lift(double blur) {
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    const double size = is_held(i) ? std::abs(matrix_(i, i)) : 1.0;
    value_[i] = std::max(value_[i], 0.0) + blur * scattered(i) * size;
  }
}

// The principal pivotal transform: exchanges entry i of y and z.
void ComplementaryPath::exchange(Eigen::Index entry) {
  const double pivot = 1.0 / matrix_(entry, entry);
  const VectorX column = matrix_.col(entry);
  const Eigen::RowVectorXd row = matrix_.row(entry);
  const double slope = slope_[entry];
  matrix_.noalias() -= (pivot * column) * row;
  slope_ -= pivot * slope * column;
  matrix_.row(entry) = -pivot * row;
  matrix_.col(entry) = pivot * column;
  matrix_(entry, entry) = pivot;
  slope_[entry] = -pivot * slope;
  char& held = held_[static_cast<std::size_t>(entry)];
  held = held == 0 ? 1 : 0;
}

VectorX ComplementaryPath::rates() const {
  VectorX result = direction_ * slope_;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (!is_held(i)) result[i] = 0.0;
  }
  return result;
}

double ComplementaryPath::look_ahead() {
  double least = std::numeric_limits<double>::infinity();
  next_ = -1;
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    const double falls = -direction_ * slope_[i];
    if (!(falls > 0.0) || !(value_[i] < least * falls)) continue;
    least = value_[i] / falls;
    next_ = i;
  }
  return least;
}

void ComplementaryPath::advance(double by) {
  value_ = (value_ + by * direction_ * slope_).cwiseMax(0.0);
}

bool ComplementaryPath::turn() {
  if (next_ < 0 || !moves(next_)) return false;
  if (matrix_(next_, next_) < 0.0) direction_ = -direction_;
  value_[next_] = 0.0;
  exchange(next_);
  next_ = -1;
  return true;
}

}  // namespace sinew::qp
