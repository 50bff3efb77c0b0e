// Runs continuous queries with known answers, in the format of the data set of Wang et al.
// (ACM TOG 40(5), 2021), and counts wrong answers and time:
//   zcat vertex_face.csv.gz | impact_queries vertex-face [SEPARATION]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "sinew/collision/impact.hpp"

namespace {

using namespace sinew;
using namespace sinew::collision;

struct Query {
  FourPoints start, end;
  bool collides = false;
};

// A query has eight lines with numerators and denominators of x, y, z, and the answer.
std::vector<Query> read_queries() {
  std::vector<Query> queries;
  Query query;
  double n[6];
  int answer = 0;
  for (std::size_t row = 0;
       std::scanf("%lf,%lf,%lf,%lf,%lf,%lf,%d", n, n + 1, n + 2, n + 3, n + 4, n + 5, &answer) == 7;
       row = (row + 1) % 8) {
    (row < 4 ? query.start : query.end)[row % 4] = {n[0] / n[1], n[2] / n[3], n[4] / n[5]};
    query.collides = answer != 0;
    if (row == 7) queries.push_back(query);
  }
  return queries;
}

// Minimum time of several rounds, to exclude disturbances.
template <typename Ask>
double nanoseconds(const Ask& ask) {
  constexpr int kRounds = 5, kCalls = 20;
  double least = kInfinity;
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    for (int call = 0; call < kCalls; ++call) ask();
    const std::chrono::duration<double, std::nano> passed =
        std::chrono::steady_clock::now() - begin;
    least = std::min(least, passed.count() / kCalls);
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind != "vertex-face" && kind != "edge-edge") {
    std::fputs("usage: impact_queries vertex-face|edge-edge [SEPARATION] < QUERIES\n", stderr);
    return 2;
  }
  const double separation = argc > 2 ? std::atof(argv[2]) : 0.0;
  const auto queries = read_queries();
  if (queries.empty()) {
    std::fputs("impact_queries: no queries on standard input\n", stderr);
    return 2;
  }
  int negatives = 0, false_negatives = 0, false_positives = 0;
  double sum = 0.0;
  std::vector<double> times;
  for (const Query& query : queries) {
    std::optional<double> time;
    times.push_back(nanoseconds([&] {
      time = kind == "vertex-face" ? vertex_face_impact(query.start, query.end, separation)
                                   : edge_edge_impact(query.start, query.end, separation);
    }));
    sum += times.back();
    negatives += query.collides ? 0 : 1;
    false_negatives += query.collides && !time ? 1 : 0;
    false_positives += !query.collides && time ? 1 : 0;
  }
  std::ranges::sort(times);
  const auto count = queries.size();
  std::printf("%s: %zu queries, separation %g\n", kind.c_str(), count, separation);
  std::printf("false negatives %d of %zu collisions\n", false_negatives,
              count - static_cast<std::size_t>(negatives));
  std::printf("false positives %d of %d, %.2f %%\n", false_positives, negatives,
              100.0 * false_positives / std::max(1, negatives));
  std::printf("ns a query: median %.0f, mean %.0f, 99 %% below %.0f, most %.0f\n", times[count / 2],
              sum / static_cast<double>(count), times[count * 99 / 100], times.back());
  return false_negatives == 0 ? 0 : 1;
}
