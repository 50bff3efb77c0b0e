#include "sinew/core/process.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sinew/core/error.hpp"

namespace sinew {

namespace {

/// Redirects standard output and error to the pipe, and standard input from /dev/null.
class FileActions {
 public:
  explicit FileActions(int pipe_end) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, pipe_end, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, pipe_end, STDERR_FILENO);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0 || (got < 0 && errno != EINTR)) return text;
  }
}

int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

bool program_exists(const std::string& program) {
  if (program.find('/') != std::string::npos) return access(program.c_str(), X_OK) == 0;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder) / program;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0) {
      return true;
    }
  }
  return false;
}

ProcessResult run_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw Error(ErrorKind::tool_failed, {.item = arguments.at(0)}, std::strerror(errno));
  }
  const FileActions actions(ends[1]);
  pid_t process = 0;
  const int problem = posix_spawnp(&process, argv[0], actions.get(), nullptr, argv.data(), environ);
  close(ends[1]);
  if (problem != 0) {
    close(ends[0]);
    throw Error(ErrorKind::tool_missing, {.item = arguments.at(0)},
                fmt::format("the program cannot be started: {}", std::strerror(problem)),
                fmt::format("install it: apt-get install {}", arguments.at(0)));
  }
  ProcessResult result;
  result.output = read_all(ends[0]);
  close(ends[0]);
  result.exit_code = wait_for(process);
  return result;
}

std::string last_lines(const std::string& text, int count) {
  std::size_t end = text.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return {};
  std::size_t begin = end + 1;
  for (int k = 0; k < count && begin != std::string::npos && begin > 0; ++k) {
    begin = text.rfind('\n', begin - 1);
  }
  begin = begin == std::string::npos ? 0 : begin + (text[begin] == '\n' ? 1 : 0);
  return text.substr(begin, end + 1 - begin);
}

}  // namespace sinew
