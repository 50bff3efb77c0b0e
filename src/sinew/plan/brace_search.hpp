/// @file
/// The search for braces among candidates: solves programs and keeps the best equilibrium.
#pragma once

#include <memory>
#include <vector>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/brace.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/brace_response.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

/// How the search treats the friction reserve of the task. `demanded`: it is required, and the best
/// brace has the least peak compliance. `wished`: as much of it as possible is kept, and the best
/// brace is the first that has all of it.
enum class Reserve { demanded, wished };

/// Tries candidates and keeps the best one. It has the workspace of one search.
class BraceSearch {
 public:
  /// @param arm to be braced. @param task completed(), must outlive this. @param reserve of
  /// friction.
  BraceSearch(std::shared_ptr<const pcc::Arm> arm, const BraceTask& task, Reserve reserve);

  /// Solves the program of a candidate, and again until its friction reserve is the one that its
  /// equilibrium needs. @param problem of the candidate, whose reserve is set here.
  /// @param object index of the object. @param start (coordinates + 1 + inputs,): angles, rotation
  /// of the base, torques.
  void attempt(BraceProblem problem, int object, const VectorX& start);
  /// A random start within the limits of a problem. @param problem of a candidate.
  VectorX random_start(const BraceProblem& problem);
  /// Whether a brace has been found so far.
  bool found() const { return best_.found(); }
  /// The best brace, or if there is none the closest equilibrium. @param without its status if
  /// there is no brace.
  Brace finish(BraceStatus without) const;

 private:
  struct Judged {
    Brace brace;
    double reserve = 0.0;  // N, of friction, that the task's force needs
    int held = 0;          // number of conditions that hold
  };
  Judged judge(BraceProgram& program, int object, const VectorX& x);
  bool better(const Brace& one, const Brace& other) const;
  void keep(const Judged& judged);

  std::shared_ptr<const pcc::Arm> arm_;
  const BraceTask& task_;
  Reserve reserve_;
  pcc::ArmEquations equations_;
  PointDerivatives points_;
  Uniform draw_;
  Brace best_;
  Judged nearest_;
  int tried_ = 0, solved_ = 0, unstable_ = 0;
};

}  // namespace sinew::plan
