#include "sinew/run/observable.hpp"

#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace sinew::run {

std::size_t Observable::size() const {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

std::string_view Observable::word(double number) const {
  const auto found = std::ranges::find_if(
      words, [&](const StatusWord& one) { return static_cast<double>(one.code) == number; });
  return found == words.end() ? std::string_view() : found->word;
}

Observable observable_of(ObservableKind kind, const std::string& owner, const std::string& quantity,
                         const char* unit, std::vector<std::size_t> shape) {
  Observable one{
      fmt::format("{}.{}", owner, quantity), unit, std::move(shape), kind, owner, quantity, {}, {}};
  if (one.shape.empty()) one.components = {one.name};
  return one;
}

}  // namespace sinew::run
