#include "sinew/contact/contact_rows.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/constraint/surface_contact.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/model/model.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::contact {

namespace {

// Distances relative to the robot's size: surfaces of bodies get points within the first, and
// points within the second are active at once. The other points are checked when a motion is
// proposed: more rows from the start cost more than another solution (docs/performance.md).
constexpr double kNear = 0.01, kTaken = 0.002;
// Distance, relative to the robot's size, from which a controller closes contacts between surfaces.
constexpr double kWanted = 0.1;
// Surfaces of bodies get points within this multiple of their motion in a step.
constexpr double kAhead = 3.0;
// A stopped point was moving if it was faster than this fraction of the fastest point, and than
// this fraction of the robot's size per step.
constexpr double kStill = 1e-3, kNoMotion = 1e-9;
// Gaps up to this fraction of the robot's size are rounding.
constexpr double kTouching = 1e-9;
// A landing slower than this fraction is none: its jump of the velocity is smaller than the errors
// of the integrator.
constexpr double kGentle = 1e-5;
// Friction is static at points slower than this fraction of the fastest point.
constexpr double kStays = 1e-6;
// Rounds of a step in which overlapping surfaces get points, and of a solution of the law in which
// zones redistribute their forces.
constexpr int kMaxRounds = 20;

// Motions of a point's rows without its own force.
Vector3 free_motion(const law::StepProblem& problem, const linalg::AlignedNumbers& effort,
                    int problem_row) {
  const Eigen::Map<const VectorX, Eigen::AlignedMax> lambda(
      effort.data(), static_cast<Eigen::Index>(effort.size()));
  return problem.delta_free.segment<3>(problem_row) +
         problem.compliance.middleRows<3>(problem_row) * lambda -
         problem.compliance.block<3, 3>(problem_row, problem_row) * lambda.segment<3>(problem_row);
}

bool is_rigid(const model::Model& model, const constraint::Contact& contact) {
  const auto rigid = [&](int body) { return body < 0 || model.body(body).has_few_coordinates(); };
  return rigid(contact.body()) && rigid(contact.other_body());
}

}  // namespace

ContactRows::ContactRows(const model::Model& model, const constraint::Configuration& configuration,
                         std::span<mechanics::StepSystem* const> systems,
                         std::span<const char> afresh, mechanics::RowValues& rows, ThreadPool& pool)
    : model_(model),
      configuration_(configuration),
      systems_(systems),
      rows_(rows),
      planes_(model, configuration, rows, pool),
      touched_(static_cast<std::size_t>(model.rows().rows()), 0),
      pace_(touched_.size(), Pace::none),
      slid_(touched_),
      slides_(touched_),
      closed_(touched_) {
  afresh_ = afresh;
  auto touching = planes_.surfaces().begin();
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const model::ContactModel& contact = model.contacts()[i];
    strikes_.push_back(contact.strikes ? 1 : 0);
    wanted_.push_back(0);
    rigid_.push_back(is_rigid(model, *planes_.contacts()[i]) ? 1 : 0);
    const constraint::Friction& friction = planes_.contacts()[i]->friction();
    has_kinetic_ |= friction.sliding < friction.sticking;
    surfaces_.push_back(planes_.shape(i) == nullptr ? (touching++)->get() : nullptr);
    auto& zones = zones_.emplace_back();
    if (contact.aggregate == 0.0) continue;
    zones =
        std::make_unique<ContactZones>(*planes_.contacts()[i], contact.aggregate, configuration);
  }
  if (has_kinetic_) along_.resize(slides_.size(), Vector3::Zero());
}

bool ContactRows::has_zones() const {
  return std::ranges::any_of(zones_, [](const auto& zones) { return zones != nullptr; });
}

// Measures the gaps of the points that are in use.
template <class Gap>
void ContactRows::measure_gaps(const constraint::Contact& contact, Gap&& gap) {
  gaps_.assign(contact.size(), 0.0);
  for (std::size_t k = 0; k < contact.size(); ++k) {
    if (!contact.idle(k, rows_)) gaps_[k] = gap(k);
  }
}

// m: the gap at the end of the step, at the velocity of its start.
double ContactRows::arrival(const constraint::Contact& contact, std::size_t point,
                            double time_step) const {
  const int row = contact.row(point);
  const Vector3 velocity = contact.velocity_beside(configuration_, point, rows_);
  const double arrives =
      planes_.start()[row] + time_step * rows_.direction[contact.entry(point)].dot(velocity);
  return std::min(rows_.reference[row], arrives);
}

// Calls visit(contact, point) for every point of every contact.
template <class Visit>
void ContactRows::for_each_point(Visit&& visit) const {
  for (const constraint::Contact* contact : planes_.contacts()) {
    for (std::size_t k = 0; k < contact->size(); ++k) visit(*contact, k);
  }
}

// The same for contacts that strike, or for all others.
template <class Visit>
void ContactRows::for_each_point(bool striking, Visit&& visit) const {
  for (std::size_t i = 0; i < strikes_.size(); ++i) {
    if (strikes(i) != striking) continue;
    const constraint::Contact& contact = *planes_.contacts()[i];
    for (std::size_t k = 0; k < contact.size(); ++k) visit(contact, k);
  }
}

double ContactRows::reach(double reach) const { return std::max(kNear * model_.size(), reach); }

double ContactRows::ahead(double time_step) {
  return std::isfinite(time_step) ? kAhead * time_step : 0.0;
}

// Depends on the state alone, so a run continues from a saved state bit for bit.
void ContactRows::choose_active(std::span<const double> effort, double time_step, double reach) {
  left_out_ = false;
  rounds_left_ = kMaxRounds;
  if (has_zones()) rows_.groups.begin(rows_.active.size());
  const double near = std::max(kTaken * model_.size(), reach);
  for_each_point(true, [&](const constraint::Contact& contact, std::size_t k) {
    const int row = contact.row(k);
    set_active(row, is_closed(row));
    if (is_closed(row)) planes_.keep_gap(row);
  });
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    if (strikes(i)) continue;
    if (zones_[i]) {
      measure_gaps(contact, [&](std::size_t k) { return arrival(contact, k, time_step); });
      zones_[i]->begin(effort, gaps_, near, rows_);
      continue;
    }
    const bool always = !model_.body(contact.body()).leaves_rows_out();
    const int wanted = wanted_[i] != 0 ? nearest(contact, time_step) : -1;
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const int row = contact.row(k);
      if (contact.idle(k, rows_)) {
        set_active(row, false);
        continue;
      }
      const bool waits = surfaces_[i] != nullptr && surfaces_[i]->waits(k);
      const bool active = always || static_cast<int>(k) == wanted ||
                          effort[static_cast<std::size_t>(row)] > 0.0 ||
                          (!waits && arrival(contact, k, time_step) <= near);
      set_active(row, active);
      left_out_ |= !active;
    }
  }
  std::ranges::transform(effort, touched_.begin(), [](double r) { return r > 0.0 ? 1 : 0; });
  judge_sliding(effort, time_step);
  judge_moving(effort, time_step);
  let_normals_turn(effort);
}

// Only of points that touched when the step began. Bodies that start afresh make a step of backward
// Euler.
void ContactRows::let_normals_turn(std::span<const double> effort) {
  using enum mechanics::RollingPoint::Turning;
  if (planes_.turning() == fixed) return;
  const double touching = kTouching * model_.size();
  for (std::size_t i = 0; i < strikes_.size(); ++i) {
    const constraint::ShapeContact* contact = planes_.shape(i);
    if (contact == nullptr || !contact->own()) continue;
    const auto turning = starts_afresh(*contact) ? mean : planes_.turning();
    for (std::size_t k = 0; k < contact->size(); ++k) {
      if (contact->idle(k, rows_)) continue;
      const int row = contact->row(k);
      const bool touches =
          effort[static_cast<std::size_t>(row)] > 0.0 || std::abs(rows_.reference[row]) <= touching;
      if (strikes(i) ? is_closed(row) : touches) contact->let_turn(k, turning, rows_);
    }
  }
}

bool ContactRows::starts_afresh(const constraint::Contact& contact) const {
  const auto starts = [&](int body) {
    return body >= 0 && afresh_[static_cast<std::size_t>(body)] != 0;
  };
  return starts(contact.body()) || starts(contact.other_body());
}

// The normal velocity of a persistent contact point is zero up to an error of second order. A point
// with a force and a normal velocity landed in the last step or passes an edge. Points that are
// found while the step is solved land in it. A point that stuck in the last step does not slide,
// although a step of backward Euler leaves it a velocity where the other surface turns.
void ContactRows::judge_moving(std::span<const double> effort, double time_step) {
  if (mechanics::history_count(model_.step().integrator) == 0) return;
  const double still = speed_at_rest(kStill, time_step);
  const double gentle = speed_at_rest(kGentle, time_step);
  for (std::size_t i = 0; i < strikes_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      pace_[row] = Pace::fast;
      slid_[row] = 1;
      if (contact.idle(k, rows_)) continue;
      const Vector3 velocity =
          contact.frame(k, rows_).transpose() * planes_.velocity_beside(contact, k);
      const double parting = touched_[row] != 0 ? turning_speed(i, k, time_step) : 0.0;
      pace_[row] = pace_of(velocity[0], parting, still, gentle);
      const bool stuck =
          effort[row] > 0.0 && !contact.friction().slides(Vector3::Map(effort.data() + row));
      slid_[row] = !stuck && velocity.tail<2>().norm() > still ? 1 : 0;
    }
  }
}

// @param parting m/s, a velocity away from the surface that is no impact. Generalized-alpha, which
// is not damped as BDF2 is, turns its sign from step to step until it has decayed.
ContactRows::Pace ContactRows::pace_of(double velocity, double parting, double still,
                                       double gentle) const {
  const bool alpha = model_.step().integrator == mechanics::Integrator::generalized_alpha;
  const double closing = alpha ? parting : 0.0;
  if (velocity < -still - closing || velocity > still + parting) return Pace::fast;
  return std::abs(velocity) > gentle ? Pace::gentle : Pace::none;
}

// m/s: the velocity along its normal with which a pressed point of a round body may end a step of
// backward Euler without an impact. Its velocity is that along the chord of its path: where the
// normal turns at the rate w, and the velocity along the surface is v, it points away by w v h/2.
double ContactRows::turning_speed(std::size_t number, std::size_t point, double time_step) const {
  const constraint::ShapeContact* contact = planes_.shape(number);
  if (contact == nullptr || !contact->own()) return 0.0;
  return time_step * contact->turning_speed(configuration_, point, rows_);
}

void ContactRows::require_active(std::span<const int> contacts) {
  std::ranges::fill(wanted_, 0);
  for (const int contact : contacts) wanted_[static_cast<std::size_t>(contact)] = 1;
}

double ContactRows::wanted_reach(std::span<const double> effort) const {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    if (wanted_[i] == 0 || surfaces_[i] == nullptr) continue;
    const constraint::Contact& contact = *planes_.contacts()[i];
    bool pressed = false;
    for (std::size_t k = 0; k < contact.size() && !pressed; ++k) {
      pressed = effort[static_cast<std::size_t>(contact.row(k))] > 0.0;
    }
    if (!pressed) return kWanted * model_.size();
  }
  return 0.0;
}

int ContactRows::nearest(const constraint::Contact& contact, double time_step) const {
  int found = -1;
  double least = kInfinity;
  for (std::size_t k = 0; k < contact.size(); ++k) {
    if (contact.idle(k, rows_)) continue;
    const double gap = arrival(contact, k, time_step);
    if (gap >= least) continue;
    least = gap;
    found = static_cast<int>(k);
  }
  return found;
}

double ContactRows::friction(const constraint::Contact& contact, std::size_t point) const {
  const bool slides = slides_[static_cast<std::size_t>(contact.row(point))] != 0;
  return slides ? contact.friction().sliding : contact.friction().sticking;
}

// Judges by velocity and force together, since either may mislead: redundant sticking points share
// friction arbitrarily, up to their limits, and a rolling ball has a small velocity. In
// quasi-statics, by force alone.
void ContactRows::judge_sliding(std::span<const double> effort, double time_step) {
  if (!has_kinetic_) return;
  still_ = std::isfinite(time_step) ? speed_at_rest(kStays, time_step) : kInfinity;
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    judge_sliding(contact, k, effort);
  });
}

void ContactRows::judge_sliding(const constraint::Contact& contact, std::size_t point,
                                std::span<const double> effort) {
  const auto row = static_cast<std::size_t>(contact.row(point));
  slides_[row] = 0;
  const bool pressed = !effort.empty() && effort[row] > 0.0;
  if (!pressed && (still_ == kInfinity || contact.idle(point, rows_))) return;
  const auto tangents = contact.frame(point, rows_).rightCols<2>().eval();
  const Vector3 force = pressed ? Vector3::Map(&effort[row]) : Vector3(Vector3::Zero());
  const Eigen::Vector2d velocity = tangents.transpose() * planes_.velocity_beside(contact, point);
  const bool moves = still_ == kInfinity || velocity.norm() > still_;
  slides_[row] = moves && (!pressed || contact.friction().slides(force)) ? 1 : 0;
  along_[row] = tangents * (pressed ? Eigen::Vector2d(-force.tail<2>()) : velocity);
}

// Friction opposes the motion: a point whose friction acts along its previous direction has turned
// back.
bool ContactRows::hold_reversed(const RowNumbering& numbering,
                                const linalg::AlignedNumbers& effort) {
  bool found = false;
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    const int row = contact.row(k), problem_row = numbering.problem_row_of(row);
    char& slides = slides_[static_cast<std::size_t>(row)];
    if (slides == 0 || problem_row < 0) return;
    const Eigen::Map<const Vector3> force(&effort[static_cast<std::size_t>(problem_row)]);
    const Vector3 friction = contact.frame(k, rows_).rightCols<2>() * force.tail<2>();
    if (!(friction.dot(along_[static_cast<std::size_t>(row)]) > 0.0)) return;
    slides = 0;
    found = true;
  });
  return found;
}

void ContactRows::spread_forces(std::span<double> effort) const {
  for (const auto& zones : zones_) {
    if (zones) zones->spread(effort, rows_);
  }
}

void ContactRows::take_all() {
  left_out_ = false;
  rows_.groups.clear();
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    set_active(contact.row(k), !contact.idle(k, rows_));
  });
}

void ContactRows::take_closed() {
  left_out_ = false;
  rows_.groups.clear();
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    set_active(contact.row(k), is_closed(contact.row(k)));
  });
  if (!has_kinetic_) return;
  still_ = kStays * fastest_node();
  for_each_point(
      [&](const constraint::Contact& contact, std::size_t k) { judge_sliding(contact, k, {}); });
}

void ContactRows::set_active(int row, bool active) {
  std::fill_n(rows_.active.begin() + row, 3, static_cast<char>(active));
}

void ContactRows::list(const RowNumbering& numbering,
                       std::vector<law::ContactBlock>& blocks) const {
  for (std::size_t i = 0; i < planes_.contacts().size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const int row = contact.row(k), problem_row = numbering.problem_row_of(row);
      if (problem_row < 0 || !rows_.groups.leads(row)) continue;
      blocks.push_back({problem_row, friction(contact, k), static_cast<int>(i),
                        contact.frame(k, rows_), rigid_[i] != 0});
    }
  }
}

void ContactRows::begin_solution() { zone_rounds_left_ = kMaxRounds; }

bool ContactRows::correct(const law::StepProblem& problem, const RowNumbering& numbering,
                          const linalg::AlignedNumbers& effort) {
  bool found = false;
  for (std::size_t i = 0; i < planes_.contacts().size(); ++i) {
    if (planes_.shape(i) == nullptr || zones_[i]) continue;
    found = correct_shape(i, problem, numbering, effort) || found;
  }
  if (found) planes_.end_round();
  bool spread = false;
  for (std::size_t i = 0; i < planes_.contacts().size(); ++i) {
    if (zones_[i]) {
      spread = correct_zones(*zones_[i], surfaces_[i], problem, numbering, effort) || spread;
    } else if (is_searched(i)) {
      found = correct_surfaces(*surfaces_[i]) || found;
    }
  }
  if (spread) --zone_rounds_left_;
  if (has_kinetic_) found = hold_reversed(numbering, effort) || found;
  return found || spread;
}

bool ContactRows::find_points() {
  if (rounds_left_ <= kMaxRounds / 2) return false;
  bool found = false;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (is_searched(i)) found = correct_surfaces(*surfaces_[i]) || found;
  }
  return found;
}

bool ContactRows::may_find_points() const {
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (is_searched(i)) return true;
  }
  return false;
}

// (3,) m: position after the proposed motion.
Vector3 ContactRows::proposed_position(const constraint::ShapeContact& contact,
                                       std::size_t point) const {
  const auto motion = [&](const mechanics::Site& site) {
    return systems_[static_cast<std::size_t>(site.body)]->proposed_motion(site.number);
  };
  return contact.position_beside(configuration_, point, rows_) +
         contact.relative_motion(point, rows_, motion);
}

bool ContactRows::correct_zones(ContactZones& zones, TouchingSurfaces* touching,
                                const law::StepProblem& problem, const RowNumbering& numbering,
                                const linalg::AlignedNumbers& effort) {
  if (zone_rounds_left_ == 0) return false;
  if (touching != nullptr) {
    touching->propose(systems_);
    const std::size_t known = touching->count();
    touching->add_overlaps();
    for (std::size_t k = known; k < touching->count(); ++k) {
      planes_.begin_point(touching->contact().row(k));
    }
    measure_gaps(zones.contact(), [&](std::size_t k) { return touching->proposed_gap(k); });
  } else {
    const auto& contact = static_cast<const constraint::ShapeContact&>(zones.contact());
    measure_gaps(contact, [&](std::size_t k) {
      return contact.row_values(k, proposed_position(contact, k), rows_)[0];
    });
  }
  return zones.refine(gaps_, problem, numbering, effort, rows_);
}

bool ContactRows::correct_shape(std::size_t number, const law::StepProblem& problem,
                                const RowNumbering& numbering,
                                const linalg::AlignedNumbers& effort) {
  const constraint::ShapeContact& contact = *planes_.shape(number);
  const Eigen::Isometry3d pose = planes_.pose(number);
  const bool may_turn = contact.curved() && planes_.may_turn();
  bool found = false;
  for (std::size_t k = 0; k < contact.size(); ++k) {
    const int row = contact.row(k), problem_row = numbering.problem_row_of(row);
    if (rows_.active[static_cast<std::size_t>(row)] == 0) {
      found = (!strikes(number) && take_in(contact, k, pose)) || found;
    } else if (may_turn && effort[static_cast<std::size_t>(problem_row)] > 0.0) {
      found =
          planes_.follow_way(contact, k, free_motion(problem, effort, problem_row), pose) || found;
    }
  }
  return found;
}

// Activates an inactive point that moves into its surface. If it only crosses its plane beside the
// surface, it gets another plane instead. Returns whether it became active.
bool ContactRows::take_in(const constraint::ShapeContact& contact, std::size_t point,
                          const Eigen::Isometry3d& pose) {
  if (contact.idle(point, rows_)) return false;
  const Vector3 end = proposed_position(contact, point);
  if (contact.row_values(point, end, rows_)[0] >= 0.0) return false;
  if (contact.curved() && planes_.may_turn() && !planes_.turn_to(contact, point, end, pose)) {
    return false;
  }
  set_active(contact.row(point), true);
  return true;
}

// First activates points that were left out; if there are none, adds points for unexpected
// overlaps.
bool ContactRows::correct_surfaces(TouchingSurfaces& touching) {
  if (rounds_left_ == 0) return false;
  bool found = false;
  touching.propose(systems_);
  for (std::size_t k = 0; k < touching.count(); ++k) {
    const int row = touching.contact().row(k);
    if (rows_.active[static_cast<std::size_t>(row)] != 0) continue;
    if (!(touching.proposed_gap(k) < -touching.slack(k))) continue;
    set_active(row, true);
    found = true;
  }
  const std::size_t known = touching.count();
  if (!found && touching.add_overlaps()) {
    for (std::size_t k = known; k < touching.count(); ++k) {
      set_active(touching.contact().row(k), true);
      planes_.begin_point(touching.contact().row(k));
      if (has_kinetic_) judge_sliding(touching.contact(), k, {});
    }
    found = true;
  }
  if (found) --rounds_left_;
  return found;
}

bool ContactRows::gap_closed(std::span<const double> effort) const {
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    if (zones_[i] && zones_[i]->gap_closed(effort, rows_)) return true;
    if (zones_[i] || strikes(i)) continue;
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      if (effort[row] > 0.0 && touched_[row] == 0) return true;
    }
  }
  return false;
}

bool ContactRows::stops_touching_point(std::span<const double> effort) const {
  for (std::size_t row = 0; row < pace_.size(); ++row) {
    if (pace_[row] == Pace::fast && touched_[row] != 0 && effort[row] > 0.0) return true;
  }
  return false;
}

bool ContactRows::catches(std::span<const double> effort) const {
  bool found = false;
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    found = found || catches(contact, k, effort);
  });
  return found;
}

bool ContactRows::catches(const constraint::Contact& contact, std::size_t point,
                          std::span<const double> effort) const {
  const auto row = static_cast<std::size_t>(contact.row(point));
  const Vector3 force = Vector3::Map(effort.data() + row);
  if (slid_[row] == 0 || !(force[0] > 0.0)) return false;
  return contact.friction().sticking > 0.0 && !contact.friction().slides(force);
}

void ContactRows::mark(const constraint::Contact& contact, std::span<char> bodies) {
  for (const int body : {contact.body(), contact.other_body()}) {
    if (body >= 0) bodies[static_cast<std::size_t>(body)] = 1;
  }
}

void ContactRows::mark_impacts(std::span<const double> effort, std::span<char> bodies) const {
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    if (zones_[i]) {
      if (zones_[i]->gap_closed(effort, rows_)) mark(contact, bodies);
      continue;
    }
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      if (!(effort[row] > 0.0)) continue;
      const bool lands = touched_[row] == 0 && pace_[row] >= Pace::gentle;
      const bool goes_on = touched_[row] != 0 && pace_[row] == Pace::fast;
      if (lands || goes_on) mark(contact, bodies);
    }
  }
}

void ContactRows::mark_stopped(std::span<const double> effort, std::span<char> bodies) const {
  for (std::size_t i = 0; i < strikes_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      if (!(effort[row] > 0.0)) continue;
      const bool stops = pace_[row] == Pace::fast;
      if (stops || catches(contact, k, effort)) mark(contact, bodies);
    }
  }
}

void ContactRows::mark_loose(std::span<const double> effort, std::span<char> bodies) const {
  if (!has_kinetic_) return;
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    const constraint::Friction& friction = contact.friction();
    const Vector3 force = Vector3::Map(effort.data() + contact.row(k));
    const bool loose = friction.sliding < friction.sticking && force[0] > 0.0 &&
                       qp::slides(force, friction.sticking);
    if (loose) mark(contact, bodies);
  });
}

void ContactRows::mark_turning_back(const law::StepProblem& problem, const RowNumbering& numbering,
                                    const linalg::AlignedNumbers& effort, double time_step,
                                    std::span<char> bodies) const {
  if (!has_kinetic_) return;
  const Eigen::Map<const VectorX, Eigen::AlignedMax> lambda(
      effort.data(), static_cast<Eigen::Index>(effort.size()));
  for_each_point([&](const constraint::Contact& contact, std::size_t k) {
    const int row = contact.row(k), problem_row = numbering.problem_row_of(row);
    if (problem_row < 0 || slides_[static_cast<std::size_t>(row)] == 0) return;
    if (!(lambda[problem_row] > 0.0)) return;
    const Vector3 velocity =
        contact.frame(k, rows_).transpose() * planes_.velocity_beside(contact, k);
    const Eigen::Vector2d way = problem.delta_free.segment<2>(problem_row + 1) +
                                problem.compliance.middleRows<2>(problem_row + 1) * lambda;
    if (way.dot(velocity.tail<2>()) < 0.5 * time_step * velocity.tail<2>().squaredNorm()) {
      mark(contact, bodies);
    }
  });
}

// m/s, of the points of all contacts and of the bodies there: the point of a rolling ball rests.
double ContactRows::fastest_node() const {
  double fastest = 0.0;
  for (const constraint::Contact* contact : planes_.contacts()) {
    for (std::size_t k = 0; k < contact->size(); ++k) {
      if (contact->idle(k, rows_)) continue;
      fastest = std::max({fastest, planes_.velocity_beside(*contact, k).norm(),
                          planes_.centre_velocity_beside(*contact, k).norm()});
    }
  }
  return fastest;
}

// m/s: slower points are at rest.
double ContactRows::speed_at_rest(double fraction, double time_step) const {
  return std::max(fraction * fastest_node(), kNoMotion * model_.size() / time_step);
}

bool ContactRows::touches_softly(std::span<const double> effort) const {
  bool touches = false;
  for_each_point(false, [&](const constraint::Contact& contact, std::size_t k) {
    touches = touches || effort[static_cast<std::size_t>(contact.row(k))] > 0.0;
  });
  return touches;
}

double ContactRows::end_zones(const law::StepProblem& problem, const RowNumbering& numbering,
                              std::span<const double> effort) {
  ContactZones::ForceError sum;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    if (!zones_[i]) continue;
    const constraint::Contact& contact = *planes_.contacts()[i];
    friction_.resize(contact.size());
    for (std::size_t k = 0; k < contact.size(); ++k) friction_[k] = friction(contact, k);
    const auto own = zones_[i]->end_step(problem, numbering, effort, friction_, rows_);
    sum.change += own.change;
    sum.force += own.force;
  }
  return sum.force > 0.0 ? sum.change / sum.force : 0.0;
}

void ContactRows::forget_friction() {
  for (const auto& zones : zones_) {
    if (zones) zones->forget_friction();
  }
}

bool ContactRows::passed() const {
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (surfaces_[i] != nullptr && !strikes(i) && surfaces_[i]->passed()) return true;
  }
  return false;
}

double ContactRows::max_penetration_without_force(std::span<const double> effort) const {
  double deepest = 0.0;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    const double left = zones_[i] ? zones_[i]->tolerance() : 0.0;
    for (std::size_t k = 0; k < contact.size(); ++k) {
      if (effort[static_cast<std::size_t>(contact.row(k))] > 0.0) continue;
      if (contact.idle(k, rows_)) continue;
      deepest = std::max(deepest, -contact.linear_gap(configuration_, k, rows_) - left);
    }
  }
  return deepest;
}

double ContactRows::max_penetration_left_out() const {
  double deepest = 0.0;
  for (std::size_t i = 0; i < zones_.size() && !rows_.groups.empty(); ++i) {
    if (zones_[i] && !strikes(i)) deepest = std::max(deepest, zones_[i]->excess(rows_));
  }
  if (!left_out_) return deepest;
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const constraint::Contact& contact = *planes_.contacts()[i];
    if (zones_[i] || strikes(i)) continue;
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const int row = contact.row(k);
      if (rows_.active[static_cast<std::size_t>(row)] != 0) continue;
      const double slack = surfaces_[i] != nullptr ? surfaces_[i]->slack(k) : 0.0;
      deepest = std::max(deepest, -rows_.delta[row] - slack);
    }
  }
  return deepest;
}

}  // namespace sinew::contact
