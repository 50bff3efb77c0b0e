#include "sinew/estimate/state_numbers.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "sinew/core/whole.hpp"
#include "sinew/run/state.hpp"

namespace sinew::estimate {

void append(const run::State& state, std::vector<double>& numbers) {
  run::State::visit(state, [&](std::string_view, const auto& part) {
    if constexpr (requires { part.size(); }) {
      numbers.push_back(static_cast<double>(part.size()));
      numbers.insert(numbers.end(), part.begin(), part.end());
    } else {
      numbers.push_back(part);
    }
  });
  numbers.push_back(static_cast<double>(state.steps));
}

bool take(run::State& state, std::span<const double>& numbers) {
  bool good = true;
  const auto next = [&] {
    good = good && !numbers.empty();
    if (!good) return 0.0;
    const double number = numbers.front();
    numbers = numbers.subspan(1);
    return number;
  };
  run::State::visit(state, [&](std::string_view, auto& part) {
    if constexpr (requires { part.size(); }) {
      const double size = next();
      good = good && size >= 0.0 && size <= static_cast<double>(numbers.size());
      if (!good) return;
      const auto count = whole<std::ptrdiff_t>(size);
      part.assign(numbers.begin(), numbers.begin() + count);
      numbers = numbers.subspan(static_cast<std::size_t>(count));
    } else {
      part = next();
    }
  });
  state.steps = whole<std::int64_t>(next(), 0);
  return good;
}

}  // namespace sinew::estimate
