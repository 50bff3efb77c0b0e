#include "sinew/sim/observables.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

void list_standard_observables(Observables& list);  // standard_observables.cpp

Observables::Observables(Simulation& simulation) : simulation_(&simulation) {
  gathering_ = true;
  list_standard_observables(*this);
  gathering_ = false;
  sort();
}

// Sorts by kind, stably, and once for all: many contacts have thousands of observables, and
// inserting each at its place would move all behind it.
void Observables::sort() {
  std::vector<std::size_t> order(list_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return list_[k].kind; });
  std::vector<run::Observable> list;
  std::vector<Entry> entries;
  list.reserve(order.size());
  entries.reserve(order.size());
  for (const std::size_t k : order) {
    list.push_back(std::move(list_[k]));
    entries.push_back(std::move(entries_[k]));
  }
  list_ = std::move(list);
  entries_ = std::move(entries);
}

void Observables::add(std::vector<run::Observable> parts, Fill fill) {
  std::size_t size = 0;
  for (const run::Observable& part : parts) size += part.size();
  add_view(std::move(parts),
           [numbers = std::vector<double>(size), fill = std::move(fill)]() mutable {
             fill(numbers);
             return std::span<const double>(numbers);
           });
}

void Observables::add_view(std::vector<run::Observable> parts, Read read) {
  sources_.push_back({std::move(read), {}, false});
  Entry entry{sources_.size() - 1, 0, {}};
  for (run::Observable& part : parts) {
    const auto behind =
        gathering_ ? list_.end()
                   : std::ranges::upper_bound(list_, part.kind, {}, &run::Observable::kind);
    const auto at = behind - list_.begin();
    const std::size_t size = part.size();
    list_.insert(behind, std::move(part));
    entries_.insert(entries_.begin() + at, entry);
    entry.offset += size;
  }
}

// The name with a link that is part of a body replaced by the body.
std::string Observables::with_body(std::string_view name) const {
  for (const auto& [link, body] : simulation_->model().body_names()) {
    if (body == model::kWorld || !name.starts_with(link + ".")) continue;
    return simulation_->model().body(body).name() + std::string(name.substr(link.size()));
  }
  return std::string(name);
}

std::size_t Observables::find(std::string_view asked_name, const Location& asked) const {
  const std::string name = with_body(asked_name);
  const auto found = std::ranges::find(list_, name, &run::Observable::name);
  if (found != list_.end()) return static_cast<std::size_t>(found - list_.begin());
  std::vector<std::string> known;
  known.reserve(list_.size());
  for (const run::Observable& one : list_) known.push_back(one.name);
  const std::string nearest = nearest_word(name, known);
  throw Error(ErrorKind::unknown_name, asked, fmt::format("there is no '{}' to observe", name),
              nearest.empty() ? fmt::format("one of {}", fmt::join(known, ", "))
                              : fmt::format("did you mean '{}'?", nearest));
}

void Observables::refresh() {
  for (Source& source : sources_) source.fresh = false;
}

std::span<const double> Observables::read(std::size_t index) {
  const Entry& entry = entries_[index];
  if (!entry.held.empty()) return entry.held;
  Source& source = sources_[entry.source];
  if (!source.fresh) {
    source.numbers = source.read();
    source.fresh = true;
  }
  return source.numbers.subspan(entry.offset, list_[index].size());
}

void Observables::hold(std::size_t index, std::span<const double> numbers) {
  if (numbers.size() != list_.at(index).size()) {
    throw Error(
        ErrorKind::wrong_length, {.item = list_[index].name},
        fmt::format("{} numbers were given, it has {}", numbers.size(), list_[index].size()),
        "give numbers of the same robot");
  }
  entries_[index].held.assign(numbers.begin(), numbers.end());
}

void Observables::release() {
  for (Entry& entry : entries_) entry.held.clear();
}

double commanded(const Simulation& simulation, int actuator, model::CommandKind kind) {
  const model::ActuatorState& state = simulation.actuator(actuator);
  if (kind != (state.chosen ? model::CommandKind::effort : state.command.kind)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return state.chosen ? state.effort : state.command.signal.value(simulation.time());
}

std::vector<model::CommandKind> command_kinds(const model::ActuatorModel& actuator) {
  std::vector<model::CommandKind> kinds;
  for (const model::CommandKind kind :
       {model::CommandKind::effort, model::CommandKind::motion, model::CommandKind::input}) {
    if (actuator.kind_of(actuator.quantity(kind).name) == kind) kinds.push_back(kind);
  }
  return kinds;
}

std::string command_name(const model::ActuatorModel& actuator, model::CommandKind kind) {
  return fmt::format("{}.{}_command", actuator.name, actuator.quantity(kind).name);
}

}  // namespace sinew::sim
