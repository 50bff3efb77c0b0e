#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/error.hpp"

#include "commands.hpp"

namespace sinew::cli {

int validate(const std::vector<std::string>& arguments) {
  const char* folder = std::getenv("SINEW_VALIDATION_DIR");
  const std::string script =
      (std::filesystem::path(folder != nullptr ? folder : SINEW_VALIDATION_DIR) / "run.py")
          .string();
  if (!std::filesystem::exists(script)) {
    throw Error(ErrorKind::tool_missing, {.file = script}, "the validation suite is not here",
                "it comes with the sources; set SINEW_VALIDATION_DIR to their validation folder");
  }
  if (std::getenv("PYTHONPATH") == nullptr) setenv("PYTHONPATH", SINEW_PYTHON_DIR, 0);
  setenv("MPLBACKEND", "Agg", 0);
  std::vector<char*> words = {const_cast<char*>(SINEW_PYTHON), const_cast<char*>(script.c_str())};
  for (const auto& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(SINEW_PYTHON, words.data());
  throw Error(ErrorKind::tool_missing, {.file = SINEW_PYTHON},
              fmt::format("cannot start Python: {}", std::strerror(errno)),
              "install it with `apt-get install python3`");
}

}  // namespace sinew::cli
