#include "sinew/high_rate/touch_law.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/qp/friction_cone.hpp"

namespace sinew::high_rate {

namespace {

// Relative to the largest effort: tolerance of the laws within which states are kept.
constexpr double kObeys = 1e-8;
// Times that tolerance: relative motions that count as zero if nothing touches.
constexpr double kRounding = 1e-4;
// Number of steps that follow sliding points as they turn, the distance from the laws up to which
// they are tried, and the turn (rad) beyond which S is formed anew.
constexpr int kTurns = 8;
constexpr double kNear = 0.3;
constexpr double kTurned = 0.1;
// Relative to a row's own stiffness: limit on the derivative of friction with respect to motion.
constexpr double kSharp = 1e6;
// Relative to a row's own compliance: makes the equations of redundant contacts solvable.
constexpr double kEvenly = 1e-9;

}  // namespace

TouchLaw::TouchLaw(const HighRateSettings& settings)
    : settings_(settings),
      hands_(static_cast<int>(settings.hands.size())),
      driving_(settings.driving()),
      first_(settings.free_rows()),
      places_(VectorX::Zero(hands_)),
      free_(VectorX::Zero(first_)),
      compliance_(MatrixX::Zero(first_, driving_)),
      stiffness_(MatrixX::Zero(hands_, hands_)),
      touched_stiffness_(stiffness_),
      hand_work_(MatrixX::Zero(hands_, hands_)),
      hand_force_(VectorX::Zero(hands_)),
      factor_(hands_ + 3 * settings.max_contacts),
      cone_solver_({.tolerance = 0.01 * kObeys}) {
  const int most = hands_ + 3 * settings.max_contacts;
  effort_ = touch_free_ = offset_ = motion_ = change_ = VectorX::Zero(most);
  slope_.shape(most, driving_);
  columns_.shape(most, hands_);
  states_.reserve(static_cast<std::size_t>(hands_ + settings.max_contacts));
  states_before_.reserve(states_.capacity());
  slips_.reserve(static_cast<std::size_t>(settings.max_contacts));
  boxes_.reserve(static_cast<std::size_t>(hands_));
  cones_.reserve(static_cast<std::size_t>(settings.max_contacts));
}

void TouchLaw::begin(const Snapshot& snapshot) {
  snapshot_ = &snapshot;
  rows_ = hands_ + 3 * snapshot.contacts();
  for (int h = 0; h < hands_; ++h) {  // hands stay as they were
    if (static_cast<std::size_t>(h) >= states_.size()) effort_[h] = snapshot.effort[first_ + h];
  }
  effort_.segment(hands_, rows_ - hands_) = snapshot.effort.tail(rows_ - hands_);
  states_.resize(static_cast<std::size_t>(hands_ + snapshot.contacts()));
  slips_.resize(static_cast<std::size_t>(snapshot.contacts()));
  motion_.head(rows_) = snapshot.free.tail(rows_);
  motion_.head(rows_).noalias() += snapshot.compliance.bottomRows(rows_) * snapshot.effort;
  read_states();
  form();
}

// Whether S prescribes the row's motion; otherwise it prescribes the row's effort.
bool TouchLaw::holds_motion(int row) const {
  if (row < hands_) {
    return state(row) == Touch::held || (holds_limits_ && is_at_limit(row));
  }
  const Touch touch = state(hands_ + (row - hands_) / 3);
  const bool normal = (row - hands_) % 3 == 0;
  return touch == Touch::stick || (touch == Touch::slip && normal);
}

void TouchLaw::form_row(int row, Eigen::Map<MatrixX>& system) const {
  if (holds_motion(row)) {
    const double own = w()(first_ + row, first_ + row);
    system.row(row) = w().row(first_ + row).segment(first_, rows_) / own;
    system(row, row) += kEvenly;
    return;
  }
  system.row(row).setZero();
  system(row, row) = 1.0;
  if (row < hands_) return;
  if (!turns_friction(row)) return;
  const Slip& slip = slip_of(row);
  const int contact = (row - hands_) / 3, axis = axis_of(row);
  system(row, contact_row(contact)) += friction(contact) * slip.along[axis];
  for (int k = 0; k < 2; ++k) {
    system.row(row) += slip.turning(axis, k) * w().row(tangent_of(row) + k).segment(first_, rows_);
  }
}

bool TouchLaw::turns_friction(int row) const {
  return row >= hands_ && (row - hands_) % 3 != 0 &&
         state(hands_ + (row - hands_) / 3) == Touch::slip;
}

void TouchLaw::form() {
  ++factorisations_;
  // The stored energy treats hands at their limits as held.
  bool limits = false;
  for (int h = 0; h < hands_; ++h) limits = limits || is_at_limit(h);
  if (limits) {
    holds_limits_ = true;
    factorise();
    form_stiffness(touched_stiffness_);
    holds_limits_ = false;
  }
  factorise();
  form_slope();
  form_stiffness(stiffness_);
  if (!limits) touched_stiffness_ = stiffness_;
}

void TouchLaw::factorise() {
  Eigen::Map<MatrixX> system = factor_.matrix(rows_);
  for (int row = 0; row < rows_; ++row) form_row(row, system);
  factor_.factorise(rows_);
}

void TouchLaw::form_slope() {
  Eigen::Map<MatrixX> slope = slope_.shape(rows_, driving_);
  for (int row = 0; row < rows_; ++row) {
    slope.row(row).setZero();
    if (holds_motion(row)) {
      slope.row(row) = -w().row(first_ + row).head(driving_) / w()(first_ + row, first_ + row);
    } else if (turns_friction(row)) {
      const Slip& slip = slip_of(row);
      for (int k = 0; k < 2; ++k) {
        slope.row(row) -=
            slip.turning(axis_of(row), k) * w().row(tangent_of(row) + k).head(driving_);
      }
    }
  }
  for (int k = 0; k < driving_; ++k) factor_.solve(slope.col(k));
  compliance_ = w().topLeftCorner(first_, driving_);
  compliance_.noalias() += w().block(0, first_, first_, rows_) * slope;
}

void TouchLaw::form_stiffness(MatrixX& stiffness) {
  Eigen::Map<MatrixX> columns = columns_.shape(rows_, hands_);
  columns.setZero();
  for (int h = 0; h < hands_; ++h) {
    if (holds_motion(h)) columns(h, h) = 1.0 / w()(first_ + h, first_ + h);
    factor_.solve(columns.col(h));
  }
  stiffness = columns.topRows(hands_);
  for (int h = 0; h < hands_; ++h) {
    if (!holds_motion(h)) stiffness.row(h).setZero();
  }
}

// Effort of a row whose motion S does not prescribe.
double TouchLaw::given_effort(int row) const {
  if (row >= hands_) return 0.0;
  if (state(row) == Touch::at_max) return hand(row).max;
  return state(row) == Touch::at_min ? hand(row).min : 0.0;
}

void TouchLaw::move_hands(const VectorX& hands) {
  places_ = hands;
  for (int row = 0; row < rows_; ++row) {
    const double asked = row < hands_ ? places_[row] : 0.0;
    if (holds_motion(row)) {
      const double own = w()(first_ + row, first_ + row);
      touch_free_[row] = (asked - snapshot_->free[first_ + row]) / own;
    } else if (turns_friction(row)) {
      const auto turning = slip_of(row).turning.row(axis_of(row));
      touch_free_[row] = -turning.dot(snapshot_->free.segment<2>(tangent_of(row)));
    } else {
      touch_free_[row] = given_effort(row);
    }
  }
  factor_.solve(touch_free_.head(rows_));
  free_ = snapshot_->free.head(first_);
  free_.noalias() += w().block(0, first_, first_, rows_) * touch_free_.head(rows_);
}

void TouchLaw::measure(const VectorX& driving) {
  offset_.head(rows_) = snapshot_->free.segment(first_, rows_);
  offset_.head(rows_).noalias() += w().block(first_, 0, rows_, driving_) * driving;
  motion_.head(rows_) = offset_.head(rows_);
  motion_.head(rows_).noalias() += w().block(first_, first_, rows_, rows_) * effort_.head(rows_);
}

void TouchLaw::settle(const VectorX& driving, const VectorX& hands) {
  bool changed = let_go(hands);
  move_hands(hands);
  effort_.head(rows_) = touch_free_.head(rows_);
  effort_.head(rows_).noalias() += touch_slope() * driving;
  measure(driving);
  residual_ = distance();
  if (residual_ > kObeys && residual_ < kNear) follow_slip(driving);
  if (!(residual_ <= kObeys)) {
    ask_cone_solver();
    measure(driving);
    states_before_ = states_;
    read_states();
    changed = changed || states_ != states_before_;
    form();
    move_hands(hands);
    residual_ = distance();
  }
  if (changed) ++changes_;
  note_stored();
}

// Releases hands that are absent. Returns whether there were any.
bool TouchLaw::let_go(const VectorX& hands) {
  bool changed = false;
  for (int h = 0; h < hands_; ++h) {
    if (std::isfinite(hands[h]) || state(h) == Touch::apart) continue;
    state(h) = Touch::apart;
    changed = true;
  }
  if (changed) form();
  return changed;
}

// Follows sliding points as they turn, as long as no other state changes.
void TouchLaw::follow_slip(const VectorX& driving) {
  for (int k = 0; k < kTurns && residual_ > kObeys; ++k) {
    turn(driving);
    residual_ = distance();
  }
  if (!(residual_ <= kObeys)) return;
  if (has_turned()) {
    form();
    move_hands(places_);
  }
  shift(driving);
}

// A Newton step with the present factors of S: friction is turned against the motion, and all other
// efforts follow.
void TouchLaw::turn(const VectorX& driving) {
  ++turns_;
  change_.head(rows_).setZero();
  for (int k = 0; k < snapshot_->contacts(); ++k) {
    if (!rubs(k)) continue;
    const int row = contact_row(k);
    const Eigen::Vector2d along = motion_.segment<2>(row + 1).normalized();
    change_.segment<2>(row + 1) = effort_.segment<2>(row + 1) + friction(k) * effort_[row] * along;
  }
  factor_.solve(change_.head(rows_));
  effort_.head(rows_) -= change_.head(rows_);
  measure(driving);
}

// Shifts r_0 so that r_0 + R d passes through the solution, which S of earlier directions misses.
void TouchLaw::shift(const VectorX& driving) {
  change_.head(rows_) = effort_.head(rows_) - touch_free_.head(rows_);
  change_.head(rows_).noalias() -= touch_slope() * driving;
  touch_free_.head(rows_) += change_.head(rows_);
  free_.noalias() += w().block(0, first_, first_, rows_) * change_.head(rows_);
}

// Whether the directions in S differ from those in which points slide; if so, updates them.
bool TouchLaw::has_turned() {
  bool turned = false;
  for (int k = 0; k < snapshot_->contacts(); ++k) {
    if (!rubs(k)) continue;
    const Eigen::Vector2d along = motion_.segment<2>(contact_row(k) + 1).normalized();
    turned = turned || (along - slips_[static_cast<std::size_t>(k)].along).norm() > kTurned;
  }
  for (int k = 0; turned && k < snapshot_->contacts(); ++k) {
    if (rubs(k)) read_slip(k, motion_.segment<2>(contact_row(k) + 1).normalized());
  }
  return turned;
}

// Distance from the laws, relative to the largest effort; see qp::ConeResult::residual.
double TouchLaw::distance() const {
  if (!effort_.head(rows_).allFinite() || !motion_.head(rows_).allFinite()) return kInfinity;
  double farthest = 0.0, largest = 0.0;
  for (int h = 0; h < hands_; ++h) {
    const double root = std::sqrt(w()(first_ + h, first_ + h));
    farthest = std::max(farthest, hand_distance(h) * root);
    largest = std::max(largest, std::abs(effort_[h]) * root);
  }
  for (int k = 0; k < snapshot_->contacts(); ++k) {
    const int row = contact_row(k);
    const double root = std::sqrt(w().diagonal().segment<3>(first_ + row).sum() / 3.0);
    farthest = std::max(farthest, contact_distance(k) * root);
    largest = std::max(largest, effort_.segment<3>(row).norm() * root);
  }
  // If nothing touches, the distance is relative to the efforts that would make the present
  // motions.
  for (int row = 0; row < rows_; ++row) {
    const double place = row < hands_ && std::isfinite(places_[row]) ? places_[row] : 0.0;
    const double way = std::abs(offset_[row]) + std::abs(place);
    largest = std::max(largest, kRounding * way / std::sqrt(w()(first_ + row, first_ + row)));
  }
  return largest > 0.0 ? farthest / largest : 0.0;
}

double TouchLaw::hand_distance(int h) const {
  if (!std::isfinite(places_[h])) return std::abs(effort_[h]);
  const double pushed = (motion_[h] - places_[h]) / w()(first_ + h, first_ + h);
  return std::abs(effort_[h] - std::clamp(effort_[h] - pushed, hand(h).min, hand(h).max));
}

double TouchLaw::contact_distance(int contact) const {
  const int row = contact_row(contact);
  const double scale = w().diagonal().segment<3>(first_ + row).sum() / 3.0;
  const Vector3 effort = effort_.segment<3>(row), motion = motion_.segment<3>(row);
  if (friction(contact) == 0.0) {
    const double pushed = motion[0] / w()(first_ + row, first_ + row);
    return std::abs(effort[0] - std::max(effort[0] - pushed, 0.0)) + effort.tail<2>().norm();
  }
  return qp::cone_residual(effort, motion, friction(contact), scale);
}

void TouchLaw::ask_cone_solver() {
  ++cone_solutions_;
  boxes_.clear();
  cones_.clear();
  for (int h = 0; h < hands_; ++h) {
    const bool there = std::isfinite(places_[h]);
    const double least = there ? hand(h).min : 0.0, most = there ? hand(h).max : 0.0;
    boxes_.push_back({h, least, most, there ? places_[h] : 0.0});
    effort_[h] = std::isfinite(effort_[h]) ? std::clamp(effort_[h], least, most) : 0.0;
  }
  for (int k = 0; k < snapshot_->contacts(); ++k) {
    cones_.push_back({contact_row(k), friction(k)});
    Vector3 effort = effort_.segment<3>(contact_row(k));
    if (!effort.allFinite()) effort.setZero();
    effort_.segment<3>(contact_row(k)) = qp::project_on_cone(effort, friction(k));
  }
  cone_solver_.solve({w().block(first_, first_, rows_, rows_), offset_.head(rows_), boxes_, cones_},
                     {effort_.data(), static_cast<std::size_t>(rows_)});
}

void TouchLaw::read_states() {
  for (int h = 0; h < hands_; ++h) {
    const double effort = effort_[h];
    state(h) = effort == 0.0           ? Touch::apart
               : effort <= hand(h).min ? Touch::at_min
               : effort >= hand(h).max ? Touch::at_max
                                       : Touch::held;
    if (!std::isfinite(places_[h])) state(h) = Touch::apart;
  }
  for (int k = 0; k < snapshot_->contacts(); ++k) read_contact(k);
}

// Reads the state of a contact from its effort. A sliding point moves against its friction.
void TouchLaw::read_contact(int contact) {
  const Vector3 effort = effort_.segment<3>(contact_row(contact));
  Touch& touch = state(hands_ + contact);
  if (effort[0] <= 0.0) {
    touch = Touch::open;
  } else if (friction(contact) == 0.0) {
    touch = Touch::slip;
    slips_[static_cast<std::size_t>(contact)] = {};
  } else if (qp::slides(effort, friction(contact))) {
    touch = Touch::slip;
    read_slip(contact, -effort.tail<2>().normalized());
  } else {
    touch = Touch::stick;
  }
}

// Derivatives of r_t = -mu r_n u_t/|u_t|: -mu u_t/|u_t| with respect to r_n, and -mu r_n (1 - t
// t^T)/|u_t| with respect to u_t, t = u_t/|u_t|. A point that hardly moves turns at once, so the
// latter is limited.
void TouchLaw::read_slip(int contact, const Eigen::Vector2d& along) {
  const int row = contact_row(contact);
  const double own = w().diagonal().segment<2>(first_ + row + 1).sum() / 2.0;
  const double way = motion_.segment<2>(row + 1).norm();
  const double pull = friction(contact) * effort_[row];
  const double turning = std::min(pull / std::max(way, 1e-300), kSharp / own);
  slips_[static_cast<std::size_t>(contact)] = {
      along, turning * (Eigen::Matrix2d::Identity() - along * along.transpose())};
}

void TouchLaw::note_stored() {
  stored_ = 0.0;
  if (hands_ == 0) return;
  hand_work_ = touched_stiffness_;
  hand_force_ = effort_.head(hands_);
  for (int h = 0; h < hands_; ++h) {
    if (is_at_limit(h)) stored_ += effort_[h] * (places_[h] - motion_[h]);
    if (state(h) != Touch::apart) continue;
    hand_work_(h, h) = 1.0;
    hand_force_[h] = 0.0;
  }
  // K is positive definite on held hands: Gauss's elimination needs no pivots.
  for (int j = 0; j < hands_; ++j) {
    stored_ += 0.5 * hand_force_[j] * hand_force_[j] / hand_work_(j, j);
    for (int i = j + 1; i < hands_; ++i) {
      const double factor = hand_work_(i, j) / hand_work_(j, j);
      hand_force_[i] -= factor * hand_force_[j];
      hand_work_.row(i).tail(hands_ - j) -= factor * hand_work_.row(j).tail(hands_ - j);
    }
  }
}

}  // namespace sinew::high_rate
