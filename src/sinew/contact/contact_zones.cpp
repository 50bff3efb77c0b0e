#include "sinew/contact/contact_zones.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/law/step_problem.hpp"

namespace sinew::contact {

namespace {

// Overlaps that may remain, relative to a zone's size and to its deflection by its force, so the
// forces of a stiff body are distributed, too. Below the last fraction of the size, rounding
// dominates.
constexpr double kTolerance = 2e-4, kOfDeflection = 0.01, kFloor = 1e-7;
// Of these overlaps: the linearised gaps that meet the bound may end a little beyond it.
constexpr double kBeyond = 2.0;
// Initial w, its factor if overlaps grow by the third number, its factor otherwise, and the
// largest. The approximate B is too stiff for most loads, but not for all.
constexpr double kRelaxation = 1.0, kLess = 0.5, kGrows = 1.1, kMore = 1.3, kMost = 4.0;
// a, relative to the distance of neighbouring points. Larger values make neighbours too similar.
constexpr double kSpread = 0.2;
constexpr int kSweeps = 40;
// Smaller differences between weights, and between gaps relative to a zone's size, are ignored, so
// rounding decides nothing.
constexpr double kAlike = 1e-6;

}  // namespace

ContactZones::ContactZones(const constraint::Contact& contact, double size,
                           const constraint::Configuration& configuration)
    : contact_(contact),
      configuration_(configuration),
      size_(size),
      weight_(contact.size(), 0.0),
      next_(contact.size(), -1) {
  if (contact.is_found_anew()) {
    make_zones(configuration.surface_nodes(contact.body()));
  } else {
    const mechanics::RowValues none;
    Points at(static_cast<Eigen::Index>(contact.size()), 3);
    for (std::size_t k = 0; k < contact.size(); ++k) {
      at.row(static_cast<Eigen::Index>(k)) =
          contact.position_now(configuration, k, none).transpose();
    }
    make_zones(at);
  }
}

double ContactZones::tolerance() const { return kTolerance * size_; }

// Seeds are at least half a zone from all earlier seeds; each point belongs to the nearest seed.
void ContactZones::make_zones(const Points& at) {
  std::vector<Vector3> seeds;
  const auto nearest = [&](const Vector3& place) {
    double least = kInfinity;
    int seed = -1;
    for (std::size_t s = 0; s < seeds.size(); ++s) {
      const double distance = (seeds[s] - place).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      seed = static_cast<int>(s);
    }
    return std::pair(seed, std::sqrt(least));
  };
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const Vector3 place = at.row(i).transpose();
    if (nearest(place).second > 0.5 * size_) seeds.push_back(place);
  }
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    zone_of_place_.push_back(nearest(at.row(i).transpose()).first);
  }
  zones_.resize(seeds.size());
  forget_friction();
  measure_spacing(at);
}

// The mean distance to the nearest neighbour in the same zone.
void ContactZones::measure_spacing(const Points& at) {
  std::vector<std::vector<Eigen::Index>> places(zones_.size());
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    places[static_cast<std::size_t>(zone_of_place_[static_cast<std::size_t>(i)])].push_back(i);
  }
  double sum = 0.0;
  int count = 0;
  for (const auto& own : places) {
    for (const Eigen::Index i : own) {
      double least = kInfinity;
      for (const Eigen::Index j : own) {
        if (i != j) least = std::min(least, (at.row(i) - at.row(j)).norm());
      }
      if (!(least > 0.0) || least == kInfinity) continue;
      sum += least;
      ++count;
    }
  }
  spread_ = kSpread * (count > 0 ? sum / count : size_);
}

int ContactZones::zone_of(std::size_t point, const mechanics::RowValues& rows) const {
  if (!contact_.is_found_anew()) return zone_of_place_[point];
  const mechanics::Patch& patch = rows.patch[contact_.entry(point)];
  const double most = *std::ranges::max_element(patch.weights) - kAlike;
  NodeId first = -1;
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) {
    const NodeId node = patch.nodes[k];
    if (node < 0 || patch.weights[k] < most) continue;
    if (first < 0 || node < first) first = node;
  }
  return zone_of_place_[static_cast<std::size_t>(first)];
}

double ContactZones::normal_effort(std::size_t point, std::span<const double> effort) const {
  return std::max(0.0, effort[static_cast<std::size_t>(contact_.row(point))]);
}

void ContactZones::begin(std::span<const double> effort, std::span<const double> arrivals,
                         double near, mechanics::RowValues& rows) {
  for (Zone& zone : zones_) {
    zone = {};
    zone.nearest = kInfinity;
    zone.relaxation = kRelaxation;
    zone.allowed = tolerance();
  }
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    weight_[k] = 0.0;
    if (contact_.idle(k, rows)) continue;
    Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    weight_[k] = normal_effort(k, effort);
    zone.force += weight_[k];
    zone.nearest = std::min(zone.nearest, arrivals[k]);
  }
  for (Zone& zone : zones_) zone.touched = zone.force > 0.0;
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    if (contact_.idle(k, rows)) continue;
    const Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    if (zone.touched || zone.nearest > near) continue;
    if (arrivals[k] <= zone.nearest + kAlike * size_) weight_[k] = 1.0;
  }
  group(rows);
}

// Forms the groups of rows from weight_.
void ContactZones::group(mechanics::RowValues& rows) {
  mechanics::RowGroups& groups = rows.groups;
  std::vector<double>& share = groups.share;
  for (Zone& zone : zones_) {
    zone.first = zone.last = -1;
    zone.force = 0.0;
  }
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    if (weight_[k] > 0.0) zones_[static_cast<std::size_t>(zone_of(k, rows))].force += weight_[k];
  }
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    const int row = contact_.row(k);
    const bool takes_part = weight_[k] > 0.0;
    std::fill_n(rows.active.begin() + row, 3, static_cast<char>(takes_part));
    std::fill_n(groups.next.begin() + row, 3, -1);
    if (!takes_part) continue;
    Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    if (zone.first < 0) zone.first = row;
    for (int j = 0; j < 3; ++j) {
      const auto own = static_cast<std::size_t>(row + j);
      groups.leader[own] = zone.first + j;
      share[own] = weight_[k] / zone.force;
      if (zone.last >= 0) groups.next[static_cast<std::size_t>(zone.last + j)] = row + j;
    }
    zone.last = row;
  }
}

void ContactZones::spread(std::span<double> effort, const mechanics::RowValues& rows) const {
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    for (int row = contact_.row(k); row < contact_.row(k) + 3; ++row) {
      if (rows.active[static_cast<std::size_t>(row)] == 0 || !rows.groups.leads(row)) continue;
      double sum = 0.0;
      rows.groups.for_each_member(
          row, [&](int member, double) { sum += effort[static_cast<std::size_t>(member)]; });
      rows.groups.for_each_member(row, [&](int member, double share) {
        effort[static_cast<std::size_t>(member)] = share * sum;
      });
    }
  }
}

// Also lists the points of each zone that have a force or overlap. The gap of a point with a force
// is zero up to rounding, whose sign must not decide anything: neither which points share forces,
// nor whether overlaps have grown.
void ContactZones::measure_overlaps(std::span<const double> gaps,
                                    const mechanics::RowValues& rows) {
  for (Zone& zone : zones_) {
    zone.overlap_before = zone.overlap;
    zone.overlap = 0.0;
    zone.begin = -1;
  }
  for (std::size_t k = contact_.size(); k-- > 0;) {
    if (contact_.idle(k, rows)) continue;
    const double overlap = gaps[k] < -kFloor * size_ ? -gaps[k] : 0.0;
    if (!(weight_[k] > 0.0 || overlap > 0.0)) continue;
    Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    zone.overlap = std::max(zone.overlap, overlap);
    next_[k] = zone.begin;
    zone.begin = static_cast<int>(k);
  }
}

// Solves by projected Gauss-Seidel sweeps.
void ContactZones::smooth(const Zone& zone, std::span<const double> gaps, double force,
                          double compliance, const mechanics::RowValues& rows) {
  const std::size_t n = points_.size();
  places_.clear();
  force_.clear();
  for (const std::size_t k : points_) {
    places_.push_back(contact_.position_now(configuration_, k, rows));
    force_.push_back(weight_[k] > 0.0 ? rows.groups.share_of(contact_.row(k)) * force : 0.0);
  }
  compliance_.resize(n * n);
  double own = 0.0;  // force^T B force
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double distance = (places_[i] - places_[j]).squaredNorm();
      compliance_[i * n + j] = 1.0 / std::sqrt(distance + spread_ * spread_);
      own += force_[i] * compliance_[i * n + j] * force_[j];
    }
  }
  const double scale = own > 0.0 ? compliance * force * force / own : 1.0;
  const auto motion = [&](std::size_t i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) sum += compliance_[i * n + j] * force_[j];
    return scale * sum;
  };
  goal_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    goal_[i] = motion(i) - zone.relaxation * gaps[points_[i]];
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < n; ++i) {
      const double missing = goal_[i] - motion(i);
      force_[i] = std::max(0.0, force_[i] + missing / (scale * compliance_[i * n + i]));
    }
  }
  for (std::size_t i = 0; i < n; ++i) weight_[points_[i]] = force_[i];
}

bool ContactZones::refine(std::span<const double> gaps, const law::StepProblem& problem,
                          const RowNumbering& numbering, const linalg::AlignedNumbers& effort,
                          mechanics::RowValues& rows) {
  measure_overlaps(gaps, rows);
  bool found = false;
  for (Zone& zone : zones_) {
    const int row = zone.first < 0 ? -1 : numbering.problem_row_of(zone.first);
    const double force = row < 0 ? 0.0 : effort[static_cast<std::size_t>(row)];
    const double compliance = row < 0 ? 0.0 : problem.compliance(row, row);
    zone.allowed = std::min(tolerance(), kOfDeflection * compliance * force);
    if (!(zone.overlap > zone.allowed)) {
      zone.overlap = 0.0;  // if it grows, this is not because forces were redistributed
      continue;
    }
    found = true;
    if (zone.overlap_before > 0.0) {
      const bool grows = zone.overlap > kGrows * zone.overlap_before;
      zone.relaxation = std::min(kMost, (grows ? kLess : kMore) * zone.relaxation);
    }
    points_.clear();
    for (int k = zone.begin; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
      points_.push_back(static_cast<std::size_t>(k));
    }
    smooth(zone, gaps, force, compliance, rows);
  }
  if (found) group(rows);
  return found;
}

double ContactZones::excess(const mechanics::RowValues& rows) const {
  double deepest = 0.0;
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    if (contact_.idle(k, rows)) continue;
    const double overlap = -rows.delta[contact_.row(k)];
    if (!(overlap > kFloor * size_)) continue;
    const Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    deepest = std::max(deepest, overlap - kBeyond * zone.allowed);
  }
  return deepest;
}

// Lists the points of each zone that have a force or overlap.
void ContactZones::list_points(std::span<const double> effort, const mechanics::RowValues& rows) {
  for (Zone& zone : zones_) zone.begin = -1;
  for (std::size_t k = contact_.size(); k-- > 0;) {
    if (contact_.idle(k, rows)) continue;
    if (!(normal_effort(k, effort) > 0.0 || rows.delta[contact_.row(k)] < 0.0)) continue;
    Zone& zone = zones_[static_cast<std::size_t>(zone_of(k, rows))];
    next_[k] = zone.begin;
    zone.begin = static_cast<int>(k);
  }
}

void ContactZones::take_points(const Zone& zone, std::span<const double> effort,
                               std::span<const double> friction, const mechanics::RowValues& rows) {
  zone_points_.clear();
  for (int k = zone.begin; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
    const auto point = static_cast<std::size_t>(k);
    const int row = contact_.row(point);
    zone_points_.push_back({contact_.position_now(configuration_, point, rows),
                            contact_.frame(point, rows),
                            Vector3::Map(&effort[static_cast<std::size_t>(row)]),
                            rows.delta.segment<3>(row), friction[point]});
  }
}

// Adds the force error of the zone in zone_points_.
void ContactZones::add_lack(double& friction_lack, const Vector3& compliance, ForceError& sum) {
  Vector3 resultant = Vector3::Zero(), own = Vector3::Zero(), normal = Vector3::Zero();
  for (const ZonePoint& point : zone_points_) {
    own += point.force;
    resultant += point.frame * point.force;
    normal += point.force[0] * point.frame.col(0);
  }
  if (!(own[0] > 0.0)) {
    friction_lack = 0.0;
    return;
  }
  normal.normalize();
  const Vector3 change = estimate_.force_change(zone_points_, compliance, spread_);
  const double along = normal.dot(change), across = (change - along * normal).norm();
  const double limit = zone_points_.front().friction * own[0];
  const bool slides = own.tail<2>().norm() >= (1.0 - kAlike) * limit;
  friction_lack = slides ? across : std::min(friction_lack + across, 2.0 * limit);
  sum.change += std::hypot(along, friction_lack);
  sum.force += resultant.norm();
}

ContactZones::ForceError ContactZones::end_step(const law::StepProblem& problem,
                                                const RowNumbering& numbering,
                                                std::span<const double> effort,
                                                std::span<const double> friction,
                                                const mechanics::RowValues& rows) {
  list_points(effort, rows);
  ForceError sum;
  for (std::size_t z = 0; z < zones_.size(); ++z) {
    const Zone& zone = zones_[z];
    const int row = zone.first < 0 ? -1 : numbering.problem_row_of(zone.first);
    zone_points_.clear();
    if (row >= 0) take_points(zone, effort, friction, rows);
    const Vector3 compliance =
        row < 0 ? Vector3(Vector3::Zero()) : Vector3(problem.compliance.diagonal().segment<3>(row));
    add_lack(lacks_[z], compliance, sum);
  }
  return sum;
}

bool ContactZones::gap_closed(std::span<const double> effort,
                              const mechanics::RowValues& rows) const {
  for (std::size_t k = 0; k < contact_.size(); ++k) {
    if (!(normal_effort(k, effort) > 0.0)) continue;
    if (!zones_[static_cast<std::size_t>(zone_of(k, rows))].touched) return true;
  }
  return false;
}

}  // namespace sinew::contact
