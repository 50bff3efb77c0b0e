#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/plan/reach.hpp"

namespace sinew::plan {

namespace {

constexpr double kRounding = 1e-9;

/// The integral of f_a f_b ... ds along the axis up to a point, where f_i(s) is the fraction of
/// segment i's bend before s. `times` counts the factors of each segment.
double bend_moment(const pcc::Arm& arm, const std::vector<int>& times, int segment, double fraction,
                   double scale) {
  int last = -1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] > 0) last = static_cast<int>(i);
  }
  if (last > segment) return 0.0;
  const auto& segments = arm.settings().segments;
  const auto power = times[static_cast<std::size_t>(last)];
  // Within the last of these segments f is s/L, and beyond it f is 1.
  const auto within = [&](int s) {
    const double length = segments[static_cast<std::size_t>(s)].length;
    const double to = s == segment ? fraction : 1.0, by = s == segment ? scale : 1.0;
    return std::pair(by * length * to, by * length * std::pow(to, power + 1) / (power + 1));
  };
  double sum = within(last).second;
  for (int s = last + 1; s <= segment; ++s) {
    sum += segments[static_cast<std::size_t>(s)].dead_length + within(s).first;
  }
  return sum;
}

struct Interval {
  double lower, upper;
};

class Search {
 public:
  Search(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits, const Vector3& goal,
         const ReachProofSettings& settings)
      : arm_(arm),
        equations_(arm),
        dynamics_(arm),
        n_(arm->coordinates()),
        tip_{arm->segments() - 1},
        still_(VectorX::Zero(n_)),
        gradients_(static_cast<std::size_t>(n_)) {
    const Eigen::Index rows = n_ + 3;
    lower_.resize(rows);
    upper_.resize(rows);
    // Range of B tau within the limits, for each coordinate.
    const MatrixX more = arm->actuation().cwiseMax(0.0), less = arm->actuation().cwiseMin(0.0);
    lower_.head(n_) = more * limits.torque_lower + less * limits.torque_upper;
    upper_.head(n_) = more * limits.torque_upper + less * limits.torque_lower;
    lower_.tail(3) = goal.array() - settings.tolerance;
    upper_.tail(3) = goal.array() + settings.tolerance;
    lower_.array() -= kRounding;
    upper_.array() += kRounding;
    set_curvatures();
  }

  enum class Answer { gone, found, open };
  /// Shrinks the box, or classifies it.
  Answer look(VectorX& from, VectorX& to) {
    for (int round = 0; round < 3; ++round) {
      const VectorX centre = 0.5 * (from + to), half = 0.5 * (to - from);
      const auto& linear = equations_.linearise(centre, still_, still_);
      slopes_.resize(n_ + 3, n_);
      values_.resize(n_ + 3);
      values_.head(n_) = linear.residual;
      slopes_.topRows(n_) = linear.by_position;
      const auto view = [](const VectorX& v) {
        return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
      };
      dynamics_.place(view(centre));
      const auto at = dynamics_.position(tip_);
      values_.tail(3) << at.x, at.y, at.z;
      dynamics_.jacobian(tip_, gradients_);
      for (Eigen::Index j = 0; j < n_; ++j) {
        const auto& column = gradients_[static_cast<std::size_t>(j)];
        slopes_.col(j).tail(3) << column.x, column.y, column.z;
      }
      if (((values_ - lower_).array() >= 0.0).all() && ((upper_ - values_).array() >= 0.0).all()) {
        from = to = centre;
        return Answer::found;
      }
      const double before = half.maxCoeff();
      if (!shrink(half, from, to, centre)) return Answer::gone;
      if ((to - from).maxCoeff() > 1.4 * before) break;
    }
    return Answer::open;
  }

 private:
  /// Bounds of second derivatives for each row: the torques of the coordinates, then the tip.
  void set_curvatures() {
    std::vector<int> times(static_cast<std::size_t>(arm_->segments()), 0);
    curvatures_.assign(static_cast<std::size_t>(n_) + 1, MatrixX::Zero(n_, n_));
    for (int j = 0; j < n_; ++j) {
      for (int k = 0; k < n_; ++k) {
        ++times[static_cast<std::size_t>(j)];
        ++times[static_cast<std::size_t>(k)];
        curvatures_.back()(j, k) = bend_moment(*arm_, times, tip_.segment, 1.0, 1.0);
        for (int i = 0; i < n_; ++i) {
          ++times[static_cast<std::size_t>(i)];
          for (const pcc::Particle& particle : arm_->particles()) {
            const double weight =
                (particle.mass * arm_->settings().gravity + particle.force).norm();
            curvatures_[static_cast<std::size_t>(i)](j, k) +=
                weight *
                bend_moment(*arm_, times, particle.segment, particle.fraction, particle.scale);
          }
          --times[static_cast<std::size_t>(i)];
        }
        --times[static_cast<std::size_t>(j)];
        --times[static_cast<std::size_t>(k)];
      }
    }
  }

  /// Shrinks the box by each row, value + slope . d + remainder with |d| <= half, solved for each d
  /// in turn.
  bool shrink(const VectorX& half, VectorX& from, VectorX& to, const VectorX& centre) {
    from -= centre;
    to -= centre;
    for (Eigen::Index row = 0; row < n_ + 3; ++row) {
      const auto& curvature = curvatures_[static_cast<std::size_t>(std::min(row, n_))];
      const double rest = 0.5 * half.dot(curvature * half);
      Interval total{values_[row] - rest - upper_[row], values_[row] + rest - lower_[row]};
      // Requires 0 in total + slope . d.
      for (Eigen::Index j = 0; j < n_; ++j) {
        total.lower += std::min(slopes_(row, j) * from[j], slopes_(row, j) * to[j]);
        total.upper += std::max(slopes_(row, j) * from[j], slopes_(row, j) * to[j]);
      }
      if (total.lower > 0.0 || total.upper < 0.0) return false;
      for (Eigen::Index j = 0; j < n_; ++j) {
        const double slope = slopes_(row, j);
        if (std::abs(slope) < 1e-6) continue;
        const Interval own{std::min(slope * from[j], slope * to[j]),
                           std::max(slope * from[j], slope * to[j])};
        // Requires slope d_j in -(total - own).
        const double low = -(total.upper - own.upper), high = -(total.lower - own.lower);
        const Interval allowed =
            slope > 0.0 ? Interval{low / slope, high / slope} : Interval{high / slope, low / slope};
        from[j] = std::max(from[j], allowed.lower - kRounding);
        to[j] = std::min(to[j], allowed.upper + kRounding);
        if (from[j] > to[j]) return false;
        total.lower += std::min(slope * from[j], slope * to[j]) - own.lower;
        total.upper += std::max(slope * from[j], slope * to[j]) - own.upper;
      }
    }
    from += centre;
    to += centre;
    return true;
  }

  std::shared_ptr<const pcc::Arm> arm_;
  pcc::ArmEquations equations_;
  pcc::ArmDynamics<double> dynamics_;
  Eigen::Index n_;
  pcc::ArmPoint tip_;
  VectorX still_, lower_, upper_, values_;
  MatrixX slopes_;
  std::vector<pcc::Vec3<double>> gradients_;
  std::vector<MatrixX> curvatures_;
};

void check(const pcc::Arm& arm, const ReachProofSettings& settings) {
  for (int s = 0; s < arm.segments(); ++s) {
    if (arm.settings().segments[static_cast<std::size_t>(s)].bending != pcc::Bending::planar) {
      throw Error(ErrorKind::out_of_range, {.item = fmt::format("segments[{}]", s)},
                  "it bends about two axes, and the proof holds for segments of one angle",
                  "look for equilibria with nearest_reach");
    }
  }
  if (!(settings.tolerance > 0.0) || !(settings.angle > 0.0) || settings.max_boxes < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "settings"},
                fmt::format("tolerance {:g} m, angle {:g} rad, {} boxes", settings.tolerance,
                            settings.angle, settings.max_boxes),
                "give more than zero");
  }
}

}  // namespace

std::string_view verdict_name(ReachProof::Verdict verdict) {
  switch (verdict) {
    case ReachProof::Verdict::out_of_reach:
      return "out-of-reach";
    case ReachProof::Verdict::reachable:
      return "reachable";
    case ReachProof::Verdict::undecided:
      break;
  }
  return "undecided";
}

ReachProof prove_out_of_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& given,
                              const Vector3& goal, const ReachProofSettings& settings) {
  check(*arm, settings);
  const ArmLimits limits = completed_limits(*arm, given);
  Search search(arm, limits, goal, settings);
  const VectorX wide = VectorX::Constant(arm->coordinates(), settings.angle);
  struct Box {
    VectorX from, to;
  };
  std::vector<Box> open{{limits.angle_lower.cwiseMax(-wide), limits.angle_upper.cwiseMin(wide)}};
  ReachProof result;
  result.smallest = 0.5 * (open[0].to - open[0].from).maxCoeff();
  while (!open.empty()) {
    if (result.boxes >= settings.max_boxes) return result;
    ++result.boxes;
    Box box = std::move(open.back());
    open.pop_back();
    Eigen::Index widest = 0;
    result.smallest = std::min(result.smallest, 0.5 * (box.to - box.from).maxCoeff());
    switch (search.look(box.from, box.to)) {
      case Search::Answer::gone:
        continue;
      case Search::Answer::found:
        result.verdict = ReachProof::Verdict::reachable;
        result.position = box.from;
        return result;
      case Search::Answer::open:
        break;
    }
    (box.to - box.from).maxCoeff(&widest);
    Box other = box;
    box.to[widest] = other.from[widest] = 0.5 * (box.from[widest] + box.to[widest]);
    open.push_back(std::move(other));
    open.push_back(std::move(box));
  }
  result.verdict = ReachProof::Verdict::out_of_reach;
  return result;
}

}  // namespace sinew::plan
