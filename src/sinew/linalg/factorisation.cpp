#include "sinew/linalg/factorisation.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/backends.hpp"
#include "sinew/linalg/linear_solver.hpp"
#include "sinew/linalg/solved_rows.hpp"

namespace sinew::linalg {

namespace {

// Sinew's own, then those from outside.
constexpr const char* kOwn = "block";

std::vector<SolverBackend>& registered() {
  static std::vector<SolverBackend> all;
  return all;
}

// Whether the list was asked for, as by the grammar, in which further solvers would be missing.
bool& in_use() {
  static bool asked = false;
  return asked;
}

const SolverBackend* find_registered(const std::string& name) {
  const auto found = std::ranges::find(registered(), name, &SolverBackend::name);
  return found == registered().end() ? nullptr : &*found;
}

// A plan that keeps the patterns for solvers that have no symbolic phase.
class SolverPlan final : public FactorisationPlan {
 public:
  SolverPlan(const SolverBackend& backend, BlockPattern pattern, BorderPattern border,
             FactorisationSettings settings)
      : backend_(backend),
        pattern_(std::move(pattern)),
        border_(std::make_shared<const BorderPattern>(std::move(border))),
        settings_(std::move(settings)) {}
  std::string_view backend() const override { return backend_.name; }
  std::string_view ordering() const override { return "none"; }
  std::size_t factor_entries() const override { return 0; }
  double factor_flops() const override { return 0.0; }
  std::unique_ptr<Factorisation> create(ThreadPool& pool) const override {
    return std::make_unique<SolvedRows>(border_, 3 * pattern_.nodes,
                                        backend_.make(pattern_, settings_, pool));
  }

 private:
  SolverBackend backend_;
  BlockPattern pattern_;
  std::shared_ptr<const BorderPattern> border_;
  FactorisationSettings settings_;
};

PlanPointer make_plan(const BlockPattern& pattern, const BorderPattern& border,
                      const FactorisationSettings& settings) {
  if (settings.backend == kOwn) return make_block_plan(pattern, border, settings);
  return std::make_shared<SolverPlan>(*find_registered(settings.backend), pattern, border,
                                      settings);
}

[[noreturn]] void fail(ErrorKind kind, const char* item, const std::string& message,
                       const std::string& remedy) {
  throw Error(kind, Location{.file = {}, .item = item}, message, remedy);
}

void check_block_pattern(const BlockPattern& pattern) {
  const auto wrong = [](const std::string& message) {
    fail(ErrorKind::index_out_of_range, "block pattern", message,
         "columns hold their diagonal first, then ascending rows below the number of nodes");
  };
  const auto columns = static_cast<int>(pattern.column_start.size()) - 1;
  if (columns != pattern.nodes || pattern.column_start.front() != 0 ||
      pattern.column_start.back() != pattern.blocks()) {
    wrong("column_start does not fit " + std::to_string(pattern.nodes) + " nodes");
  }
  for (int j = 0; j < columns; ++j) {
    const auto begin = pattern.row.begin() + pattern.column_start[static_cast<std::size_t>(j)];
    const auto end = pattern.row.begin() + pattern.column_start[static_cast<std::size_t>(j) + 1];
    const bool ascending = std::adjacent_find(begin, end, std::greater_equal<>()) == end;
    if (begin >= end || *begin != j || !ascending || *(end - 1) >= pattern.nodes) {
      wrong("column " + std::to_string(j) + " is not in order");
    }
  }
}

void check_border_pattern(const BorderPattern& border, int nodes) {
  const auto wrong = [](const std::string& message) {
    fail(ErrorKind::index_out_of_range, "border pattern", message,
         "rows hold distinct, ascending nodes of the matrix");
  };
  if (border.row_start.empty() || border.row_start.front() != 0 ||
      border.row_start.back() != border.entries()) {
    wrong("row_start does not split the " + std::to_string(border.entries()) + " entries");
  }
  for (int k = 0; k < border.rows(); ++k) {
    int last = -1;
    for (int e = border.row_start[static_cast<std::size_t>(k)];
         e < border.row_start[static_cast<std::size_t>(k) + 1]; ++e) {
      const int node = border.node[static_cast<std::size_t>(e)];
      if (node <= last || node >= nodes) {
        wrong("row " + std::to_string(k) + " names node " + std::to_string(node) + " of " +
              std::to_string(nodes));
      }
      last = node;
    }
  }
}

/// The plans in use, each with the input from which it was made. A plan depends on that only, so
/// sharing does not affect results.
class PlansInUse {
 public:
  PlanPointer find(const BlockPattern& pattern, const BorderPattern& border,
                   const FactorisationSettings& settings) {
    const std::scoped_lock lock(mutex_);
    return find_locked(pattern, border, settings);
  }

  /// Adds a plan and returns it, or an equal one that another thread added before.
  PlanPointer add(const BlockPattern& pattern, const BorderPattern& border,
                  const FactorisationSettings& settings, PlanPointer plan) {
    auto made = std::make_shared<const Made>(Made{pattern, border, settings, std::move(plan)});
    const std::scoped_lock lock(mutex_);
    if (auto earlier = find_locked(pattern, border, settings)) return earlier;
    std::erase_if(made_, [](const auto& one) { return one.expired(); });
    made_.push_back(made);
    return {made, made->plan.get()};
  }

 private:
  struct Made {
    BlockPattern pattern;
    BorderPattern border;
    FactorisationSettings settings;
    PlanPointer plan;
  };

  PlanPointer find_locked(const BlockPattern& pattern, const BorderPattern& border,
                          const FactorisationSettings& settings) const {
    for (const auto& one : made_) {
      const auto made = one.lock();
      if (made && made->settings == settings && made->border == border &&
          made->pattern == pattern) {
        return {made, made->plan.get()};
      }
    }
    return nullptr;
  }

  std::mutex mutex_;
  std::vector<std::weak_ptr<const Made>> made_;
};

PlansInUse& plans_in_use() {
  static PlansInUse plans;
  return plans;
}

}  // namespace

std::shared_ptr<const FactorisationPlan> analyse(const BlockPattern& pattern,
                                                 const BorderPattern& border,
                                                 const FactorisationSettings& settings) {
  check_block_pattern(pattern);
  check_border_pattern(border, pattern.nodes);
  check_settings(settings);
  PlansInUse& plans = plans_in_use();
  if (auto plan = plans.find(pattern, border, settings)) return plan;
  return plans.add(pattern, border, settings, make_plan(pattern, border, settings));
}

void check_settings(const FactorisationSettings& settings) {
  if (settings.threads < 1) {
    fail(ErrorKind::out_of_range, "threads",
         "the number of threads is " + std::to_string(settings.threads), "give at least 1");
  }
  if (settings.backend == kOwn || find_registered(settings.backend) != nullptr) return;
  std::vector<std::string> names{kOwn};
  for (const SolverBackend& one : registered()) names.push_back(one.name);
  const std::string near = nearest_word(settings.backend, names);
  fail(ErrorKind::unknown_choice, "backend", "unknown backend '" + settings.backend + "'",
       near.empty() ? fmt::format("choose {}", fmt::join(names, " or "))
                    : "did you mean '" + near + "'?");
}

std::vector<BackendName> backends() {
  in_use() = true;
  std::vector<BackendName> all{{kOwn, "Sinew's supernodal factorisation in 3x3 blocks."}};
  for (const SolverBackend& one : registered()) all.push_back({one.name, one.description});
  return all;
}

void register_backend(SolverBackend backend) {
  if (backend.name == kOwn || find_registered(backend.name) != nullptr) {
    fail(ErrorKind::duplicate_key, "backend", "there is a backend '" + backend.name + "'",
         "choose another name");
  }
  if (backend.name.empty() || !backend.make) {
    fail(ErrorKind::bad_argument, "backend", "a backend has no name or makes no solver",
         "give both");
  }
  if (in_use()) {
    fail(ErrorKind::bad_argument, "backend", "the list of backends is in use",
         "register '" + backend.name + "' before the first scene is read");
  }
  registered().push_back(std::move(backend));
}

}  // namespace sinew::linalg
