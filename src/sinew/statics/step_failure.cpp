#include "sinew/statics/step_failure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/free_motion.hpp"
#include "sinew/world/joint_conflict.hpp"

namespace sinew::statics {

namespace {

// With more points, the contact solver cannot use Newton's method, and is slow.
constexpr std::size_t kManyPoints = static_cast<std::size_t>(qp::ConeSettings{}.newton_limit) / 3;

// The contact with the largest residual, by the solver's last attempt, with its bodies and
// position: "; the worst is contact 'grip' of 'palm' and 'box' at (0.01, 0, 0.2) m".
std::string describe_worst(const run::Run& run) {
  const law::ContactProblem tried = run.solver.direct().contact_problem();
  const VectorX motion = tried.compliance * tried.effort + tried.motion;
  double most = 0.0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < tried.friction.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    double scale = 0.0;
    for (Eigen::Index row = at; row < at + 3; ++row)
      scale += tried.compliance.coeff(row, row) / 3.0;
    if (!(scale > 0.0)) continue;
    const double distance =
        std::sqrt(scale) * qp::cone_residual(tried.effort.segment<3>(at), motion.segment<3>(at),
                                             tried.friction[k], scale);
    if (distance > most) worst = k;
    most = std::max(most, distance);
  }
  const auto& blocks = run.world.problem().contacts;
  if (!(most > 0.0) || worst >= blocks.size()) return "";
  const int row = run.world.numbering().model_row_of(blocks[worst].row);
  for (std::size_t i = 0; i < run.model->contacts().size(); ++i) {
    const constraint::Contact& contact = run.model->contact(static_cast<int>(i));
    const int point = (row - contact.row(0)) / 3;
    if (row < contact.row(0) || std::cmp_greater_equal(point, contact.size())) continue;
    std::string bodies;
    for (const std::string& name : contact::touching_bodies(*run.model, static_cast<int>(i))) {
      bodies += (bodies.empty() ? "'" : " and '") + name + "'";
    }
    const Vector3 at = contact.position_now(run.world.configuration(),
                                            static_cast<std::size_t>(point), run.world.rows());
    return fmt::format("; the worst is contact '{}' of {} at ({:.3g}, {:.3g}, {:.3g}) m",
                       contact.name(), bodies, at[0], at[1], at[2]);
  }
  return "";
}

Error failure(run::Run& run, ErrorKind kind, const std::string& message,
              const std::string& remedy) {
  run.go_back();
  std::string names;
  for (const auto& body : run.model->bodies()) names += (names.empty() ? "" : ", ") + body.name();
  const std::string item =
      fmt::format("step {} (t = {:g} s), body {}", run.steps + 1, run.now, names);
  return Error(kind, {.item = item}, message, remedy);
}

}  // namespace

void fail(run::Run& run, ErrorKind kind, const std::string& message, const std::string& remedy) {
  throw failure(run, kind, message, remedy);
}

void fail_free(run::Run& run, const FreeMotion& free, const std::string& message,
               const std::string& remedy) {
  throw FreeMotionError(
      failure(run, ErrorKind::singular_matrix, message + ": " + free.text(), remedy),
      free.bodies());
}

void fail_joints(run::Run& run, const world::JointConflict& conflict) {
  fail(run, ErrorKind::not_converged,
       fmt::format("joints, limits and prescribed motions contradict each other: {}, in any "
                   "position of the bodies",
                   conflict.text),
       "let a joint leave what the others hold (a ball or cylindrical one in place of a hinge), or "
       "change the commands, limits and motions of bodies that they cannot follow");
}

void fail_law(run::Run& run) {
  if (const int idle = run.solver.direct().unreachable(); idle >= 0) {
    fail(run, ErrorKind::not_converged,
         fmt::format("{} moves nothing, so it cannot reach its commanded motion",
                     run.model->actuators()[static_cast<std::size_t>(idle)].name),
         "let it act between parts that move against each other, or command its effort");
  }
  if (run.model->contacts().empty()) {
    fail(run, ErrorKind::not_converged, "no efforts obey the law of this step",
         "loosen the limits of the actuators");
  }
  const qp::ConeResult& result = run.solver.direct().contact_result();
  const std::size_t points = result.states.size();
  if (result.status == qp::ConeStatus::not_convex) {
    fail(run, ErrorKind::not_converged,
         "the robot is beyond a stable equilibrium: it moves against a force on it, and one "
         "linearisation is not enough",
         "use solver: newton with tangent: exact, smaller time steps, or inertia");
  }
  if (result.status == qp::ConeStatus::not_finite) {
    fail(run, ErrorKind::not_converged, "the motion of this step is not a number",
         "take a smaller time step");
  }
  if (result.status == qp::ConeStatus::solved) {
    fail(run, ErrorKind::not_converged,
         "no efforts obey the laws of this step's actuators, joints and contacts together",
         "take a smaller time step, or loosen limits of actuators and joints");
  }
  fail(run, ErrorKind::not_converged,
       fmt::format("no contact forces obey this step: residual {:.3g} after {} sweeps, with {} "
                   "points near their surfaces{}",
                   result.residual, result.sweeps, points, describe_worst(run)),
       points > kManyPoints
           ? fmt::format("use `aggregate` of the contact, or fewer `nodes` or `points`: up to {} "
                         "points are solved reliably; or take a smaller time step",
                         kManyPoints)
           : "take a smaller time step, or look for a body that is squeezed where it cannot give "
             "way");
}

}  // namespace sinew::statics
