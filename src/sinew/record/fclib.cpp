#include "sinew/record/fclib.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/record/hdf5_reader.hpp"
#include "sinew/record/hdf5_writer.hpp"

namespace sinew::record {

namespace {

using Triplets = std::vector<Eigen::Triplet<double, int>>;
using Counts = std::vector<std::int32_t>;

// Values of `nz` for compressed storage of W; other values are numbers of triplets.
constexpr std::int32_t kByColumns = -1, kByRows = -2;

const std::string kRoot = "/fclib_local";
const std::string kMatrix = kRoot + "/W/";
const std::string kVectors = kRoot + "/vectors/";
const std::string kInfo = kRoot + "/info/";
const std::string kSolution = "/solution/";

std::int32_t count(const Hdf5Reader& file, const std::string& dataset) {
  const Counts values = file.integers(dataset, {1});
  if (values[0] < kByRows) file.fail(fmt::format("{} is {}", dataset, values[0]));
  return values[0];
}

// The number of contacts, with three rows each.
std::size_t contacts(const Hdf5Reader& file) {
  const auto refuse = [&](const char* what, const char* remedy) {
    throw Error(ErrorKind::not_in_this_version, {.file = file.path()}, what, remedy);
  };
  if (!file.has(kRoot) && file.has("/fclib_global")) {
    refuse("the problem is a global one (M, H)", "condense it: W = H^T M^-1 H, q = H^T M^-1 f + w");
  }
  if (file.has(kRoot + "/V") || file.has(kRoot + "/R")) {
    refuse("the problem has equations of joints (V, R)", "eliminate them");
  }
  if (count(file, kRoot + "/spacedim") != 3) {
    refuse("the problem is in two dimensions", "give one in three");
  }
  const std::int32_t rows = count(file, kMatrix + "m"), columns = count(file, kMatrix + "n");
  if (rows != columns || rows < 0 || rows % 3 != 0) {
    file.fail(fmt::format("W is {} x {}, not 3n x 3n", rows, columns));
  }
  return static_cast<std::size_t>(rows / 3);
}

// Start of each of `lists` lists in the nzmax entries, and end of the last one.
Counts starts(const Hdf5Reader& file, std::size_t lists, std::size_t nzmax) {
  Counts p = file.integers(kMatrix + "p", {lists + 1});
  const bool good =
      p.front() == 0 && std::ranges::is_sorted(p) && static_cast<std::size_t>(p.back()) <= nzmax;
  if (!good) file.fail(kMatrix + "p does not say where rows or columns begin");
  return p;
}

Eigen::SparseMatrix<double> read_matrix(const Hdf5Reader& file, std::size_t size) {
  const std::int32_t nz = count(file, kMatrix + "nz"), nzmax = count(file, kMatrix + "nzmax");
  if (nzmax < nz || nzmax < 0) file.fail(fmt::format("nzmax of W is {}, nz {}", nzmax, nz));
  const auto stored = static_cast<std::size_t>(nzmax);
  const std::size_t used = nz >= 0 ? static_cast<std::size_t>(nz) : stored;
  const Counts i = file.integers(kMatrix + "i", {used});
  const std::vector<double> x = file.numbers(kMatrix + "x", {stored});
  Triplets entries;
  const auto add = [&](std::int32_t row, std::int32_t column, double value) {
    const auto limit = static_cast<std::int32_t>(size);
    if (row < 0 || column < 0 || row >= limit || column >= limit) {
      file.fail(fmt::format("W has an entry at ({}, {}) of {} rows", row, column, limit));
    }
    entries.emplace_back(row, column, value);
  };
  if (nz >= 0) {
    const Counts p = file.integers(kMatrix + "p", {used});
    for (std::size_t k = 0; k < used; ++k) add(p[k], i[k], x[k]);
  } else {
    const Counts p = starts(file, size, stored);
    for (std::size_t list = 0; list < size; ++list) {
      const auto own = static_cast<std::int32_t>(list);
      for (auto k = static_cast<std::size_t>(p[list]); k < static_cast<std::size_t>(p[list + 1]);
           ++k) {
        if (nz == kByColumns) {
          add(i[k], own, x[k]);
        } else {
          add(own, i[k], x[k]);
        }
      }
    }
  }
  const auto rows = static_cast<Eigen::Index>(size);
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

VectorX read_vector(const Hdf5Reader& file, const std::string& dataset, std::size_t size) {
  const std::vector<double> values = file.numbers(dataset, {size});
  return Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(size));
}

void check(const FclibProblem& problem) {
  const auto rows = static_cast<Eigen::Index>(3 * problem.friction.size());
  const bool fits = problem.w.rows() == rows && problem.w.cols() == rows &&
                    problem.q.size() == rows && (problem.r.size() == 0 || problem.r.size() == rows);
  if (fits && problem.w.nonZeros() <= std::numeric_limits<std::int32_t>::max()) return;
  throw Error(
      ErrorKind::wrong_shape, {.item = "write_fclib()"},
      fmt::format("W is {} x {}, q has {} entries, r {} and friction {}", problem.w.rows(),
                  problem.w.cols(), problem.q.size(), problem.r.size(), problem.friction.size()),
      "give W (3n, 3n), q and r (3n,) and friction (n,)");
}

std::span<const double> entries(const VectorX& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

void write_matrix(Hdf5Writer& file, Eigen::SparseMatrix<double> matrix) {
  matrix.makeCompressed();
  const auto size = static_cast<std::size_t>(matrix.cols());
  const auto stored = static_cast<std::size_t>(matrix.nonZeros());
  const auto write_count = [&](const char* name, std::int32_t value) {
    file.dataset(kMatrix + name, {1}, std::array{value});
  };
  write_count("nzmax", static_cast<std::int32_t>(stored));
  write_count("m", static_cast<std::int32_t>(size));
  write_count("n", static_cast<std::int32_t>(size));
  write_count("nz", kByColumns);
  file.dataset(kMatrix + "p", {size + 1}, std::span(matrix.outerIndexPtr(), size + 1));
  file.dataset(kMatrix + "i", {stored}, std::span(matrix.innerIndexPtr(), stored));
  file.dataset(kMatrix + "x", {stored}, std::span<const double>(matrix.valuePtr(), stored));
}

// Removes what was written when writing fails.
struct Draft {
  std::filesystem::path path;
  ~Draft() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace

FclibProblem read_fclib(const std::filesystem::path& path) {
  const Hdf5Reader file(path,
                        {"give an HDF5 file of FCLIB", "the file is damaged or not of FCLIB"});
  const std::size_t points = contacts(file), rows = 3 * points;
  FclibProblem problem;
  problem.q = read_vector(file, kVectors + "q", rows);  // so many rows are really there
  problem.w = read_matrix(file, rows);
  problem.friction = file.numbers(kVectors + "mu", {points});
  if (file.has(kSolution + "r")) problem.r = read_vector(file, kSolution + "r", rows);
  if (file.has(kInfo + "title")) problem.title = file.text(kInfo + "title");
  if (file.has(kInfo + "description")) problem.description = file.text(kInfo + "description");
  return problem;
}

void write_fclib(const std::filesystem::path& path, const FclibProblem& problem) {
  check(problem);
  const auto rows = static_cast<std::size_t>(problem.q.size());
  const Draft draft{draft_beside(path)};
  Hdf5Writer file(draft.path);
  file.dataset(kRoot + "/spacedim", {1}, std::array<std::int32_t, 1>{3});
  write_matrix(file, problem.w);
  file.dataset(kVectors + "q", {rows}, entries(problem.q));
  file.dataset(kVectors + "mu", {problem.friction.size()}, problem.friction);
  // The reader of FCLIB expects null-terminated strings.
  file.text(kInfo + "title", problem.title + '\0');
  file.text(kInfo + "description", problem.description + '\0');
  if (problem.r.size() > 0) {
    const VectorX u = problem.w * problem.r + problem.q;
    file.dataset(kSolution + "u", {rows}, entries(u));
    file.dataset(kSolution + "r", {rows}, entries(problem.r));
  }
  file.flush();
  file.rename(path);
}

}  // namespace sinew::record
