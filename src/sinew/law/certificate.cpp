#include "sinew/law/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sinew/law/controller.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/law/response.hpp"

namespace sinew::law {

namespace {

// Relative to the largest scaled effort: a guard within this is tight.
constexpr double kTight = 1e-6;
// Relative to the largest multiplier: smaller ones are zero.
constexpr double kNoMultiplier = 1e-6;
// Relative to the largest effort: a choice that moves less stays.
constexpr double kStays = 1e-5;
// Relative to the objective: a smaller gain is rounding.
constexpr double kGain = 1e-9;

VectorX motion_of(const StepProblem& problem, std::span<const double> effort) {
  const Eigen::Map<const VectorX> all(effort.data(), std::ssize(effort));
  return problem.delta_free + problem.compliance * all;
}

// The largest effort in the unit of guards, sqrt(J).
double size_of(const StepProblem& problem, std::span<const double> effort) {
  double largest = 0.0;
  for (std::size_t row = 0; row < effort.size(); ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    largest =
        std::max(largest, std::abs(effort[row]) * std::sqrt(std::abs(problem.compliance(i, i))));
  }
  return largest;
}

class Certifier {
 public:
  Certifier(const StepProblem& problem, Controller& controller, std::span<const double> effort)
      : problem_(problem),
        controller_(controller),
        effort_(effort),
        size_(size_of(problem, effort)) {
    here_.form(problem, effort);
    for (const int index : here_.controlled()) {
      const int row = problem.actuators[static_cast<std::size_t>(index)].row;
      own_.push_back(effort[static_cast<std::size_t>(row)]);
    }
  }

  void judge(Certificate& found) {
    find_between();
    found.between = static_cast<int>(between_.size());
    found.stationarity = stationarity();
    found.best_nearby = found.stationarity == Stationarity::strong;
    if (found.best_nearby || found.stationarity == Stationarity::none) return;
    if (found.between > Certificate::kMaxBetween) return;
    found.pieces = 1 << found.between;
    found.best_nearby = no_piece_leads_on();
  }

 private:
  // A block at the limits of two states, and the state beyond.
  struct Between {
    int block;
    BlockState beyond;
    double here = 0.0, there = 0.0;  // multipliers
  };

  void find_between() {
    here_.tighten(own_, kTight * size_);
    for (std::size_t g = 0; g < here_.guards().size(); ++g) {
      const Guard& guard = here_.guards()[g];
      if (!guard.tight || find(guard.block) != between_.end()) continue;
      between_.push_back({guard.block, guard.beyond});
    }
  }

  std::vector<Between>::iterator find(int block) {
    return std::ranges::find(between_, block, &Between::block);
  }

  // Whether the best choice that keeps all these blocks at both limits is the choice that was made,
  // or one that is no better: where the objective is flat, choices differ by more than rounding.
  bool stays(const Response& response, double Between::*multiplier) {
    std::vector<double> choice = own_;
    if (controller_.choose(problem_, response, Guards::tight, choice) == LawStatus::failed) {
      return false;
    }
    const std::span<const double> multipliers = controller_.guard_multipliers();
    for (std::size_t g = 0; g < multipliers.size(); ++g) {
      const Guard& guard = response.guards()[g];
      const auto block = find(guard.block);
      if (!guard.tight || block == between_.end()) continue;
      // Of several planes of a cone, takes the one with the largest multiplier.
      double& kept = (*block).*multiplier;
      if (std::abs(multipliers[g]) > std::abs(kept)) kept = multipliers[g];
    }
    double most = 0.0;
    for (std::size_t k = 0; k < own_.size(); ++k) {
      const int index = response.controlled()[k];
      const int row = problem_.actuators[static_cast<std::size_t>(index)].row;
      most = std::max(
          most, std::abs(choice[k] - own_[k]) * std::sqrt(std::abs(problem_.compliance(row, row))));
    }
    return most <= kStays * size_ || !gains();
  }

  // Whether the controller's last choice is better than the one that was made.
  bool gains() const {
    const double value =
        controller_.merit(problem_, motion_of(problem_, effort_), own_, effort_).value;
    return value - controller_.foreseen() > controller_.negligible_gain() + kGain * std::abs(value);
  }

  Response beyond(unsigned which) const {
    const auto now = here_.states();
    std::vector<BlockState> states(now.begin(), now.end());
    for (std::size_t k = 0; k < between_.size(); ++k) {
      if ((which >> k & 1U) == 0) continue;
      states[static_cast<std::size_t>(between_[k].block)] = between_[k].beyond;
    }
    Response response;
    response.form_as(problem_, effort_, states);
    return response;
  }

  Stationarity stationarity() {
    if (!stays(here_, &Between::here)) return Stationarity::none;
    if (between_.empty()) return Stationarity::strong;
    Response all = beyond(~0U);
    all.tighten(own_, kTight * size_);
    if (!stays(all, &Between::there)) return Stationarity::weak;
    double largest = 0.0;
    for (const Between& block : between_) {
      largest = std::max({largest, std::abs(block.here), std::abs(block.there)});
    }
    const double none = kNoMultiplier * largest;
    Stationarity worst = Stationarity::strong;
    for (const Between& block : between_) worst = std::min(worst, judge_signs(block, none));
    return worst;
  }

  static Stationarity judge_signs(const Between& block, double none) {
    const bool no_here = std::abs(block.here) <= none, no_there = std::abs(block.there) <= none;
    if (block.here >= -none && block.there >= -none) return Stationarity::strong;
    if (no_here || no_there) return Stationarity::mordukhovich;
    return block.here < 0.0 && block.there < 0.0 ? Stationarity::clarke : Stationarity::weak;
  }

  bool no_piece_leads_on() {
    for (unsigned which = 0; which < 1U << between_.size(); ++which) {
      const Response piece = beyond(which);
      std::vector<double> choice = own_;
      if (controller_.choose(problem_, piece, Guards::kept, choice) == LawStatus::failed) continue;
      if (gains()) return false;
    }
    return true;
  }

  const StepProblem& problem_;
  Controller& controller_;
  std::span<const double> effort_;
  double size_;
  Response here_;
  std::vector<double> own_;  // (controlled,) N
  std::vector<Between> between_;
};

}  // namespace

std::string_view stationarity_name(Stationarity stationarity) {
  switch (stationarity) {
    case Stationarity::none:
      return "none";
    case Stationarity::weak:
      return "W";
    case Stationarity::clarke:
      return "C";
    case Stationarity::mordukhovich:
      return "M";
    case Stationarity::strong:
      return "S";
  }
  return "unknown";
}

Certificate certify(const StepProblem& problem, Controller& controller,
                    std::span<const double> effort, const qp::ConeSettings& settings) {
  Certificate found;
  StepProblem at_end = problem;
  at_end.delta = motion_of(problem, effort);
  found.violation = violation(at_end, effort, LawStatus::solved);
  const auto change = [&](std::vector<double> start) {
    DirectSolver direct(settings);
    direct.begin_step();
    if (direct.solve(problem, start) == LawStatus::failed) return kInfinity;
    return (motion_of(problem, start) - at_end.delta).cwiseAbs().maxCoeff();
  };
  found.stays = change({effort.begin(), effort.end()});
  std::vector<double> cold(effort.size(), 0.0);
  for (const ActuatorBlock& block : problem.actuators) {
    if (block.owned && block.row >= 0) {
      const auto row = static_cast<std::size_t>(block.row);
      cold[row] = effort[row];
    }
  }
  found.cold = change(cold);
  Certifier(problem, controller, effort).judge(found);
  return found;
}

}  // namespace sinew::law
