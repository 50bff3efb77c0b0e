/// @file
/// The program's command line: commands, their options, and what each does. CLI11, which costs
/// seconds in every source that includes it, is named in the source of this header alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sinew::cli {

/// What a chosen command does; returns the exit code.
using Action = std::function<int()>;

/// An option or a positional argument of a command.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required(bool needed = true);
  /// @param name what help calls the value: "FILE".
  Option& type_name(const std::string& name);
  /// @param separator between the values of one argument.
  Option& delimiter(char separator);
  /// @param allowed whether it takes all arguments that follow.
  Option& allow_extra_args(bool allowed);

 private:
  CLI::Option* option_;
};

/// One command. Values are written when the command line is read, and must live until then.
class Command {
 public:
  Command(CLI::App* app, Action* action) : app_(app), action_(action) {}

  /// @param names "-o,--out", or "FILE" for a positional argument. @param value keeps what it holds
  /// unless the option is given. @param help one line.
  /// @{
  Option add_option(const std::string& names, std::string& value, const std::string& help);
  Option add_option(const std::string& names, std::filesystem::path& value,
                    const std::string& help);
  Option add_option(const std::string& names, std::vector<std::string>& value,
                    const std::string& help);
  Option add_option(const std::string& names, std::optional<std::string>& value,
                    const std::string& help);
  Option add_option(const std::string& names, int& value, const std::string& help);
  Option add_option(const std::string& names, std::optional<int>& value, const std::string& help);
  Option add_option(const std::string& names, std::uint64_t& value, const std::string& help);
  Option add_option(const std::string& names, double& value, const std::string& help);
  Option add_option(const std::string& names, std::optional<double>& value,
                    const std::string& help);
  /// @}
  Option add_flag(const std::string& names, bool& value, const std::string& help);
  /// @param text behind the options in the command's help.
  void footer(const std::string& text);
  /// Left out of the program's help.
  void hide();
  /// Takes any arguments, known or not.
  void allow_extras();
  /// @param action what the command does.
  void set_action(Action action);

 private:
  CLI::App* app_;
  Action* action_;
};

/// An option as help tells of it.
struct OptionWords {
  std::vector<std::string> names;  ///< "--out", "-o"
  std::string description;
  bool takes_value = false;
};
/// A command likewise.
struct CommandWords {
  std::string name, description;
  std::vector<OptionWords> options;
};

/// See the file.
class CommandLine {
 public:
  /// @param description,version,footer of the program's help and of --version.
  CommandLine(const std::string& description, const std::string& version,
              const std::string& footer);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// @param name of the command. @param description one line.
  Command add_command(const std::string& name, const std::string& description);

  /// The commands of the program's help, and their options.
  std::vector<CommandWords> commands() const;

  /// Reads the arguments of main() and does what the chosen command does; prints help or version
  /// where that is asked for. Returns the exit code. Throws Error for a wrong command line:
  /// unknown commands and options with the nearest known one, missing and superfluous arguments.
  int run(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
  std::map<const CLI::App*, Action> actions_;
};

}  // namespace sinew::cli
