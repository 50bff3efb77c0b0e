// The commands of the sinew program: each takes its parsed options and returns an exit code.
#pragma once

#include <string>
#include <vector>

namespace sinew::cli {

struct RunOptions {
  std::string scene;
  std::string duration;  // a quantity; empty: the scene's
  std::vector<std::string> overrides;
  std::string out;         // empty: out/<scene name>
  std::string controller;  // a name, "none", or empty for the scene's first
  int threads = 0;         // 0: the scene's
  bool vtk = false;
  bool quiet = false;
};
int run(const RunOptions& options);

struct BenchOptions {
  std::string scene;
  std::vector<std::string> overrides;
  int steps = 300;
  int warm_up = 100;
  int threads = 0;
  std::string json;     // file; empty: none
  std::string tangent;  // "rotated" or "exact"; empty: the scene's
  bool compare_eigen = false;
};
int bench(const BenchOptions& options);

struct InfoOptions {
  std::string file;
  std::string unit;  // empty: m, unbelieved
};
int info(const InfoOptions& options);

struct MeshOptions {
  std::string input;  // a surface file, or empty with `shape`
  std::string shape;
  std::string output;
  std::string size = "5 mm";
  std::string unit;
  int refine = 0;
};
int mesh(const MeshOptions& options);

// Replaces this process by the validation suite.
int validate(const std::vector<std::string>& arguments);

}  // namespace sinew::cli
