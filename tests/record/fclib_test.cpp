#include "sinew/record/fclib.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/random.hpp"
#include "sinew/record/hdf5_writer.hpp"

#include "support/error_kind.hpp"

namespace sinew::record {
namespace {

namespace fs = std::filesystem;

class Fclib : public ::testing::Test {
 protected:
  ~Fclib() override { fs::remove(path_); }

  static FclibProblem problem(int contacts) {
    Random random(3);
    const Eigen::Index rows = 3 * contacts;
    MatrixX w(rows, rows);
    FclibProblem result;
    result.q.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      result.q[i] = random.uniform(-1.0, 1.0);
      for (Eigen::Index j = 0; j < rows; ++j) {
        w(i, j) = (i + j) % 4 == 0 ? 0.0 : random.uniform(-1.0, 1.0);
      }
    }
    result.w = w.sparseView();
    for (int k = 0; k < contacts; ++k) result.friction.push_back(0.1 * k);
    return result;
  }

  // Writes a file with a given storage of W.
  void write(int m, int nz, const std::vector<int>& p, const std::vector<int>& i,
             const std::vector<double>& x, std::size_t q = 3, int spacedim = 3) {
    Hdf5Writer file(path_);
    const auto put = [&](const std::string& name, const std::vector<std::int32_t>& values) {
      file.dataset("/fclib_local/" + name, {values.size()}, values);
    };
    put("spacedim", {spacedim});
    put("W/m", {m});
    put("W/n", {m});
    put("W/nz", {nz});
    put("W/nzmax", {static_cast<int>(x.size())});
    put("W/p", p);
    put("W/i", i);
    file.dataset("/fclib_local/W/x", {x.size()}, x);
    file.dataset("/fclib_local/vectors/q", {q}, std::vector<double>(q, 1.0));
    file.dataset("/fclib_local/vectors/mu", {q / 3}, std::vector<double>(q / 3, 0.5));
    file.flush();
  }
  ErrorKind refused() {
    return sinew::testing::kind_of([&] { read_fclib(path_); });
  }

  fs::path path_ = fs::temp_directory_path() / "sinew_fclib_test.hdf5";
};

TEST_F(Fclib, ComesBackAsItWasWritten) {
  for (const int contacts : {0, 1, 7}) {
    FclibProblem written = problem(contacts);
    written.title = "a block";
    written.description = "at rest \xc2\xb5";
    for (const bool solved : {false, true}) {
      if (solved) written.r = 2.0 * written.q;
      write_fclib(path_, written);
      const FclibProblem read = read_fclib(path_);
      EXPECT_EQ(MatrixX(read.w), MatrixX(written.w));
      EXPECT_EQ(read.q, written.q);
      EXPECT_EQ(read.friction, written.friction);
      EXPECT_EQ(read.r.size(), written.r.size());
      EXPECT_TRUE(read.r == written.r);
      EXPECT_EQ(read.title, written.title);
      EXPECT_EQ(read.description, written.description);
    }
  }
}

// [1 0 4; 0 2 0; 0 0 3], with unused entries.
TEST_F(Fclib, ReadsColumnsRowsAndTriplets) {
  MatrixX expected(3, 3);
  expected << 1, 0, 4, 0, 2, 0, 0, 0, 3;
  write(3, -1, {0, 1, 2, 4}, {0, 1, 0, 2, 0}, {1, 2, 4, 3, 9});
  EXPECT_EQ(MatrixX(read_fclib(path_).w), expected);
  write(3, -2, {0, 2, 3, 4}, {0, 2, 1, 2}, {1, 4, 2, 3});
  EXPECT_EQ(MatrixX(read_fclib(path_).w), expected);
  write(3, 4, {2, 0, 1, 0}, {2, 0, 1, 2}, {3, 1, 2, 4});
  EXPECT_EQ(MatrixX(read_fclib(path_).w), expected);
}

TEST_F(Fclib, RefusesWhatIsNoProblem) {
  EXPECT_EQ(refused(), ErrorKind::file_not_found);
  std::ofstream(path_) << "no HDF5";
  EXPECT_EQ(refused(), ErrorKind::unknown_format);
  Hdf5Writer(path_).text("/hello", "x");
  EXPECT_EQ(refused(), ErrorKind::malformed_file);
  Hdf5Writer(path_).group("/fclib_global");
  EXPECT_EQ(refused(), ErrorKind::not_in_this_version);
  write(3, -1, {0, 1, 2, 3}, {0, 1, 2}, {1, 1, 1}, 3, 2);
  EXPECT_EQ(refused(), ErrorKind::not_in_this_version);
  write(4, -1, {0, 1, 2, 3, 4}, {0, 1, 2, 3}, {1, 1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // not 3n rows
  write(3, -1, {0, 1, 2, 4}, {0, 1, 2}, {1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // more entries than stored
  write(3, -1, {0, 2, 1, 3}, {0, 1, 2}, {1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // columns that end before they start
  write(3, -1, {0, 1, 2, 3}, {0, 1, 3}, {1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // no such row
  write(3, 5, {0, 1, 2}, {0, 1, 2}, {1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // fewer triplets than claimed
  write(3, -3, {0, 1, 2, 3}, {0, 1, 2}, {1, 1, 1});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // no such storage
  write(1'500'000'000, 0, {}, {}, {});
  EXPECT_EQ(refused(), ErrorKind::malformed_file);  // before memory is allocated
  FclibProblem problem = Fclib::problem(2);
  problem.friction.pop_back();
  EXPECT_EQ(sinew::testing::kind_of([&] { write_fclib(path_, problem); }), ErrorKind::wrong_shape);
}

}  // namespace
}  // namespace sinew::record
