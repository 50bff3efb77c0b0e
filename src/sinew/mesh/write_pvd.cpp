#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::mesh {

namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n";
constexpr std::string_view kTail = "  </Collection>\n</VTKFile>\n";

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw Error(ErrorKind::file_unwritable, {.file = path.string()},
              fmt::format("the file cannot be written: {}", reason),
              "check that its folder exists, may be written to and has space");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  if (!folder.empty()) std::filesystem::create_directories(folder, problem);
  if (problem) fail(folder, problem.message());
}

/// Overwrites the end of the file in one write: a reader sees the old list or the new one.
void overwrite_end(const std::filesystem::path& path, long at, std::string_view text) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) fail(path, std::strerror(errno));
  const ssize_t written = pwrite(file, text.data(), text.size(), at);
  const int reason = errno;
  close(file);
  if (written != static_cast<ssize_t>(text.size())) {
    fail(path, written < 0 ? std::strerror(reason) : "no space left");
  }
}

}  // namespace

PvdWriter::PvdWriter(std::filesystem::path path)
    : path_(std::move(path)), tail_(static_cast<long>(kHead.size())) {
  make_folder(path_.parent_path());
  make_folder(path_.parent_path() / path_.stem());
  write_file(path_, std::string(kHead) + std::string(kTail));
}

void PvdWriter::write(double time, const Mesh& mesh, const VtuFields& fields) {
  if (!std::isfinite(time)) {
    throw Error(ErrorKind::not_finite, {.file = path_.string()}, fmt::format("time is {}", time));
  }
  const std::string stem = path_.stem().string();
  const std::filesystem::path step =
      std::filesystem::path(stem) / fmt::format("{}_{:06}.vtu", stem, count_);
  write_vtu(path_.parent_path() / step, mesh, fields);
  const std::string entry =
      fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, step.string());
  overwrite_end(path_, tail_, entry + std::string(kTail));
  tail_ += static_cast<long>(entry.size());
  ++count_;
}

}  // namespace sinew::mesh
