#include "sinew/plan/nonlinear_program.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

#include "sinew/core/error.hpp"
#include "sinew/plan/interior_newton.hpp"

namespace sinew::plan {

namespace {

using Ipopt::Index;
using Ipopt::Number;

/// Adapts a program to the interface of Ipopt.
class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(NonlinearProgram& program, const ProgramPoint& start, ProgramResult& result)
      : program_(program), start_(start), result_(result) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian,
                    IndexStyleEnum& style) override {
    n = static_cast<Index>(program_.variable_bounds().lower.size());
    m = static_cast<Index>(program_.constraint_bounds().lower.size());
    jacobian = static_cast<Index>(program_.jacobian_pattern().size());
    hessian = static_cast<Index>(program_.hessian_pattern().size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_lower, Number* x_upper, Index, Number* c_lower,
                       Number* c_upper) override {
    const auto copy = [](const VectorX& from, Number* to) {
      std::copy(from.begin(), from.end(), to);
    };
    copy(program_.variable_bounds().lower, x_lower);
    copy(program_.variable_bounds().upper, x_upper);
    copy(program_.constraint_bounds().lower, c_lower);
    copy(program_.constraint_bounds().upper, c_upper);
    return true;
  }

  bool get_scaling_parameters(Number& objective, bool& use_x, Index n, Number* x, bool& use_c,
                              Index m, Number* c) override {
    objective = 1.0 / program_.objective_scale();
    use_x = use_c = true;
    for (Index i = 0; i < n; ++i) x[i] = 1.0 / program_.variable_scale()[i];
    for (Index i = 0; i < m; ++i) c[i] = 1.0 / program_.constraint_scale()[i];
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool want_bounds, Number* lower, Number* upper,
                          Index m, bool want_multipliers, Number* multipliers) override {
    std::copy_n(start_.x.data(), n, x);
    if (want_bounds) {
      std::copy_n(start_.lower_multipliers.data(), n, lower);
      std::copy_n(start_.upper_multipliers.data(), n, upper);
    }
    if (want_multipliers) std::copy_n(start_.constraint_multipliers.data(), m, multipliers);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = program_.objective(take(n, x));
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    program_.gradient(take(n, x), work_);
    std::copy_n(work_.data(), n, gradient);
    return true;
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* c) override {
    program_.constraints(take(n, x), work_);
    std::copy_n(work_.data(), m, c);
    return work_.allFinite();
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values == nullptr) {
      pattern(program_.jacobian_pattern(), rows, columns);
    } else {
      program_.jacobian(take(n, x), values);
    }
    return true;
  }

  bool eval_h(Index n, const Number* x, bool, Number factor, Index m, const Number* multipliers,
              bool, Index, Index* rows, Index* columns, Number* values) override {
    if (values == nullptr) {
      pattern(program_.hessian_pattern(), rows, columns);
    } else {
      multipliers_ = VectorX::Map(multipliers, m);
      program_.hessian(take(n, x), factor, multipliers_, values);
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number* lower,
                         const Number* upper, Index m, const Number* c, const Number* multipliers,
                         Number objective, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    result_.point = {VectorX::Map(x, n), VectorX::Map(multipliers, m), VectorX::Map(lower, n),
                     VectorX::Map(upper, n)};
    result_.objective = objective;
    const Bounds& bounds = program_.constraint_bounds();
    for (Index i = 0; i < m; ++i) {
      result_.violation =
          std::max({result_.violation, bounds.lower[i] - c[i], c[i] - bounds.upper[i]});
    }
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number,
                             Number, Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    result_.iterations = iteration;
    return true;
  }

 private:
  const VectorX& take(Index n, const Number* x) { return x_ = VectorX::Map(x, n); }
  static void pattern(const std::vector<SparseEntry>& entries, Index* rows, Index* columns) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      rows[k] = entries[k].row;
      columns[k] = entries[k].column;
    }
  }

  NonlinearProgram& program_;
  const ProgramPoint& start_;
  ProgramResult& result_;
  VectorX x_, work_, multipliers_;
};

Status status_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Feasible_Point_Found:
      return Status::solved;
    case Ipopt::Solved_To_Acceptable_Level:
      return Status::acceptable;
    case Ipopt::Infeasible_Problem_Detected:
      return Status::infeasible;
    case Ipopt::Maximum_Iterations_Exceeded:
      return Status::iteration_limit;
    case Ipopt::Maximum_CpuTime_Exceeded:
      return Status::time_limit;
    default:
      return Status::failed;
  }
}

void set_options(Ipopt::OptionsList& options, const SolverSettings& settings, bool warm) {
  options.SetIntegerValue("print_level", settings.verbose ? 5 : 0);
  options.SetStringValue("sb", "yes");
  options.SetStringValue("linear_solver", "mumps");
  options.SetStringValue("nlp_scaling_method", "user-scaling");
  options.SetNumericValue("tol", settings.tolerance);
  options.SetNumericValue("acceptable_tol", 100.0 * settings.tolerance);
  options.SetIntegerValue("max_iter", settings.max_iterations);
  options.SetNumericValue("max_cpu_time", settings.max_time);
  // With Mehrotra's probing steps, plans from cold starts need a third of the iterations of the
  // monotone strategy, and replans two thirds. Progress is measured by the error of the optimality
  // conditions.
  options.SetStringValue("mu_strategy", "adaptive");
  options.SetStringValue("mu_oracle", "probing");
  options.SetStringValue("adaptive_mu_globalization", "kkt-error");
  // Allows plans to be exactly at their bounds.
  options.SetNumericValue("bound_relax_factor", 0.0);
  options.SetStringValue("honor_original_bounds", "no");
  if (warm) {
    options.SetStringValue("warm_start_init_point", "yes");
    for (const char* name :
         {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
          "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      options.SetNumericValue(name, 1e-3);
    }
  }
}

}  // namespace

std::string_view status_name(Status status) {
  switch (status) {
    case Status::solved:
      return "solved";
    case Status::acceptable:
      return "acceptable";
    case Status::infeasible:
      return "infeasible";
    case Status::iteration_limit:
      return "iteration-limit";
    case Status::time_limit:
      return "time-limit";
    case Status::failed:
      break;
  }
  return "failed";
}

ProgramResult solve(NonlinearProgram& program, const ProgramPoint& start,
                    const SolverSettings& settings) {
  const bool warm = start.constraint_multipliers.size() > 0;
  if (warm) {
    if (std::optional<ProgramResult> near = solve_nearby(program, start, settings)) return *near;
  }
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  ProgramResult result;
  result.point = start;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  if (settings.verbose) {
    application->Jnlst()->AddFileJournal("console", "stdout", Ipopt::J_ITERSUMMARY);
  }
  set_options(*application->Options(), settings, warm);
  const auto begin = std::chrono::steady_clock::now();
  if (application->Initialize("") != Ipopt::Solve_Succeeded) {
    throw Error(ErrorKind::internal, {.item = "Ipopt"}, "its options were not taken");
  }
  Ipopt::SmartPtr<Ipopt::TNLP> adapter = new Adapter(program, start, result);
  result.status = status_of(application->OptimizeTNLP(adapter));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace sinew::plan
