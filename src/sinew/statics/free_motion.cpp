#include "sinew/statics/free_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/world/held_motions.hpp"
#include "sinew/world/rigid_fit.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::statics {

namespace {

// sigma M relative to the stiffness of the elements: above rounding, and below the softest bending
// of slender bodies, (h/L)^4 of it. Also relative to the loads over the size of the robot, which
// are the stiffness of bodies without elements: a motion of this size that is less stiff changes no
// force that matters, and a smaller inertia would exceed the compliance of held rows so far that
// they could not be told from redundant ones.
constexpr double kShift = 1e-11, kShiftOfLoads = 1e-7;
// A sigma that is lost in rounding makes the shifted matrix singular, too.
constexpr double kLargerShift = 100.0;
constexpr int kShiftTries = 4;
constexpr int kPowers = 6;
// Smaller residuals, relative to the forces, drive nothing.
constexpr double kDrives = 1e-6;
// Of the largest motion: nodes and bodies that move less are not named.
constexpr double kMoves = 0.02;
// Of the largest motion: centres of mass that move less are at rest.
constexpr double kUnmoved = 1e-4;
constexpr std::size_t kMostNames = 4;

// The mean of the nodes stands for the centre of a body that is not rigid: both move alike unless
// it deforms, and then nodes move.
Vector3 centre_of(const mechanics::Body& body) {
  if (const auto* pose = mechanics::as<const mechanics::HasPose>(body)) {
    return pose->centre_of_mass();
  }
  if (body.positions().rows() == 0) return Vector3::Zero();
  return body.positions().colwise().mean().transpose();
}

// A part of the nodes of a body, and their displacements.
std::string describe_part(const mechanics::BodyModel& body, const Points& at, const Points& moved,
                          double least) {
  const std::string& name = body.name();
  if (mechanics::as<const mechanics::MovesByNodes>(body) == nullptr) {  // it moves as a whole
    return fmt::format("body '{}' {}", name, world::RigidFit(at, moved).text());
  }
  std::vector<Eigen::Index> nodes;
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    if (moved.row(i).norm() > least) nodes.push_back(i);
  }
  const world::RigidFit fit(at(nodes, Eigen::all), moved(nodes, Eigen::all));
  const std::string how = fit.text();
  if (std::ssize(nodes) == at.rows()) return fmt::format("body '{}' {}", name, how);
  const double size = (at.colwise().maxCoeff() - at.colwise().minCoeff()).norm();
  return fmt::format("the part of body '{}' with {} of its {} nodes, around {} m, {}", name,
                     nodes.size(), at.rows(), world::place_text(fit.centre, size), how);
}

}  // namespace

double condense_nearly_at_rest(StaticSearch& search) {
  run::Run& run = search.run();
  world::Bodies& bodies = run.world.bodies();
  const auto size = static_cast<Eigen::Index>(bodies.size());
  if (size == 0) return 0.0;
  const VectorX test = world::scattered(size);
  const double mass = search.mass_along(test) / test.squaredNorm();
  search.begin();
  search.linearise();
  bodies.residual(run.effort);
  const double forces =
      std::max(kShift * bodies.rounding_floor() / kEpsilon, kShiftOfLoads * bodies.force_scale());
  if (!(mass > 0.0) || !(forces > 0.0)) return 0.0;
  double sigma = forces / (run.model->size() * std::sqrt(static_cast<double>(size)) * mass);
  for (int tries = 0; tries < kShiftTries; ++tries, sigma *= kLargerShift) {
    search.begin();
    search.linearise(search.overdamped(sigma));
    if (run.world.condense() != linalg::FactorStatus::singular) return sigma;
  }
  return 0.0;
}

// The power method finds the motion of least inertia, the spin of a slender body about its axis,
// before one that matters.
FreeMotion::FreeMotion(StaticSearch& search) {
  motion_ = find(search);
  if (motion_.size() > 0) describe(search, motion_);
  if (!exists_ || moves_centres_) return;
  const FreeMotion first = *this;
  const std::size_t most = 3 * search.run().world.bodies().all().size();
  while (exists_ && !moves_centres_ && spins_.size() < most) {
    leave_out_spins(motion_);
    if (!(motion_.norm() > 0.0)) break;
    spins_.push_back(motion_.normalized());
    clear();
    motion_ = find(search);
    if (motion_.size() > 0) describe(search, motion_);
  }
  if (!moves_centres_) *this = first;
}

void FreeMotion::clear() {
  moving_.clear();
  bodies_.clear();
  text_.clear();
  exists_ = moves_centres_ = false;
}

void FreeMotion::leave_out_spins(VectorX& motion) const {
  for (const VectorX& spin : spins_) motion -= spin.dot(motion) * spin;
}

VectorX FreeMotion::find(StaticSearch& search) {
  run::Run& run = search.run();
  world::World& world = run.world;
  world::Bodies& bodies = world.bodies();
  const auto size = static_cast<Eigen::Index>(bodies.size());
  if (size == 0) return {};
  search.begin();
  search.linearise();
  VectorX force;
  bodies.imbalance(run.effort, force);
  const double forces = bodies.force_scale();
  const double sigma = condense_nearly_at_rest(search);
  if (sigma == 0.0) return {};
  VectorX y = world::scattered(size);
  leave_out_spins(y);
  world::HeldMotions motions(world, world::held_rows(world, run.effort));
  double curvature = 0.0;  // y^T (K + sigma M) y / y^T y, since T x = y satisfies H y = 0
  for (int k = 0; k < kPowers; ++k) {
    const VectorX x = y.normalized();
    motions.solve(x, y);
    leave_out_spins(y);
    if (!y.allFinite() || !(y.norm() > 0.0)) return {};
    curvature = x.dot(y) / y.squaredNorm();
  }
  // Among several free motions, the one in which forces that do not balance drive the robot.
  VectorX driven;
  double driven_curvature = 0.0;
  leave_out_spins(force);
  if (force.norm() > kDrives * forces) {
    motions.solve(force.normalized(), driven);
    leave_out_spins(driven);
    driven_curvature = force.normalized().dot(driven) / driven.squaredNorm();
  }
  const auto is_free = [&](VectorX& motion, double stiffness) {
    if (motion.size() == 0 || !motion.allFinite()) return false;
    motion /= motion.cwiseAbs().maxCoeff();
    const double inertia = sigma * search.mass_along(motion) / motion.squaredNorm();
    return std::abs(stiffness) <= 4.0 * inertia;
  };
  exists_ = true;
  if (is_free(driven, driven_curvature)) return driven;
  exists_ = is_free(y, curvature);
  return exists_ ? y : VectorX();
}

// The displacements of the nodes in a small motion.
void FreeMotion::describe(StaticSearch& search, const VectorX& motion) {
  constexpr double kSmall = 1e-7;
  run::Run& run = search.run();
  world::Bodies& bodies = run.world.bodies();
  const double scale = kSmall * run.model->size();
  std::vector<Points> before, moved;
  std::vector<Vector3> centres;
  for (const auto& body : bodies.all()) {
    before.push_back(body->positions());
    centres.push_back(centre_of(*body));
  }
  search.begin();
  bodies.propose_motion(motion);
  bodies.apply_motion(scale);
  double most = 0.0, drift = 0.0;
  for (std::size_t b = 0; b < before.size(); ++b) {
    const auto& body = *bodies.all()[b];
    moved.push_back((body.positions() - before[b]) / scale);
    if (moved[b].rows() > 0) most = std::max(most, moved[b].rowwise().norm().maxCoeff());
    drift = std::max(drift, (centre_of(body) - centres[b]).norm() / scale);
  }
  bodies.apply_motion(0.0);
  for (std::size_t b = 0; most > 0.0 && b < before.size(); ++b) {
    bodies_.push_back({bodies.all()[b]->model().name(), before[b], moved[b] / most});
  }
  moves_centres_ = drift > kUnmoved * most;
  std::size_t named = 0;
  for (std::size_t b = 0; b < before.size(); ++b) {
    if (moved[b].rows() == 0 || !(moved[b].rowwise().norm().maxCoeff() > kMoves * most)) continue;
    moving_.push_back(b);
    if (named++ >= kMostNames) continue;
    text_ += (text_.empty() ? "" : "; ") +
             describe_part(bodies.all()[b]->model(), before[b], moved[b], kMoves * most);
  }
  if (named > kMostNames) text_ += "; ...";
}

}  // namespace sinew::statics
