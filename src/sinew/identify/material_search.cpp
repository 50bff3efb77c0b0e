#include "sinew/identify/material_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/bounded_least_squares.hpp"

namespace sinew::identify {

namespace {

constexpr int kCandidates = 40;         // exponents of either sign at which a new term may start
constexpr std::size_t kTried = 3;       // number of them that are tried
constexpr double kSameExponent = 0.02;  // relative: nearer terms are merged on trial
constexpr double kIdleShare = 1e-7;     // relative stress of a term to be removed on trial
constexpr double kNoWorse = 1e-6;       // relative increase of the cost that counts as zero
constexpr BoundedSettings kSolver = {.max_iterations = 400};

FitParameters all_parameters(const Attempt& attempt) {
  FitParameters all = attempt.law;
  all.insert(all.end(), attempt.softening.begin(), attempt.softening.end());
  return all;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

MaterialSearch::MaterialSearch(const std::vector<CountedTest>& tests, FitSettings settings,
                               Progress progress)
    : tests_(tests), settings_(std::move(settings)), progress_(std::move(progress)) {
  // The mean secant modulus of the tests, over three.
  for (const CountedTest& test : tests_) {
    scale_ +=
        test.largest / std::max(test.farthest, 1e-3) / 3.0 / static_cast<double>(tests_.size());
    rows_ += test.rows;
  }
}

int MaterialSearch::starts(std::span<const std::string> models, const FitSettings& settings) {
  std::map<std::string, int> needed;
  for (std::string model : models) {
    for (; !model.empty(); model = contained_model(model)) {
      const bool linear = fitted_law(model).linear && !settings.mullins;
      needed[model] = linear ? 1 : settings.starts;
    }
  }
  int count = 0;
  for (const auto& [model, starts] : needed) count += starts;
  return count;
}

const Attempt& MaterialSearch::best(const std::string& model) {
  if (const auto found = solved_.find(model); found != solved_.end()) return found->second;
  Attempt attempt = search(fitted_law(model));
  if (attempt.law.empty()) {
    throw Error(ErrorKind::not_converged, {.item = model}, "no start led to a usable fit",
                "try more starts, or a simpler model");
  }
  return solved_.emplace(model, std::move(attempt)).first->second;
}

Attempt MaterialSearch::search(const FittedLaw& law) {
  Attempt best;
  const auto consider = [&](Attempt attempt) {
    if (law.ogden) attempt = without_idle_terms(attempt);
    if (attempt.cost < best.cost) best = std::move(attempt);
  };
  const std::vector<Attempt> guesses = first_guesses(law);
  for (const Attempt& guess : guesses) {
    const std::size_t terms = guess.law.size() / 2;
    consider(solve(law.ogden ? ogden_law(terms) : law, guess));
  }
  // Over all sums of terms the problem is convex in their shares. If no further term reduces the
  // cost, the fewer terms are its solution, and random starts cannot find a better one.
  if (law.ogden && !settings_.mullins && guesses.size() == 1) return best;
  // Every model has its own random numbers, so that its fit does not depend on what else is fitted.
  std::seed_seq seed{settings_.seed, static_cast<std::uint64_t>(
                                         std::accumulate(law.model.begin(), law.model.end(), 0))};
  std::mt19937_64 random(seed);
  const int starts = law.linear && !settings_.mullins ? 1 : settings_.starts;
  for (int k = 0; k < starts; ++k) {
    Attempt start;
    start.law = law.draw(random);
    if (settings_.mullins) start.softening = {{0.5, 0.0, 0.999}, {0.3, 0.0, 1e3}, {0.1, 0.0, 1e2}};
    scale_moduli(law, start);
    consider(solve(law, start));
    if (progress_) progress_(law.model);
  }
  return best;
}

/// Initial guesses from the contained law: the same law, and for Ogden's law also that with a
/// further term.
std::vector<Attempt> MaterialSearch::first_guesses(const FittedLaw& law) {
  const std::string contained = contained_model(law.model);
  if (contained.empty()) return {};
  Attempt same = best(contained);
  same.law = embedded(law.model, same.law);
  std::vector<Attempt> guesses = {same};
  if (!law.ogden) return guesses;
  Attempt base = same;
  if (law.model == "ogden1") base.law.clear();  // its only term may have any exponent
  for (Attempt& guess : with_new_term(base)) guesses.push_back(std::move(guess));
  return guesses;
}

// The residual r is linear in the share s of a new term: r = r_0 + s b. The best share is
// -r_0.b/b.b, if positive, and reduces the cost by (r_0.b)^2/b.b. The search starts from the
// exponents with the largest reduction. If there is none, no term helps.
std::vector<Attempt> MaterialSearch::with_new_term(const Attempt& simpler) {
  struct Candidate {
    double gain = 0.0, share = 0.0, alpha = 0.0;
  };
  const FittedLaw more = ogden_law(simpler.law.size() / 2 + 1);
  const auto extended = [&](double share, double alpha) {
    Attempt result = simpler;
    const FitParameters term = ogden_term(share, alpha);
    result.law.insert(result.law.end(), term.begin(), term.end());
    return result;
  };
  std::vector<Candidate> candidates;
  std::vector<double> without, with;
  for (int k = 0; k <= 2 * kCandidates + 1; ++k) {
    const double size = kSmallestExponent * std::pow(kLargestExponent / kSmallestExponent,
                                                     static_cast<double>(k / 2) / kCandidates);
    const double alpha = k % 2 == 0 ? size : -size;
    if (!residuals(more, extended(0.0, alpha), without)) continue;
    if (!residuals(more, extended(1.0, alpha), with)) continue;
    for (std::size_t i = 0; i < with.size(); ++i) with[i] -= without[i];
    const double slope = dot(without, with), size_squared = dot(with, with);
    if (!(slope < 0.0) || !std::isfinite(size_squared)) continue;
    candidates.push_back({slope * slope / size_squared, -slope / size_squared, alpha});
  }
  std::ranges::sort(candidates, std::greater{}, &Candidate::gain);
  std::vector<Attempt> result;
  std::vector<double> taken;
  for (const Candidate& c : candidates) {
    if (result.size() == kTried) break;
    const bool near = std::ranges::any_of(
        taken, [&](double alpha) { return alpha / c.alpha > 0.5 && alpha / c.alpha < 2.0; });
    if (near) continue;
    taken.push_back(c.alpha);
    result.push_back(extended(c.share, c.alpha));
  }
  return result;
}

Attempt MaterialSearch::solve(const FittedLaw& law, const Attempt& start) {
  std::vector<BoundedValue> values;
  const FitParameters all = all_parameters(start);
  values.reserve(all.size());
  for (const FitParameter& p : all) values.push_back({p.value, p.lower, p.upper});
  const std::size_t own = start.law.size();
  const BoundedResult found =
      law.ogden && !settings_.mullins
          ? solve_bounded(OgdenResiduals{&tests_, scale_, own / 2}, rows_, values, kSolver)
          : solve_bounded_by_differences(Residuals{&law, &tests_, scale_, own, settings_.mullins},
                                         rows_, values, kSolver);
  Attempt attempt = start;
  for (std::size_t k = 0; k < all.size(); ++k) {
    (k < own ? attempt.law[k] : attempt.softening[k - own]).value = values[k].value;
  }
  attempt.converged = found.converged;
  attempt.cost = found.usable ? found.cost : std::numeric_limits<double>::infinity();
  return attempt;
}

/// Merges terms with equal exponents, and removes terms that carry no stress, if the fit does not
/// get worse.
Attempt MaterialSearch::without_idle_terms(const Attempt& attempt) {
  Attempt best = attempt;
  for (std::size_t k = 0; k + 1 < best.law.size() && best.law.size() > 2;) {
    Attempt fewer = best;
    const FitParameter share = fewer.law[k], alpha = fewer.law[k + 1];
    const auto at = static_cast<std::ptrdiff_t>(k);
    fewer.law.erase(fewer.law.begin() + at, fewer.law.begin() + at + 2);
    bool idle = false;
    for (std::size_t j = 0; j + 1 < fewer.law.size() && !idle; j += 2) {
      const double other = fewer.law[j + 1].value;
      if (std::abs(other - alpha.value) > kSameExponent * std::abs(other)) continue;
      fewer.law[j].value += share.value;
      idle = true;
    }
    const FittedLaw law = ogden_law(fewer.law.size() / 2);
    if (!idle) {
      std::vector<double> before, after;
      idle = residuals(ogden_law(best.law.size() / 2), best, before) &&
             residuals(law, fewer, after) &&
             std::ranges::equal(before, after,
                                [](double a, double b) { return std::abs(a - b) <= kIdleShare; });
    }
    if (idle) fewer = solve(law, fewer);
    const bool same = idle && fewer.cost <= best.cost * (1.0 + kNoWorse) + 1e-16;
    if (same) {
      best = std::move(fewer);
    } else {
      k += 2;
    }
  }
  return best;
}

bool MaterialSearch::residuals(const FittedLaw& law, const Attempt& at,
                               std::vector<double>& result) const {
  const FitParameters all = all_parameters(at);
  std::vector<double> values;
  for (const FitParameter& p : all) values.push_back(p.value);
  result.assign(rows_, 0.0);
  return Residuals{&law, &tests_, scale_, at.law.size(), settings_.mullins}(values.data(),
                                                                            result.data());
}

/// Scales all moduli by the best common factor: the stress is proportional to all of them together.
void MaterialSearch::scale_moduli(const FittedLaw& law, Attempt& start) const {
  Attempt none = start;
  for (FitParameter& p : none.law) p.value = p.modulus ? 0.0 : p.value;
  std::vector<double> without, with;
  if (!residuals(law, none, without) || !residuals(law, start, with)) return;
  for (std::size_t i = 0; i < with.size(); ++i) with[i] -= without[i];
  const double factor = -dot(without, with) / dot(with, with);
  if (!(factor > 0.0) || !std::isfinite(factor)) return;
  for (FitParameter& p : start.law) {
    if (p.modulus) p.value = std::max(factor * p.value, p.lower);
  }
}

}  // namespace sinew::identify
