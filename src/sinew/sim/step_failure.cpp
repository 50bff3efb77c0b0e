#include "sinew/sim/step_failure.hpp"

#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/run.hpp"

namespace sinew::sim {

namespace {

// More points than this are beyond the solver's Newton method, and slow.
constexpr std::size_t kManyPoints = static_cast<std::size_t>(qp::ConeSettings{}.newton_limit) / 3;

}  // namespace

void fail(Run& run, ErrorKind kind, const std::string& message, const std::string& remedy) {
  run.go_back();
  std::string names;
  for (const auto& body : run.model->bodies()) names += (names.empty() ? "" : ", ") + body.name();
  throw Error(kind,
              {.item = fmt::format("step {} (t = {:g} s), body {}", run.steps + 1, run.now, names)},
              message, remedy);
}

void fail_law(Run& run) {
  if (const int idle = run.solver.direct().unreachable(); idle >= 0) {
    fail(run, ErrorKind::not_converged,
         fmt::format("{} moves nothing, so that the motion commanded of it is out of its reach",
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
         "the robot gives way against a force on it: it is beyond a stable equilibrium, where one "
         "linearisation leads nowhere",
         "use solver: newton with tangent: exact, smaller time steps, or inertia");
  }
  if (result.status == qp::ConeStatus::solved) {
    fail(run, ErrorKind::not_converged,
         "no efforts obey the laws of this step's actuators, joints and contacts together",
         "take a smaller time step, or loosen limits of actuators and joints");
  }
  fail(run, ErrorKind::not_converged,
       fmt::format("no contact forces obey this step: residual {:.3g} after {} sweeps, with {} "
                   "points near their surfaces",
                   result.residual, result.sweeps, points),
       points > kManyPoints
           ? fmt::format("let points share their rows (`aggregate` of the contact), or let fewer "
                         "touch (`nodes` or `points`): up to {} are solved best; or take a smaller "
                         "time step",
                         kManyPoints)
           : "take a smaller time step, or look for a body that is squeezed where it cannot give "
             "way");
}

}  // namespace sinew::sim
