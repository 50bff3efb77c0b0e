#include "sinew/world/joint_conflict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/constraint/joint.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

namespace {

// Smaller eigenvalues of W, scaled to a unit diagonal, are zero.
constexpr double kNull = 1e-10;
// Rows with smaller loads, relative to the largest, do not take part.
constexpr double kPart = 1e-3;
constexpr std::size_t kNamed = 6;
constexpr double kAtLimit = 1e-6;  // of the robot's size

struct Row {
  law::HeldRow held;
  double gap = 0.0;           // m, rad or m^3
  double motion_scale = 1.0;  // m per gap
  int side = 0;               // of a limit, a unilateral row: 1 upper, -1 lower
  double unclosed = 0.0;      // part of the gap that no motion of the linearisation closes
  bool takes_part = false;
};

// -1 or 1 if a motion is at its lower or upper limit or beyond.
int side_of(const law::ActuatorBlock& block, double motion, double size) {
  const double near = kAtLimit * size / block.motion_scale;
  if (motion > block.motion_max - near) return 1;
  return motion < block.motion_min + near ? -1 : 0;
}

// The rows with their gaps at the present state.
std::vector<Row> list_rows(const law::StepProblem& problem) {
  std::vector<Row> rows;
  const auto add = [&](const auto& block, double target, int side) {
    const double gap = problem.delta[block.row] - target;
    rows.push_back({{block.row, 0.0}, gap, block.motion_scale, side});
  };
  for (const law::BilateralBlock& block : problem.bilaterals) add(block, block.motion, 0);
  for (const law::ActuatorBlock& block : problem.actuators) {
    if (block.row < 0 || !std::isinf(block.effort_min) || !std::isinf(block.effort_max)) continue;
    const double motion = problem.delta[block.row];
    const int side = side_of(block, motion, problem.size);
    if (block.holds_motion()) {
      add(block, block.value, 0);
    } else if (side != 0) {
      add(block, std::clamp(motion, block.motion_min, block.motion_max), side);
    }
  }
  for (const law::StiffnessBlock& block : problem.stiffness) {
    if (block.stiffness != 0.0) rows.push_back({{block.row, 1.0 / block.stiffness}});
  }
  return rows;
}

// Projects the gaps onto loads that cancel.
// @return whether that is a contradiction; it is none if a limit would have to pull.
bool find_unclosed(const law::StepProblem& problem, std::vector<Row>& rows) {
  std::vector<law::HeldRow> held;
  for (const Row& row : rows) held.push_back(row.held);
  const law::HeldCompliance compliance = law::held_compliance(problem, held);
  const linalg::SymmetricSpectrum spectrum(compliance.matrix);
  VectorX gaps(compliance.scale.size());
  for (std::size_t k = 0; k < rows.size(); ++k) gaps[static_cast<Eigen::Index>(k)] = rows[k].gap;
  gaps.array() *= compliance.scale.array();
  VectorX load = VectorX::Zero(gaps.size());
  const double null = kNull * std::max(spectrum.values().cwiseAbs().maxCoeff(), 1.0);
  for (Eigen::Index k = 0; k < gaps.size(); ++k) {
    if (std::abs(spectrum.values()[k]) > null) continue;
    load += spectrum.vectors().col(k).dot(gaps) * spectrum.vectors().col(k);
  }
  const double least = kPart * load.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    // A row with a prescribed motion has no compliance, and therefore no scale for comparison.
    const bool given = compliance.matrix(i, i) == 0.0;
    rows[k].takes_part = std::abs(load[i]) > (given ? 0.0 : least);
    rows[k].unclosed = load[i] / compliance.scale[i];
    if (rows[k].takes_part && load[i] * rows[k].side < 0.0) return false;
  }
  return true;
}

// Unit of a gap.
enum class Unit { length, angle, volume };
constexpr std::size_t kUnits = 3;

// Gaps of all rows of one part.
struct Lack {
  std::string name;
  bool joint = false;
  std::array<double, kUnits> squares{};  // m^2, rad^2, m^6
  std::array<double, kUnits> largest{};  // m, largest of the rows of each unit

  double most() const { return *std::ranges::max_element(largest); }

  std::string amount() const {
    constexpr std::array<double, kUnits> kFactor = {1e3, 180.0 / std::numbers::pi, 1e6};
    constexpr std::array<const char*, kUnits> kName = {"mm", "deg", "ml"};
    std::string text;
    for (std::size_t unit = 0; unit < kUnits; ++unit) {
      if (!(largest[unit] > kPart * most())) continue;
      text += fmt::format("{}{:.3g} {}", text.empty() ? "" : " and ",
                          kFactor[unit] * std::sqrt(squares[unit]), kName[unit]);
    }
    return text;
  }
};

Unit unit_of(const model::ActuatorKind& kind) {
  if (kind.swells()) return Unit::volume;
  return kind.turns() ? Unit::angle : Unit::length;
}

class Names {
 public:
  explicit Names(const model::Model& model) : model_(model) {}

  void add(const Row& row) {
    for (std::size_t j = 0; j < model_.joints().size(); ++j) {
      if (add_joint(j, row)) return;
    }
    for (const model::ActuatorModel& actuator : model_.actuators()) {
      if (actuator.row != row.held.row) continue;
      add("the command of '" + actuator.name + "'", false, row, unit_of(*actuator.kind));
    }
  }

  JointConflict conflict() const {
    const double open = kPart * std::ranges::max_element(lacks_, {}, &Lack::most)->most();
    JointConflict result;
    std::vector<std::string> gaps, others;
    for (const Lack& lack : lacks_) {
      if (!(lack.most() > open)) {
        others.push_back(lack.name);
        continue;
      }
      gaps.push_back(
          fmt::format("{} is {} by {}", lack.name, lack.joint ? "open" : "missed", lack.amount()));
      result.opens = result.opens || lack.joint;
    }
    result.text = join(gaps);
    if (!others.empty()) result.text += " against " + join(others);
    return result;
  }

 private:
  static bool contains(const constraint::Constraint& rows, int row) {
    return row >= rows.first_row() && row < rows.first_row() + rows.row_count();
  }
  // Whether the row belongs to the joint or to one of its limits.
  bool add_joint(std::size_t index, const Row& row) {
    const model::JointModel& joint = model_.joints()[index];
    const constraint::Joint* rigid = model_.joint(static_cast<int>(index));
    if (contains(model_.constraint(joint.constraint), row.held.row)) {
      const bool turns = rigid != nullptr && rigid->is_turn(row.held.row);
      add("'" + joint.name + "'", true, row, turns ? Unit::angle : Unit::length);
      return true;
    }
    for (std::size_t motion = 0; motion < joint.motions.size(); ++motion) {
      const int own = joint.motions[motion];
      if (own < 0 || !contains(model_.constraint(own), row.held.row)) continue;
      add("the limit of '" + joint.name + "'", false, row,
          motion == 0 ? Unit::angle : Unit::length);
      return true;
    }
    return false;
  }
  static std::string join(const std::vector<std::string>& texts) {
    const std::size_t named = std::min(kNamed, texts.size());
    std::string text;
    for (std::size_t k = 0; k < named; ++k) {
      if (k > 0) text += k + 1 == texts.size() ? " and " : ", ";
      text += texts[k];
    }
    return named < texts.size() ? fmt::format("{} and {} more", text, texts.size() - named) : text;
  }
  void add(const std::string& name, bool joint, const Row& row, Unit unit) {
    auto at = std::ranges::find(lacks_, name, &Lack::name);
    if (at == lacks_.end()) at = lacks_.insert(at, {name, joint});
    const auto of = static_cast<std::size_t>(unit);
    at->squares[of] += row.gap * row.gap;
    at->largest[of] = std::max(at->largest[of], row.motion_scale * std::abs(row.gap));
  }

  const model::Model& model_;
  std::vector<Lack> lacks_;
};

}  // namespace

JointConflict find_joint_conflict(const World& world, double least) {
  const law::StepProblem& problem = world.problem();
  std::vector<Row> rows = list_rows(problem);
  if (rows.empty()) return {};
  if (!find_unclosed(problem, rows)) return {};
  const auto in_metres = [](const Row& row) { return row.motion_scale * std::abs(row.unclosed); };
  if (!(in_metres(*std::ranges::max_element(rows, {}, in_metres)) > least)) return {};
  Names names(world.model());
  for (const Row& row : rows) {
    if (row.takes_part) names.add(row);
  }
  return names.conflict();
}

}  // namespace sinew::world
