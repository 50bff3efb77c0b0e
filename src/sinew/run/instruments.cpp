#include "sinew/run/instruments.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "sinew/model/instrument_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"

namespace sinew::run {

namespace {

// The hash as an integer that a double represents exactly.
double mark_of(const model::InstrumentModel& model) {
  return static_cast<double>(model.hash() >> 12);
}

}  // namespace

Instruments::Instruments(const Run& run) {
  for (const model::InstrumentModel& model : run.model->instruments()) {
    all_.push_back(model.start(run));
    marks_.push_back(mark_of(model));
  }
}

void Instruments::begin() {
  for (const auto& one : all_) one->begin();
}

void Instruments::advance() {
  for (const auto& one : all_) one->advance();
}

void Instruments::settle(Rest rest) {
  for (const auto& one : all_) one->settle(rest);
}

void Instruments::save(std::vector<std::vector<double>>& memories) const {
  memories.resize(all_.size());
  for (std::size_t k = 0; k < all_.size(); ++k) {
    memories[k].assign(1, marks_[k]);
    all_[k]->save(memories[k]);
  }
}

void Instruments::load(const std::vector<std::vector<double>>& memories) {
  std::optional<Error> damage;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const auto own = std::ranges::find_if(memories, [&](const std::vector<double>& memory) {
      return !memory.empty() && memory.front() == marks_[k];
    });
    if (own == memories.end()) {
      all_[k]->begin();
      continue;
    }
    try {
      all_[k]->load(std::span(*own).subspan(1));
    } catch (const Error& error) {
      all_[k]->begin();
      if (!damage) damage = error;
    }
  }
  if (damage) throw *damage;
}

}  // namespace sinew::run
