#include "sinew/run/kept_factors.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::run {

namespace {

// Searches after which a kept factor is tried again.
constexpr double kSearches = 16.0;
// Motions with a kept factor that cost as much as a new factor.
constexpr double kMotions = 4.5;
// Smaller parts are chance.
constexpr double kLeast = 1e-4;

}  // namespace

void KeptFactors::save(std::vector<double>& numbers) const {
  numbers.clear();
  numbers.reserve(3);  // later steps allocate nothing
  if (left_ > 0.0) numbers.assign({left_, next_, age_});
}

bool KeptFactors::pays(double residual, double tolerance) const {
  if (left_ == 0.0 || residual <= tolerance) return true;
  return left_ < 1.0 && std::log(tolerance / residual) >= kMotions * std::log(left_);
}

void KeptFactors::take(double left, double next) {
  next_ = next;
  if (left > 0.0) {
    left_ = std::clamp(left, kLeast, 1.0);
    age_ = 0.0;
  } else if (left_ > 0.0 && ++age_ >= kSearches) {
    left_ = age_ = 0.0;
  }
}

}  // namespace sinew::run
