/// @file
/// The command line of the program: commands, their options and actions. Only the source of this
/// header includes CLI11, which adds seconds to the compilation of every source that includes it.
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

/// The action of a command; returns the exit code.
using Action = std::function<int()>;

/// An option or a positional argument of a command.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required(bool needed = true);
  /// @param name of the value in the help: "FILE".
  Option& type_name(const std::string& name);
  /// @param separator of the values in one argument.
  Option& delimiter(char separator);
  /// @param allowed whether the option takes all arguments that follow.
  Option& allow_extra_args(bool allowed);

 private:
  CLI::Option* option_;
};

/// A command. Values of its options are set when the command line is parsed, and must exist until
/// then.
class Command {
 public:
  Command(CLI::App* app, Action* action) : app_(app), action_(action) {}

  /// Adds an option. @param names "-o,--out", or "FILE" for a positional argument. @param value
  /// unchanged unless the option is given. @param help one line.
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
  /// Sets the text after the options in the command's help. @param text of any length.
  void footer(const std::string& text);
  /// Hides the command in the program's help.
  void hide();
  /// Accepts unknown arguments.
  void allow_extras();
  /// Sets the action of the command. @param action called if the command is chosen.
  void set_action(Action action);

 private:
  CLI::App* app_;
  Action* action_;
};

/// An option as described in the help.
struct OptionWords {
  std::vector<std::string> names;  ///< "--out", "-o"
  std::string description;
  bool takes_value = false;
};
/// A command as described in the help.
struct CommandWords {
  std::string name, description;
  std::vector<OptionWords> options;
};

/// The command line of the program.
class CommandLine {
 public:
  /// @param description,version,footer texts of the help and of --version.
  CommandLine(const std::string& description, const std::string& version,
              const std::string& footer);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Adds a command. @param name of the command. @param description one line.
  Command add_command(const std::string& name, const std::string& description);

  /// The commands in the program's help, with their options.
  std::vector<CommandWords> commands() const;

  /// Parses the arguments of main() and runs the chosen command, or prints the help or version.
  /// Returns the exit code. Throws Error for an invalid command line: unknown commands and options
  /// (naming the nearest known one), missing and superfluous arguments.
  int run(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
  std::map<const CLI::App*, Action> actions_;
};

}  // namespace sinew::cli
