#include <cerrno>
#include <cmath>
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

void make_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  if (!folder.empty()) std::filesystem::create_directories(folder, problem);
  if (problem) throw_unwritable(folder, problem.value());
}

/// Overwrites the end of the file in one write: a reader sees the old list or the new one.
void overwrite_end(const std::filesystem::path& path, long at, std::string_view text) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) throw_unwritable(path, errno);
  const ssize_t written = pwrite(file, text.data(), text.size(), at);
  const int reason = errno;
  close(file);
  if (written != static_cast<ssize_t>(text.size())) {
    throw_unwritable(path, written < 0 ? reason : ENOSPC);
  }
}

}  // namespace

PvdWriter::PvdWriter(std::filesystem::path path)
    : path_(std::move(path)), tail_(static_cast<long>(kHead.size())) {
  make_folder(path_.parent_path());
  make_folder(path_.parent_path() / path_.stem());
  write_file(path_, std::string(kHead) + std::string(kTail));
}

std::filesystem::path PvdWriter::step_of(int number) const {
  const std::string stem = path_.stem().string();
  return std::filesystem::path(stem) / fmt::format("{}_{:06}.vtu", stem, number);
}

void PvdWriter::move_to(const std::filesystem::path& folder) {
  const std::filesystem::path target = folder / path_.filename();
  make_folder(folder / path_.stem());
  for (int k = 0; k < count_; ++k) {
    replace_file(path_.parent_path() / step_of(k), folder / step_of(k));
  }
  replace_file(path_, target);
  path_ = target;
}

void PvdWriter::write(double time, const Mesh& mesh, const VtuFields& fields) {
  if (!std::isfinite(time)) {
    throw Error(ErrorKind::not_finite, {.file = path_.string()}, fmt::format("time is {}", time));
  }
  const std::filesystem::path step = step_of(count_);
  write_vtu(path_.parent_path() / step, mesh, fields);
  const std::string entry =
      fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, step.string());
  overwrite_end(path_, tail_, entry + std::string(kTail));
  tail_ += static_cast<long>(entry.size());
  ++count_;
}

}  // namespace sinew::mesh
