#include "sinew/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/linalg/positive_part.hpp"
#include "sinew/sim/stages.hpp"
#include "sinew/step/step_solver.hpp"

namespace sinew::sim {

namespace {

// Points whose gap is under this part of the robot's size take part in a step at once.
constexpr double kNear = 0.01;
// Tangent planes this near each other, of the robot's size, are the same.
constexpr double kSamePlane = 1e-6;
// Rounds of a step in which tangent planes follow the ways of their points.
constexpr int kMostTurns = 20;

std::vector<std::unique_ptr<mechanics::Body>> create_bodies(const Model& model, ThreadPool& pool) {
  std::vector<std::unique_ptr<mechanics::Body>> bodies;
  const bool curved = model.stiffening_widens();
  const int histories = mechanics::history_count(model.step().integrator);
  for (const auto& body : model.bodies()) bodies.push_back(body->create(pool, curved, histories));
  return bodies;
}

// Of all rows, those of the problem. @param rows of it.
void pick(const VectorX& all, const std::vector<int>& rows, VectorX& result) {
  result.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) result[static_cast<Eigen::Index>(k)] = all[rows[k]];
}

}  // namespace

World::World(std::shared_ptr<const Model> model, ThreadPool& pool)
    : model_(std::move(model)),
      bodies_(create_bodies(*model_, pool)),
      placement_(bodies_),
      curvatures_(model_->curvatures()) {
  rows_.resize(model_->rows());
  const int rows = model_->rows().rows();
  problem_.actuators.resize(model_->actuators().size());
  problem_.size = model_->size();
  for (const GuideModel& guide : model_->guides()) {
    problem_.capstans.push_back({guide.row, guide.actuator, 0.0, 0.0});
  }
  for (std::size_t w = 0; w < model_->welds().size(); ++w) {
    const constraint::Tie& tie = model_->weld(static_cast<int>(w));
    for (int row = tie.first_row(); row < tie.first_row() + tie.row_count(); ++row) {
      problem_.bilaterals.push_back({row});
    }
  }
  for (const AnchorModel& anchor : model_->anchors()) {
    const int row = model_->constraints()[static_cast<std::size_t>(anchor.constraint)]->first_row();
    for (int axis = 0; axis < 3; ++axis) problem_.stiffness.push_back({row + axis});
  }
  anchor_rows_ = problem_.stiffness.size();
  for (const CouplingModel& coupling : model_->couplings()) {
    const int row =
        model_->constraints()[static_cast<std::size_t>(coupling.constraint)]->first_row();
    for (int k = 0; k < 2; ++k) problem_.stiffness.push_back({row + k});
  }
  contact_start_.setZero(rows);
  number_rows();
  touched_.assign(static_cast<std::size_t>(rows), 0);
  curving_effort_.resize(static_cast<std::size_t>(rows));
  place_contacts(0.0, 0.0);
}

// Before bodies follow their bases: what they are carried by counts as motion along the surface.
void World::place_contacts(double from, double to) {
  end_ = to;
  turns_left_ = kMostTurns;
  curved_ = false;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const ContactModel& model = model_->contacts()[i];
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    curved_ |= contact.curved();
    contact.begin_step(placement_, model.pose(from), model.pose(to), to - from, rows_);
  }
  contact_start_ = measure_delta();
}

void World::begin_step(double from, double to, std::span<const double> effort) {
  if (!model_->contacts().empty()) {
    place_contacts(from, to);
    choose_present(effort, to - from);
    std::ranges::transform(effort, touched_.begin(), [](double r) { return r > 0.0 ? 1 : 0; });
    number_rows();
  }
  for (auto& body : bodies_) body->begin_step();
}

void World::begin_query(double at) {
  if (!model_->contacts().empty()) {
    place_contacts(at, at);
    left_out_ = false;
    std::ranges::fill(rows_.present, static_cast<char>(true));
    number_rows();
  }
  for (auto& body : bodies_) body->begin_query();
}

// A guess, and a function of the state alone so that a run goes on from a saved one bit for bit:
// points that touched, are near, or would arrive at their speed. correct_contacts() makes good
// what it misses.
void World::choose_present(std::span<const double> effort, double time_step) {
  left_out_ = false;
  const double near = kNear * model_->size();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const mechanics::MaterialPoint& point = contact.points()[k];
      const mechanics::Body& body = *bodies_[static_cast<std::size_t>(point.body)];
      const int row = contact.row(k);
      const double arrives =
          contact_start_[row] +
          time_step * rows_.direction[contact.entry(k)].dot(body.velocity(point.point));
      const bool present = !body.model().leaves_rows_out() ||
                           effort[static_cast<std::size_t>(row)] > 0.0 ||
                           std::min(rows_.reference[row], arrives) <= near;
      set_present(contact, k, present);
      left_out_ |= !present;
    }
  }
}

void World::set_present(const constraint::Contact& contact, std::size_t point, bool present) {
  std::fill_n(rows_.present.begin() + contact.row(point), 3, static_cast<char>(present));
}

bool World::correct_contacts(std::span<const double> effort) {
  bool found = false;
  const bool may_turn = turns_left_ > 0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    const Eigen::Isometry3d pose = model_->contacts()[i].pose(end_);
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      if (rows_.present[row] == 0) {
        found = take_in(contact, k, pose) || found;
      } else if (may_turn && contact.curved() && effort[row] > 0.0) {
        found = follow_way(contact, k, pose) || found;
      }
    }
  }
  if (!found) return false;
  --turns_left_;
  number_rows();
  for (auto& body : bodies_) body->retake_rows(rows_);
  form_compliance();
  return true;
}

// Whether a point that was left out moves into its surface. A plane that it merely crosses beside
// the surface is replaced by one that it does not.
bool World::take_in(const constraint::Contact& contact, std::size_t point,
                    const Eigen::Isometry3d& pose) {
  const mechanics::MaterialPoint& of = contact.points()[point];
  const mechanics::Body& body = *bodies_[static_cast<std::size_t>(of.body)];
  const Vector3 end = placement_.position(of) + body.proposed_motion(of.point);
  if (contact.row_values(point, end, rows_)[0] >= 0.0) return false;
  if (contact.curved() && turns_left_ > 0) {
    const Vector3 reference = rows_.reference.segment<3>(contact.row(point));
    const auto plane = contact.approach(contact.position(point, reference, rows_), end, pose);
    turn(contact, point, plane);
    if (!plane.meets) return false;
  }
  set_present(contact, point, true);
  return true;
}

// Whether a pushed point's plane is another than that of its way, which it then gets. Where the way
// meets the surface, planes that find it equally deep in the end are one.
bool World::follow_way(const constraint::Contact& contact, std::size_t point,
                       const Eigen::Isometry3d& pose) {
  const int row = contact.row(point), place = place_[static_cast<std::size_t>(row)];
  const Eigen::Map<const VectorX, Eigen::AlignedMax> lambda(
      problem_effort_.data(), static_cast<Eigen::Index>(problem_effort_.size()));
  const Vector3 free = problem_.delta_free.segment<3>(place) +
                       problem_.compliance.middleRows<3>(place) * lambda -
                       problem_.compliance.block<3, 3>(place, place) * lambda.segment<3>(place);
  const Vector3 reference = rows_.reference.segment<3>(row);
  const Vector3 from = contact.position(point, reference, rows_);
  const Vector3 to = contact.position(point, free, rows_);
  const auto plane = contact.approach(from, to, pose);
  const double gap = plane.distance.gap + plane.distance.normal.dot(to - plane.at);
  if (plane.meets && std::abs(gap - free[0]) <= kSamePlane * model_->size()) return false;
  turn(contact, point, plane);
  return true;
}

void World::turn(const constraint::Contact& contact, std::size_t point,
                 const constraint::SurfaceApproach& plane) {
  const int row = contact.row(point);
  const auto position = [&](const VectorX& rows) {
    return contact.position(point, rows.segment<3>(row), rows_);
  };
  const Vector3 start = position(contact_start_), carried = position(rows_.reference);
  const Vector3 now = placement_.position(contact.points()[point]);
  contact.place(point, carried, plane, rows_);
  contact_start_.segment<3>(row) = contact.row_values(point, start, rows_);
  rows_.delta.segment<3>(row) = contact.row_values(point, now, rows_);
}

bool World::gap_closed(std::span<const double> effort) const {
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const auto row = static_cast<std::size_t>(contact.row(k));
      if (effort[row] > 0.0 && touched_[row] == 0) return true;
    }
  }
  return false;
}

double World::contact_drift(std::span<const double> effort, double time) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    const Eigen::Isometry3d pose = model_->contacts()[i].pose(time);
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      if (effort[static_cast<std::size_t>(contact.row(k))] == 0.0) continue;
      const double gap = contact.distance_now(placement_, pose, k).gap;
      worst = std::max(worst, std::abs(gap - rows_.delta[contact.row(k)]));
    }
  }
  return worst;
}

double World::deepest_free_point(std::span<const double> effort) const {
  double deepest = 0.0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const int row = contact.row(k);
      if (effort[static_cast<std::size_t>(row)] > 0.0) continue;
      const double gap = rows_.offset[row] + rows_.direction[contact.entry(k)].dot(
                                                 placement_.position(contact.points()[k]));
      deepest = std::max(deepest, -gap);
    }
  }
  return deepest;
}

void World::linearise(const mechanics::LinearisationRequest& request) {
  tangent_ = request.tangent;
  // Inertia holds a body by itself.
  for (std::size_t k = 0; k < anchor_rows_; ++k) {
    problem_.stiffness[k].stiffness =
        request.weights.dynamic() ? 0.0 : -model_->anchors()[k / 3].stiffness;
  }
  for (auto& body : bodies_) body->linearise(request);
}

const VectorX& World::measure_delta() {
  for (const auto& constraint : model_->constraints()) constraint->linearise(placement_, rows_);
  return rows_.delta;
}

void World::form_rows(std::span<const double> effort, std::span<const int> curved) {
  pick(measure_delta(), row_of_, problem_.delta);
  for (std::size_t k = 0; k < problem_.capstans.size(); ++k) {
    const GuideModel& guide = model_->guides()[k];
    const double turn = model_->cable(guide.actuator)->turn(placement_, guide.via);
    problem_.capstans[k].grip = -std::expm1(-guide.friction * turn);
  }
  for (auto& body : bodies_) body->take_rows(rows_);
  curving_ = curved;
  if (!curved.empty()) std::ranges::copy(effort, curving_effort_.begin());
}

void World::add_curvatures() {
  majorant_ = false;
  for (std::size_t k = anchor_rows_; k < problem_.stiffness.size(); ++k) {
    problem_.stiffness[k].stiffness = 0.0;
  }
  const std::span<const double> effort(curving_effort_);
  for (const int index : curving_) {
    const auto& constraint = *model_->constraints()[static_cast<std::size_t>(index)];
    const std::span<mechanics::RowCurvature> pairs(
        curvatures_.data() + constraint.first_curvature(),
        static_cast<std::size_t>(constraint.curvature_count()));
    const auto own = effort.subspan(static_cast<std::size_t>(constraint.first_row()),
                                    static_cast<std::size_t>(constraint.row_count()));
    if (std::ranges::all_of(own, [](double lambda) { return lambda == 0.0; })) continue;
    constraint.curve(placement_, effort, pairs);
    const bool exact = tangent_ == mechanics::Tangent::exact || constraint.stiffens(effort);
    for (const auto& pair : pairs) {
      if (exact && pair.first.body == pair.second.body) {
        bodies_[static_cast<std::size_t>(pair.first.body)]->add_curvature(pair);
      } else if (exact) {
        couple(pair);
      } else {
        majorant_ = true;
        add_majorant(pair);
      }
    }
  }
  curving_ = {};
}

// A piece of a cable between two bodies: its C = T/l (I - n n^T), which the pairs of either point
// with itself have added to the bodies, becomes a spring T/l along the rows of its coupling.
void World::couple(const mechanics::RowCurvature& pair) {
  for (const mechanics::MaterialPoint& point : {pair.first, pair.second}) {
    bodies_[static_cast<std::size_t>(point.body)]->add_curvature({point, point, pair.curvature});
  }
  const auto index = static_cast<int>(&pair - curvatures_.data());
  const auto& couplings = model_->couplings();
  const auto found = std::ranges::find(couplings, index, &CouplingModel::curvature);
  const auto first = anchor_rows_ + 2 * static_cast<std::size_t>(found - couplings.begin());
  for (std::size_t k = first; k < first + 2; ++k) {
    problem_.stiffness[k].stiffness = 0.5 * pair.curvature.trace();
  }
}

// A pair (x_i, x_j) with block C puts -C at (i, j) and -C^T at (j, i) into A. What is never less:
// |C| I at (i, i) and (j, j), see FemBody::add_majorant; a pair of one point gives its positive
// part. All stays on points' own blocks.
void World::add_majorant(const mechanics::RowCurvature& pair) {
  const auto add = [&](const mechanics::MaterialPoint& point, const Matrix3& stiffness) {
    bodies_[static_cast<std::size_t>(point.body)]->add_curvature({point, point, -stiffness});
  };
  if (pair.first == pair.second) return add(pair.first, linalg::positive_part(-pair.curvature));
  const Matrix3 bound = pair.curvature.norm() * Matrix3::Identity();
  add(pair.first, bound);
  add(pair.second, bound);
}

void World::add_anchors() {
  for (std::size_t k = 0; k < anchor_rows_; k += 3) {
    const auto& [row, stiffness] = problem_.stiffness[k];
    if (stiffness == 0.0) continue;
    const auto entry = model_->rows().row_start[static_cast<std::size_t>(row)];
    const mechanics::MaterialPoint point = model_->rows().point[static_cast<std::size_t>(entry)];
    bodies_[static_cast<std::size_t>(point.body)]->add_curvature(
        {point, point, stiffness * Matrix3::Identity()});
  }
}

void World::hold_capstans(const VectorX& delta) {
  for (step::CapstanBlock& block : problem_.capstans) block.held = delta[block.row];
}

double World::residual(std::span<const double> effort) {
  double sum = 0.0;
  for (auto& body : bodies_) {
    const double part = body->residual(effort);
    sum += part * part;
  }
  return std::sqrt(sum);
}

double World::force_scale() const {
  double scale = 0.0;
  for (const auto& body : bodies_) scale += body->force_scale();
  return scale;
}

double World::rounding_floor() const {
  double sum = 0.0;
  for (const auto& body : bodies_) {
    const double part = body->rounding_floor();
    sum += part * part;
  }
  return std::sqrt(sum);
}

void World::hold_imbalance(std::span<const double> effort) {
  for (auto& body : bodies_) body->hold_imbalance(effort);
}

void World::set_imbalance_share(double share) {
  for (auto& body : bodies_) body->set_imbalance_share(share);
}

int World::negative_pivots() const {
  int sum = 0;
  for (const auto& body : bodies_) sum += body->negative_pivots();
  return sum;
}

bool World::is_unsymmetric() const {
  return std::ranges::any_of(bodies_, [](const auto& body) { return body->is_unsymmetric(); });
}

bool World::is_stable(linalg::FactorStatus status) const {
  if (status == linalg::FactorStatus::singular) return false;
  const bool has_less = std::ranges::any_of(
      problem_.stiffness, [](const step::StiffnessBlock& block) { return block.stiffness < 0.0; });
  if (status == linalg::FactorStatus::positive_definite && !has_less) return true;
  return step::stabilised(problem_, negative_pivots());
}

linalg::FactorStatus World::condense() {
  add_curvatures();
  add_anchors();
  auto worst = linalg::FactorStatus::positive_definite;
  for (auto& body : bodies_) worst = std::max(worst, body->condense());
  if (worst != linalg::FactorStatus::singular) form_compliance();
  return worst;
}

step::LawStatus World::solve_step(step::StepSolver& solver, step::Controller* controller,
                                  std::span<double> effort, StageClock& clock) {
  effort_before_.assign(effort.begin(), effort.end());
  step::LawStatus status = step::LawStatus::solved;
  bool mended = true;
  while (mended) {
    gather(effort_before_, problem_.effort_before);
    gather(effort, problem_effort_);
    status = solver.solve(problem_, controller, problem_effort_);
    clock.mark(Stage::law);
    if (status == step::LawStatus::failed) return status;
    std::ranges::fill(effort, 0.0);
    for (std::size_t k = 0; k < row_of_.size(); ++k) {
      effort[static_cast<std::size_t>(row_of_[k])] = problem_effort_[k];
    }
    for (auto& body : bodies_) body->solve_motion(effort);
    mended = guesses_contacts() && correct_contacts(effort);
    clock.mark(Stage::correction);
  }
  for (const step::StiffnessBlock& block : problem_.stiffness) {
    effort[static_cast<std::size_t>(block.row)] = 0.0;  // part of no equilibrium
  }
  return status;
}

linalg::AlignedNumbers World::gather(std::span<const double> effort) const {
  linalg::AlignedNumbers result;
  gather(effort, result);
  return result;
}

void World::gather(std::span<const double> effort, linalg::AlignedNumbers& result) const {
  result.clear();
  for (const int row : row_of_) result.push_back(effort[static_cast<std::size_t>(row)]);
}

double World::violation(std::span<const double> effort) {
  gather(effort, scratch_);
  double worst = step::violation(problem_, scratch_);
  if (!left_out_) return worst;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const int row = contact.row(k);
      if (place_[static_cast<std::size_t>(row)] < 0) worst = std::max(worst, -rows_.delta[row]);
    }
  }
  return worst;
}

// The problem's rows and its contacts: points that are left out have none.
void World::number_rows() {
  row_of_.clear();
  place_.assign(rows_.present.size(), -1);
  for (std::size_t row = 0; row < place_.size(); ++row) {
    if (rows_.present[row] == 0) continue;
    place_[row] = static_cast<int>(row_of_.size());
    row_of_.push_back(static_cast<int>(row));
  }
  problem_.contacts.clear();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const int place = place_[static_cast<std::size_t>(contact.row(k))];
      if (place >= 0) problem_.contacts.push_back({place, contact.friction()});
    }
  }
  pick(rows_.delta, row_of_, problem_.delta);
}

void World::form_compliance() {
  pick(rows_.delta, row_of_, problem_.delta_free);
  problem_.compliance.setZero(problem_.delta_free.size(), problem_.delta_free.size());
  for (auto& body : bodies_) {
    body->add_compliance(place_, problem_.compliance, problem_.delta_free);
  }
}

void World::imbalance(std::span<const double> effort, VectorX& result) {
  std::size_t size = 0;
  for (const auto& body : bodies_) size += body->motion_size();
  result.resize(static_cast<Eigen::Index>(size));
  std::span<double> rest(result.data(), size);
  for (const auto& body : bodies_) {
    body->imbalance(effort, rest.first(body->motion_size()));
    rest = rest.subspan(body->motion_size());
  }
}

void World::solve(const VectorX& right, VectorX& result) {
  result.resize(right.size());
  std::span<const double> from(right.data(), static_cast<std::size_t>(right.size()));
  std::span<double> to(result.data(), from.size());
  for (const auto& body : bodies_) {
    body->solve(from.first(body->motion_size()), to.first(body->motion_size()));
    from = from.subspan(body->motion_size());
    to = to.subspan(body->motion_size());
  }
}

void World::propose_motion(const VectorX& motion) {
  std::span<const double> rest(motion.data(), static_cast<std::size_t>(motion.size()));
  for (const auto& body : bodies_) {
    body->propose_motion(rest.first(body->motion_size()));
    rest = rest.subspan(body->motion_size());
  }
}

void World::drift(double time_step) {
  for (auto& body : bodies_) body->propose_drift(time_step);
  if (!apply_motion(1.0).finite || !(smallest_volume().ratio > 0.0)) apply_motion(0.0);
}

mechanics::MotionReport World::apply_motion(double scale) {
  mechanics::MotionReport worst;
  for (auto& body : bodies_) {
    const auto report = body->apply_motion(scale);
    worst.finite = worst.finite && report.finite;
    worst.largest_move = std::max(worst.largest_move, report.largest_move);
  }
  return worst;
}

mechanics::SmallestVolume World::smallest_volume() {
  mechanics::SmallestVolume smallest{INFINITY, -1};
  for (auto& body : bodies_) {
    const auto volume = body->smallest_volume();
    if (volume.ratio < smallest.ratio) smallest = volume;
  }
  return smallest;
}

double World::end_step(const mechanics::StepWeights& weights) {
  double worst = 0.0;
  for (auto& body : bodies_) worst = std::max(worst, body->end_step(weights));
  return worst;
}

std::size_t World::frames_size() const {
  std::size_t points = 0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    points += model_->contact(static_cast<int>(i)).points().size();
  }
  return 9 * points;
}

void World::save_frames(std::vector<double>& frames) const {
  frames.resize(frames_size());
  double* to = frames.data();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      to = std::copy_n(rows_.direction[contact.entry(k)].data(), 9, to);
    }
  }
}

void World::load_frames(std::span<const double> frames) {
  const double* from = frames.data();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k, from += 9) {
      std::copy_n(from, 9, rows_.direction[contact.entry(k)].data());
    }
  }
}

void World::restart() {
  for (const auto& body : bodies_) body->restart();
}

std::size_t World::bytes() const {
  std::size_t total = sizeof(double) * static_cast<std::size_t>(problem_.compliance.size());
  total += rows_.direction.size() * sizeof(Vector3) +
           curvatures_.size() * sizeof(mechanics::RowCurvature);
  for (const auto& body : bodies_) total += body->bytes();
  return total;
}

}  // namespace sinew::sim
