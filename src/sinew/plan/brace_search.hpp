/// @file
/// The search for braces among candidates: programs solved, their equilibria judged, the best kept.
#pragma once

#include <memory>
#include <vector>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/brace.hpp"
#include "sinew/plan/brace_program.hpp"
#include "sinew/plan/brace_response.hpp"
#include "sinew/plan/uniform.hpp"

namespace sinew::plan {

/// Whether friction must have the reserve that the task asks for, and the best is what moves least;
/// or as much of it as there can be, and the best is the first that has it.
enum class Reserve { demanded, wished };

/// Tries candidates and keeps the best. Workspace of one search.
class BraceSearch {
 public:
  /// @param arm which. @param task completed(), outlives this. @param reserve of friction.
  BraceSearch(std::shared_ptr<const pcc::Arm> arm, const BraceTask& task, Reserve reserve);

  /// Solves a candidate's program, and again while the reserve of friction that it keeps is not
  /// what its equilibrium needs. @param problem of the candidate; its reserve is set here. @param
  /// object which. @param start (coordinates + 1 + inputs,): angles, turn, torques.
  void attempt(BraceProblem problem, int object, const VectorX& start);
  /// Within the problem's limits. @param problem of a candidate.
  VectorX random_start(const BraceProblem& problem);
  /// Whether a brace has been found so far.
  bool found() const { return best_.found(); }
  /// The best, or with this status the one that came nearest. @param without a brace.
  Brace finish(BraceStatus without) const;

 private:
  struct Judged {
    Brace brace;
    double reserve = 0.0;  // N, of friction, for the task's force
    int held = 0;          // conditions
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
