#include "sinew/linalg/factorisation.hpp"

#include <algorithm>
#include <array>
#include <mutex>

#include "sinew/core/error.hpp"
#include "sinew/linalg/backends.hpp"

namespace sinew::linalg {

namespace {

struct Backend {
  std::string_view name;
  PlanPointer (*make)(const BlockPattern&, const BorderPattern&, const FactorisationSettings&);
};

constexpr std::array kBackends = {Backend{"block", make_block_plan},
                                  Backend{"eigen-ldlt", make_eigen_ldlt_plan},
                                  Backend{"eigen-llt", make_eigen_llt_plan}};

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
  const auto backend = std::ranges::find(kBackends, settings.backend, &Backend::name);
  return plans.add(pattern, border, settings, backend->make(pattern, border, settings));
}

void check_settings(const FactorisationSettings& settings) {
  if (settings.threads < 1) {
    fail(ErrorKind::out_of_range, "threads",
         "the number of threads is " + std::to_string(settings.threads), "give at least 1");
  }
  if (std::ranges::find(kBackends, settings.backend, &Backend::name) != kBackends.end()) return;
  const std::string near = nearest_word(settings.backend, backends());
  fail(ErrorKind::unknown_choice, "backend", "unknown backend '" + settings.backend + "'",
       near.empty() ? "choose block, eigen-ldlt or eigen-llt" : "did you mean '" + near + "'?");
}

std::vector<std::string> backends() {
  std::vector<std::string> names;
  names.reserve(kBackends.size());
  for (const Backend& backend : kBackends) names.emplace_back(backend.name);
  return names;
}

}  // namespace sinew::linalg
