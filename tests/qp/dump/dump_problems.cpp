// Writes random problems and Sinew's solutions as JSON, for tests/qp/against_cvxopt.py:
// dump_qp_problems FILE.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/qp/elastic.hpp"

#include "../random_problem.hpp"

namespace {

using namespace sinew;
using namespace sinew::qp;

// JSON has no infinity: null denotes an absent limit.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

std::string list(const VectorX& vector) {
  std::vector<std::string> entries;
  for (const double value : vector) entries.push_back(number(value));
  return fmt::format("[{}]", fmt::join(entries, ","));
}

std::string list(const MatrixX& matrix) {
  std::vector<std::string> rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(list(VectorX(matrix.row(i).transpose())));
  }
  return fmt::format("[{}]", fmt::join(rows, ","));
}

std::string answer(const ElasticResult& result) {
  return fmt::format(R"({{"status": "{}", "x": {}, "violation": {}}})",
                     elastic_status_name(result.status), list(result.qp.x), list(result.violation));
}

std::string record(ProblemKind kind, Random& random) {
  const int n = random.integer(2, 20);
  const int m = random.integer(4, 30);
  const QuadraticProgram problem = random_problem(kind, n, m, random);
  QpSolver solver(n, m);
  const QpResult& result = solver.solve(problem);
  return fmt::format(
      R"({{"kind": "{}", "hessian": {}, "gradient": {}, "lower": {}, "upper": {}, "rows": {}, )"
      R"("row_lower": {}, "row_upper": {}, "status": "{}", "x": {}, "worst": {}, "sum": {}}})",
      problem_kind_name(kind), list(problem.hessian), list(problem.gradient), list(problem.lower),
      list(problem.upper), list(problem.rows), list(problem.row_lower), list(problem.row_upper),
      qp_status_name(result.status), list(result.x),
      answer(solve_elastic(problem, {.measure = ElasticMeasure::worst})),
      answer(solve_elastic(problem, {.measure = ElasticMeasure::sum})));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: dump_qp_problems FILE\n", stderr);
    return 2;
  }
  Random random(99);
  std::ofstream file(argv[1]);
  for (int trial = 0; trial < 240; ++trial) {
    file << (trial ? ",\n" : "[") << record(static_cast<ProblemKind>(trial % 6), random);
  }
  file << "]\n";
  return file.good() ? 0 : 1;
}
