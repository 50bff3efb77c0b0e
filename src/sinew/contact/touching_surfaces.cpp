#include "sinew/contact/touching_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/surface_contact.hpp"
#include "sinew/contact/surface_gap.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::contact {

namespace {

// Vertices on slopes up to this sine towards the other surface are points, since they touch when
// bodies flatten on each other. So are crossings of ridges. Of other edges, only the nearest are
// points, with a tolerance for rounding, since neighbours in a flat region are equally near.
constexpr double kSlack = 0.5, kEdgeSlack = 1e-9;
// Overlaps up to this many separations, 1e-6 of the larger body, are left to the next step: where
// flat meshes lie on each other, their edges cross and overlap at second order in the motion.
constexpr double kOverlap = 10.0;
// Cosine of the largest angle by which a normal turns within a part. A normal that turns farther
// belongs to the face beyond an edge.
constexpr double kSameFace = 0.9;
// Unit normals that differ by less are equal.
constexpr double kSameNormal = 1e-9;
constexpr std::size_t kKeyMemory = 3;
// Reach of the search that measures the drift of touching points, in separations.
constexpr double kDriftReach = 1e3;

Vector3 normal_of(const Points& nodes, const collision::Triangle& triangle) {
  const Vector3 corner = nodes.row(triangle[0]).transpose();
  const Vector3 one = nodes.row(triangle[1]).transpose() - corner;
  const Vector3 other = nodes.row(triangle[2]).transpose() - corner;
  return one.cross(other).normalized();
}

}  // namespace

TouchingSurfaces::TouchingSurfaces(const constraint::SurfaceContact& contact,
                                   const constraint::Configuration& configuration,
                                   mechanics::RowValues& rows, ThreadPool& pool)
    : contact_(contact),
      configuration_(configuration),
      rows_(rows),
      pool_(pool),
      proximity_(pool),
      impacts_(pool),
      first_(contact.first().surface),
      second_(contact.second().surface) {
  contact.prepare(rows);
}

TouchingSurfaces::~TouchingSurfaces() = default;

TouchingSurfaces::Key TouchingSurfaces::name(const collision::ProximityPair& pair) {
  using enum collision::FeatureKind;
  if (pair.first.kind == vertex) return {0, pair.first.number, -1};
  if (pair.second.kind == vertex) return {1, pair.second.number, -1};
  return {2, pair.first.number, pair.second.number};
}

void TouchingSurfaces::move_trees(const Points& first, const Points& second) {
  first_.move(first, pool_);
  if (!contact_.is_within()) second_.move(second, pool_);
}

// The order does not depend on the history of the trees. Positions that are held on both surfaces
// touch without a force. If there are more pairs than rows, keeps those that do not wait, and the
// nearest.
// @param ahead whether to search also as far as the nodes are expected to move.
void TouchingSurfaces::find(double reach, bool ahead) {
  if (ahead && first_ahead_.size() > 0) {
    first_.expect(first_ahead_);
    if (!contact_.is_within()) second_.expect(second_ahead_);
  }
  const collision::ProximitySettings settings{
      .distance = reach, .depth = contact_.depth(), .slack = kSlack, .edge_slack = kEdgeSlack};
  const auto pairs = contact_.is_within() ? proximity_.within(first_, settings)
                                          : proximity_.between(first_, second_, settings);
  found_.clear();
  for (const collision::ProximityPair& pair : pairs) {
    const bool held = contact_.first().holds(pair.first) && contact_.second().holds(pair.second);
    if (!held) found_.push_back({name(pair), pair});
  }
  if (found_.size() > contact_.size()) {
    const auto nearer = [&](const Named& a, const Named& b) {
      if (a.pair.between_flat != b.pair.between_flat) return b.pair.between_flat;
      if (a.pair.distance != b.pair.distance) return a.pair.distance < b.pair.distance;
      return comes_before(a, b);
    };
    const auto end = found_.begin() + static_cast<std::ptrdiff_t>(contact_.size());
    std::ranges::nth_element(found_, end, nearer);
    found_.erase(end, found_.end());
  }
  std::ranges::sort(found_, comes_before);
}

bool TouchingSurfaces::comes_before(const Named& a, const Named& b) {
  if (a.key != b.key) return a.key < b.key;
  if (a.pair.distance != b.pair.distance) return a.pair.distance < b.pair.distance;
  return std::ranges::lexicographical_compare(a.pair.normal, b.pair.normal);
}

// The points of a step serve two purposes.
// 1. A point can be active from the start of a step only if it is found here: ContactRows takes
//    pairs whose gap is small at the end of the step at their present relative velocity w. With the
//    time step h, that is a distance of h |w| and a little more.
// 2. Surfaces that move by more than the depth in which overlaps are found may pass through each
//    other unnoticed by add_overlaps(). Points that were found at the start prevent it.
// For both it suffices that two places are looked for as far as they may move towards each other:
// with |w| <= |u| + |v| for the velocities u, v of both, relative to any common one, ahead (|u| +
// |v|), where `ahead` is h times a factor for velocities that grow in the step. Nodes far away do
// not matter. If velocities grow more, add_overlaps() or passed() finds what was missed.
void TouchingSurfaces::look_ahead(double reach, double ahead) {
  reach_ = reach;
  const Points& first = configuration_.surface_node_velocities(contact_.body());
  const Points& second = configuration_.surface_node_velocities(contact_.other_body());
  const Vector3 common = 0.5 * (first.colwise().mean() + second.colwise().mean()).transpose();
  const auto set = [&](const Points& rates, VectorX& motion) {
    motion = ahead * (rates.rowwise() - common.transpose()).rowwise().norm();
  };
  set(first, first_ahead_);
  set(second, second_ahead_);
}

void TouchingSurfaces::begin_step(std::span<double> effort) {
  first_start_ = configuration_.surface_nodes(contact_.body());
  second_start_ = configuration_.surface_nodes(contact_.other_body());
  move_trees(first_start_, second_start_);
  find(reach_, true);
  keep_forces(effort);
  add_kept_edges();
  keys_.clear();
  pairs_.clear();
  for (const Named& one : found_) add_point(one);
  clear_rest();
  pass_forces_on(effort);
}

void TouchingSurfaces::begin_again() {
  first_start_ = configuration_.surface_nodes(contact_.body());
  second_start_ = configuration_.surface_nodes(contact_.other_body());
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    contact_.measure(configuration_, k, rows_);
    const int row = contact_.row(k);
    rows_.offset.segment<2>(row + 1) -= rows_.delta.segment<2>(row + 1);
    rows_.reference.segment<3>(row) = Vector3(rows_.delta[row], 0.0, 0.0);
  }
  clear_rest();
}

// Without them, the motion of the step would lead into each of these pairs again, and the law would
// be solved again with their rows.
void TouchingSurfaces::add_kept_edges() {
  kept_edges_.clear();
  const auto is_found = [&](const Key& key) {
    return std::ranges::binary_search(
        found_, key, [](const Key& a, const Key& b) { return a < b; }, &Named::key);
  };
  for (const auto& [key, point, force] : before_) {
    if (key.kind != 2 || is_found(key)) continue;
    // Within one surface, either edge may be the first.
    if (contact_.is_within() && is_found({2, key.second, key.first})) continue;
    kept_edges_.push_back({key.first, key.second});
  }
  if (kept_edges_.empty()) return;
  const collision::SurfaceTree& second = contact_.is_within() ? first_ : second_;
  const collision::ProximitySettings settings{.distance = reach_, .depth = contact_.depth()};
  for (const auto& pair : proximity_.crossings(first_, second, kept_edges_, settings)) {
    if (found_.size() == contact_.size()) break;
    found_.push_back({name(pair), pair});
    found_.back().pair.between_flat = false;
  }
  std::ranges::sort(found_, comes_before);
}

void TouchingSurfaces::add_point(const Named& one) {
  contact_.put(keys_.size(), one.pair, first_start_, second_start_, rows_);
  keys_.push_back(one.key);
  pairs_.push_back(one.pair);
}

double TouchingSurfaces::slack(std::size_t point) const {
  return waits(point) ? contact_.separation() : 0.0;
}

void TouchingSurfaces::clear_rest() {
  for (std::size_t k = keys_.size(); k < contact_.size(); ++k) {
    if (!contact_.idle(k, rows_)) contact_.clear(k, rows_);
    rows_.reference[contact_.row(k)] = reach_;
  }
}

// Stores the forces and removes them from the rows.
void TouchingSurfaces::keep_forces(std::span<double> effort) {
  before_.clear();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    Eigen::Map<Vector3> force(effort.data() + contact_.row(k));
    if (force[0] > 0.0) before_.push_back({keys_[k], k, contact_.frame(k, rows_) * force});
    force.setZero();
  }
  std::ranges::sort(before_, [](const Force& a, const Force& b) {
    return std::tie(a.key, a.point) < std::tie(b.key, b.point);
  });
}

void TouchingSurfaces::pass_forces_on(std::span<double> effort) const {
  auto before = before_.begin();
  for (std::size_t k = 0; k < keys_.size() && before != before_.end(); ++k) {
    while (before != before_.end() && before->key < keys_[k]) ++before;
    if (before == before_.end() || before->key != keys_[k]) continue;
    const Vector3 force = contact_.frame(k, rows_).transpose() * (before++)->force;
    if (force[0] > 0.0) std::copy_n(force.data(), 3, effort.begin() + contact_.row(k));
  }
}

void TouchingSurfaces::propose(std::span<mechanics::StepSystem* const> systems) {
  const auto look = [&](int body, Points& nodes) {
    nodes = configuration_.surface_nodes(body);
    systems[static_cast<std::size_t>(body)]->add_proposed_motion(nodes);
  };
  look(contact_.body(), first_end_);
  look(contact_.other_body(), second_end_);
}

double TouchingSurfaces::proposed_gap(std::size_t point) const {
  return contact_.gap_at(first_end_, second_end_, point, rows_);
}

double TouchingSurfaces::permitted_overlap() const { return kOverlap * contact_.separation(); }

bool TouchingSurfaces::add_overlaps() {
  if (!first_end_.allFinite() || !second_end_.allFinite()) return false;
  move_trees(first_end_, second_end_);
  find(0.0);
  const double allowed = permitted_overlap();
  const std::size_t points = keys_.size();
  for (const Named& one : found_) {
    if (one.pair.distance >= -allowed || keys_.size() == contact_.size()) continue;
    if (std::ranges::find(keys_, one.key) != keys_.end()) continue;
    add_point(one);
    pairs_.back().between_flat = false;  // a motion leads into it, so it no longer waits
    contact_.measure(configuration_, keys_.size() - 1, rows_);
  }
  return keys_.size() > points;
}

// After motions smaller than the depth up to which overlaps are detected, add_overlaps() finds
// them.
bool TouchingSurfaces::passed() {
  const double allowed = contact_.depth();
  if (farthest_way() < allowed) return false;
  return std::ranges::any_of(find_impacts(),
                             [&](const auto& impact) { return has_passed(impact, allowed); });
}

std::span<const collision::SurfaceImpact> TouchingSurfaces::find_impacts() {
  first_.sweep(first_start_, configuration_.surface_nodes(contact_.body()), pool_);
  if (contact_.is_within()) return impacts_.within(first_, 0.0);
  second_.sweep(second_start_, configuration_.surface_nodes(contact_.other_body()), pool_);
  return impacts_.between(first_, second_, 0.0);
}

void TouchingSurfaces::look_at_overlaps() {
  move_trees(configuration_.surface_nodes(contact_.body()),
             configuration_.surface_nodes(contact_.other_body()));
  find(contact_.separation());
}

// Pair of a point in the last search; null if there is none. Among several pairs with the same
// name, as in a groove, the one whose normal is nearest to that of the point.
// @param least the cosine between the normals must exceed it.
const collision::ProximityPair* TouchingSurfaces::pair_there(std::size_t point,
                                                             double least) const {
  const Vector3& normal = rows_.direction[contact_.entry(point)];
  const collision::ProximityPair* best = nullptr;
  auto one = std::ranges::lower_bound(
      found_, keys_[point], [](const Key& a, const Key& b) { return a < b; }, &Named::key);
  for (; one != found_.end() && one->key == keys_[point]; ++one) {
    const double along = normal.dot(one->pair.normal);
    if (along <= least) continue;
    least = along;
    best = &one->pair;
  }
  return best;
}

double TouchingSurfaces::gap_there(std::size_t point) const {
  const collision::ProximityPair* pair = pair_there(point, 0.0);
  return pair != nullptr ? pair->distance - contact_.separation()
                         : rows_.delta[contact_.row(point)];
}

void TouchingSurfaces::look_around() {
  move_trees(configuration_.surface_nodes(contact_.body()),
             configuration_.surface_nodes(contact_.other_body()));
  find(reach_, true);
}

bool TouchingSurfaces::turn(std::size_t point) {
  const collision::ProximityPair* pair = pair_there(point, kSameFace);
  const Vector3& normal = rows_.direction[contact_.entry(point)];
  if (pair == nullptr || (pair->normal - normal).norm() <= kSameNormal) return false;
  pairs_[point].first = pair->first;
  pairs_[point].second = pair->second;
  pairs_[point].normal = pair->normal;
  contact_.put(point, pairs_[point], first_start_, second_start_, rows_);
  return true;
}

std::optional<double> TouchingSurfaces::opening(std::size_t point) const {
  const collision::ProximityPair* pair = pair_there(point, kSameFace);
  if (pair == nullptr) return std::nullopt;
  return pair->distance - pairs_[point].distance;
}

double TouchingSurfaces::deepest() const {
  double least = kInfinity;
  for (const Named& one : found_) least = std::min(least, one.pair.distance);
  return least - contact_.separation();
}

// Surfaces cannot meet if no pair was near enough at the start of the part.
double TouchingSurfaces::first_passing(double allowed) {
  const double way = farthest_way();
  if (way <= allowed || (keys_.empty() && way < reach_)) return kInfinity;
  double first = kInfinity;
  for (const collision::SurfaceImpact& impact : find_impacts()) {
    if (impact.time < first && has_passed(impact, allowed)) first = impact.time;
  }
  return first;
}

double TouchingSurfaces::farthest_way() const {
  const auto farthest = [&](int body, const Points& start) {
    return (configuration_.surface_nodes(body) - start).rowwise().norm().maxCoeff();
  };
  return farthest(contact_.body(), first_start_) + farthest(contact_.other_body(), second_start_);
}

// Signed height of a vertex above a face, or of an edge above another one, m.
double TouchingSurfaces::height(const collision::SurfaceImpact& impact, const Points& first,
                                const Points& second) const {
  using collision::FeatureKind;
  const collision::SurfaceTopology &one = *contact_.first().surface,
                                   &other = *contact_.second().surface;
  const auto at = [](const Points& nodes, NodeId node) -> Vector3 {
    return nodes.row(node).transpose();
  };
  const auto over = [&](const Points& own, NodeId vertex, const Points& nodes,
                        const collision::Triangle& face) {
    return normal_of(nodes, face).dot(at(own, vertex) - at(nodes, face[0]));
  };
  const auto i = static_cast<std::size_t>(impact.first),
             j = static_cast<std::size_t>(impact.second);
  if (impact.first_kind == FeatureKind::vertex) {
    return over(first, impact.first, second, other.triangles()[j]);
  }
  if (impact.first_kind == FeatureKind::face) {
    return over(second, impact.second, first, one.triangles()[i]);
  }
  const auto [a, b] = one.edges()[i];
  const auto [c, d] = other.edges()[j];
  const Vector3 across = (at(first, b) - at(first, a)).cross(at(second, d) - at(second, c));
  return across.normalized().dot(at(first, a) - at(second, c));
}

// Whether the features are on opposite sides at the end, by more than `allowed`, m.
bool TouchingSurfaces::has_passed(const collision::SurfaceImpact& impact, double allowed) const {
  const collision::SurfaceTree& second = contact_.is_within() ? first_ : second_;
  const double before = height(impact, first_.positions(), second.positions());
  const double after = height(impact, first_.end_positions(), second.end_positions());
  return before * after < 0.0 && std::abs(after) > allowed;
}

void TouchingSurfaces::restart() {
  keys_.clear();
  pairs_.clear();
  clear_rest();
}

double TouchingSurfaces::drift(std::span<const double> effort) {
  const Points& first = configuration_.surface_nodes(contact_.body());
  const Points& second = configuration_.surface_nodes(contact_.other_body());
  move_trees(first, second);
  find(kDriftReach * contact_.separation());
  before_.clear();
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    if (effort[static_cast<std::size_t>(contact_.row(k))] > 0.0) {
      before_.push_back({keys_[k], k, Vector3::Zero()});
    }
  }
  add_kept_edges();
  double worst = 0.0;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    if (effort[static_cast<std::size_t>(contact_.row(k))] == 0.0) continue;
    const double gap = contact_.linear_gap(configuration_, k, rows_);
    double nearest = kInfinity;
    for (const Named& one : found_) {
      if (one.key != keys_[k]) continue;
      const double off = std::abs(contact_.gap_of(one.pair, first, second) - gap);
      nearest = std::min(nearest, off);
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

// The points of a pair are points of the surfaces, wherever they have moved since the search.
double TouchingSurfaces::nearest_point() const {
  double nearest = kInfinity;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    nearest = std::min(nearest, contact_.distance(configuration_, k, rows_));
  }
  return keys_.empty() ? 0.0 : nearest;
}

double TouchingSurfaces::measure_gap(double distance) {
  if (!gap_) gap_ = std::make_unique<SurfaceGap>(contact_, configuration_, pool_);
  return gap_->measure(distance);
}

void TouchingSurfaces::save(std::vector<double>& to) const {
  to.push_back(static_cast<double>(keys_.size()));
  to.push_back(reach_);
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    for (const int part : {keys_[k].kind, keys_[k].first, keys_[k].second}) {
      to.push_back(static_cast<double>(part));
    }
    to.resize(to.size() + constraint::SurfaceContact::kMemory);
    contact_.save(k, pairs_[k], rows_, to.data() + to.size() - constraint::SurfaceContact::kMemory);
  }
}

std::span<const double> TouchingSurfaces::load(std::span<const double> from) {
  constexpr std::size_t kHead = 2;  // number of points, and the reach
  constexpr std::size_t kEach = kKeyMemory + constraint::SurfaceContact::kMemory;
  const double told = from.empty() ? -1.0 : from[0];
  if (!(told >= 0.0 && told <= static_cast<double>(contact_.size())) ||
      from.size() < kHead + kEach * whole<std::size_t>(told)) {
    throw Error(ErrorKind::wrong_length, {.item = "points of contact '" + contact_.name() + "'"},
                "the state has none that fit", "take it from a simulation of the same model");
  }
  const auto count = whole<std::size_t>(told);
  reach_ = from[1];
  keys_.resize(count);
  pairs_.resize(count);  // which of them wait is determined in the next step
  clear_rest();
  const double* at = from.data() + kHead;
  for (std::size_t k = 0; k < count; ++k, at += kEach) {
    keys_[k] = {whole<int>(at[0]), whole<int>(at[1]), whole<int>(at[2])};
    pairs_[k] = contact_.load(k, at + kKeyMemory, rows_);
  }
  return from.subspan(kHead + count * kEach);
}

}  // namespace sinew::contact
