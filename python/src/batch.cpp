#include "batch.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::python {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kSignalInterval = std::chrono::milliseconds(50);

bool is_chosen(std::span<const bool> which, std::size_t i) { return which.empty() || which[i]; }

[[noreturn]] void refuse_shape(const std::string& item, std::string message, std::string remedy) {
  throw Error(ErrorKind::wrong_shape, {.item = item}, std::move(message), std::move(remedy));
}

}  // namespace

Batch::Batch(std::vector<std::shared_ptr<Session>> sessions, int threads) : pool_(threads) {
  if (sessions.empty()) {
    throw Error(ErrorKind::empty_list, {.item = "Batch(simulations)"}, "there is no simulation",
                "give one or more");
  }
  std::set<const Session*> known;
  for (std::shared_ptr<Session>& session : sessions) {
    if (!known.insert(session.get()).second) {
      throw Error(ErrorKind::bad_argument, {.item = "Batch(simulations)"},
                  fmt::format("simulation {} is there twice", members_.size()),
                  "give each once: sim.clone() makes another one");
    }
    members_.push_back({std::move(session), {}, {}, {}});
  }
}

const std::shared_ptr<Session>& Batch::at(std::size_t index) const {
  if (index >= members_.size()) {
    throw Error(ErrorKind::index_out_of_range, {.item = "Batch"},
                fmt::format("it has no simulation {}", index),
                fmt::format("name 0 to {}", members_.size() - 1));
  }
  return members_[index].session;
}

void Batch::command(const std::string& quantity, const Rows& values, std::span<const bool> which) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (!is_chosen(which, i)) continue;
    Session& session = *members_[i].session;
    const auto& actuators = session.model().actuators();
    if (values.cols() != static_cast<Eigen::Index>(actuators.size())) {
      refuse_shape("Batch.command(values)",
                   fmt::format("there are {} values for the {} actuators of simulation {}",
                               values.cols(), actuators.size(), i),
                   "give an array (simulations, actuators)");
    }
    const Session::Use use(session);
    for (std::size_t k = 0; k < actuators.size(); ++k) {
      const auto kind = actuators[k].kind_of(quantity);
      const double value = values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      if (!kind) {
        throw Error(ErrorKind::wrong_actuator_type, {.item = "Batch.command(quantity)"},
                    fmt::format("'{}' is a {}, which takes no {}", actuators[k].name,
                                actuators[k].kind->word, quantity),
                    fmt::format("it takes {} and {}", actuators[k].kind->effort.name,
                                actuators[k].kind->motion.name));
      }
      if (actuators[k].kind->pulls_only && *kind == model::CommandKind::effort && value < 0.0) {
        throw Error(ErrorKind::out_of_range, {.item = "Batch.command(values)"},
                    fmt::format("a tension of {:g} N of '{}' would push", value, actuators[k].name),
                    "give zero or more; a cable can only pull");
      }
      session.simulation().command(static_cast<int>(k), {*kind, model::Signal::constant(value)});
    }
  }
}

void Batch::advance(Member& member, std::int64_t count, const std::function<bool()>& ended) {
  member.failure.reset();
  member.other = nullptr;
  try {
    member.session->advance_unlocked(count, ended);
  } catch (const Error& error) {
    if (error.is_run_failure()) {
      member.failure = error;
    } else {
      member.other = std::current_exception();
    }
  } catch (...) {
    member.other = std::current_exception();
  }
}

std::vector<std::optional<Error>> Batch::step(std::int64_t count, std::span<const bool> which) {
  std::atomic<bool> stopped{false};
  const auto work = [&](int begin, int end, int thread) {
    auto due = Clock::now() + kSignalInterval;
    const std::function<bool()> ended = [&] {  // the caller's thread checks for Ctrl-C
      if (thread == 0 && Clock::now() > due) {
        const pybind11::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) stopped = true;
        due = Clock::now() + kSignalInterval;
      }
      return stopped.load(std::memory_order_relaxed);
    };
    for (int i = begin; i < end && !stopped; ++i) {
      if (is_chosen(which, static_cast<std::size_t>(i))) {
        advance(members_[static_cast<std::size_t>(i)], count, ended);
      }
    }
  };
  {
    const pybind11::gil_scoped_release release;
    pool_.for_range(static_cast<int>(members_.size()), 1, work);
  }
  if (stopped) throw pybind11::error_already_set();
  std::vector<std::optional<Error>> failures(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (!is_chosen(which, i)) continue;
    if (members_[i].other) std::rethrow_exception(members_[i].other);
    members_[i].session->warn();
    failures[i] = std::move(members_[i].failure);
  }
  return failures;
}

void Batch::find(Member& member) const {
  sim::Observables& list = member.session->observables();
  std::size_t width = 0;
  for (const std::string& name : names_) {
    member.columns.push_back(list.find(name, {.item = "Batch.read(names)"}));
    width += list.list()[member.columns.back()].size();
  }
  if (width == width_) return;
  member.columns.clear();
  refuse_shape(
      "Batch.read(names)",
      fmt::format("one simulation has {} numbers of these names, another one {}", width_, width),
      "read what all have in the same shape");
}

Rows Batch::read(const std::vector<std::string>& names) {
  if (names != names_ || names.empty()) {
    for (Member& member : members_) member.columns.clear();
    names_ = names;
    width_ = 0;
    const sim::Observables& list = members_.front().session->observables();
    for (const std::string& name : names_) {
      width_ += list.list()[list.find(name, {.item = "Batch.read(names)"})].size();
    }
  }
  Rows result(static_cast<Eigen::Index>(members_.size()), static_cast<Eigen::Index>(width_));
  double* next = result.data();
  for (Member& member : members_) {
    const Session::Use use(*member.session);
    if (member.columns.size() != names_.size()) find(member);
    sim::Observables& list = member.session->observables();
    list.refresh();
    for (const std::size_t column : member.columns) {
      next = std::ranges::copy(list.read(column), next).out;
    }
  }
  return result;
}

}  // namespace sinew::python
