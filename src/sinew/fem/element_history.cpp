#include "sinew/fem/element_history.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sinew/fem/solid_kernel.hpp"

namespace sinew::fem {

namespace {

using material::Lanes;
using material::lanes;

constexpr std::size_t kSix = 6;  // components of a symmetric tensor

}  // namespace

ElementHistory::ElementHistory(std::span<const SolidGroup> groups)
    : groups_(groups), parts_(groups.size()) {
  std::size_t state = 0, carried = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto& series = groups[g].law.prony;
    Part& part = parts_[g];
    part.relaxes = !series.empty();
    part.softens = groups[g].law.mullins.has_value();
    if (!part.relaxes && !part.softens) continue;
    part.points =
        static_cast<std::size_t>(groups[g].batches()) * static_cast<std::size_t>(groups[g].points);
    part.first_peak = state;
    if (part.softens) state += part.points;
    if (!part.relaxes) continue;
    part.first = state;
    part.first_carried = carried;
    for (const material::PronyTerm& term : series) {
      part.weight.push_back(term.relative_modulus / groups[g].law.long_term_share());
      part.time.push_back(term.relaxation_time);
    }
    part.decay.assign(series.size(), 0.0);
    part.rise.assign(series.size(), 0.0);
    state += kSix * part.points * (1 + series.size());
    carried += kSix * part.points;
  }
  state_.resize(state);
  carried_.resize(carried);
  reset();
}

void ElementHistory::reset() { std::ranges::fill(state_, LaneRow{}); }

void ElementHistory::begin_step(double time_step) {
  relaxed_ = !(time_step > 0.0);
  for (Part& part : parts_) {
    if (!part.relaxes) continue;
    const std::size_t terms = part.weight.size();
    part.factor = 1.0;
    for (std::size_t k = 0; k < terms; ++k) {
      const double x = time_step / part.time[k];
      part.decay[k] = relaxed_ ? 0.0 : std::exp(-x);
      part.rise[k] = relaxed_ ? 0.0 : -std::expm1(-x) / x;
      part.factor += part.weight[k] * part.rise[k];
    }
    if (relaxed_) continue;
    for (std::size_t q = 0; q < part.points; ++q) {
      const LaneRow* from = &state_[part.first + kSix * (1 + terms) * q];
      LaneRow* to = &carried_[part.first_carried + kSix * q];
      for (std::size_t c = 0; c < kSix; ++c) {
        Lanes sum = (1.0 - part.factor) * material::load(from[c].value);
        for (std::size_t k = 0; k < terms; ++k) {
          sum += part.weight[k] * part.decay[k] * material::load(from[kSix * (1 + k) + c].value);
        }
        material::store(to[c].value, sum);
      }
    }
  }
}

const LaneRow* ElementHistory::peak(std::size_t group) const {
  return parts_[group].softens ? &state_[parts_[group].first_peak] : nullptr;
}

PointHistory ElementHistory::of_step(std::size_t group, bool softened) const {
  const Part& part = parts_[group];
  const bool carries = part.relaxes && !relaxed_;
  return {carries ? &carried_[part.first_carried] : nullptr, part.factor,
          softened ? peak(group) : nullptr};
}

void ElementHistory::end_step(std::size_t group, int begin, int end, const double* points) {
  const Part& part = parts_[group];
  if (part.points == 0) return;
  const std::size_t terms = part.weight.size();
  const auto count = static_cast<std::size_t>(groups_[group].points);
  LaneRow fresh[8 * kSix], energy[8];
  for (int b = begin; b < end; ++b) {
    relaxing_stress(groups_[group], b, points, {nullptr, 1.0, peak(group)}, fresh, energy);
    for (std::size_t q = 0; q < count; ++q) {
      const std::size_t point = static_cast<std::size_t>(b) * count + q;
      if (part.softens) {
        double* most = state_[part.first_peak + point].value;
        material::store(most,
                        material::maximum(material::load(most), material::load(energy[q].value)));
      }
      if (!part.relaxes) continue;
      LaneRow* own = &state_[part.first + kSix * (1 + terms) * point];
      for (std::size_t c = 0; c < kSix; ++c) {
        const Lanes stress = material::load(fresh[kSix * q + c].value);
        const Lanes change = stress - material::load(own[c].value);
        material::store(own[c].value, stress);
        for (std::size_t k = 0; k < terms; ++k) {
          double* term = own[kSix * (1 + k) + c].value;
          material::store(term, part.decay[k] * material::load(term) + part.rise[k] * change);
        }
      }
    }
  }
}

PointHistory ElementHistory::present(std::size_t group, std::vector<LaneRow>& overstress) const {
  const Part& part = parts_[group];
  if (!part.relaxes) return {nullptr, 1.0, peak(group)};
  const std::size_t terms = part.weight.size();
  overstress.resize(kSix * part.points);
  for (std::size_t q = 0; q < part.points; ++q) {
    const LaneRow* from = &state_[part.first + kSix * (1 + terms) * q];
    for (std::size_t c = 0; c < kSix; ++c) {
      Lanes sum = lanes(0.0);
      for (std::size_t k = 0; k < terms; ++k) {
        sum += part.weight[k] * material::load(from[kSix * (1 + k) + c].value);
      }
      material::store(overstress[kSix * q + c].value, sum);
    }
  }
  return {overstress.data(), 1.0, peak(group)};
}

void ElementHistory::save(std::span<double> state) const {
  if (!empty()) std::memcpy(state.data(), state_.data(), sizeof(double) * size());
}

void ElementHistory::load(std::span<const double> state) {
  if (!empty()) std::memcpy(state_.data(), state.data(), sizeof(double) * size());
}

}  // namespace sinew::fem
