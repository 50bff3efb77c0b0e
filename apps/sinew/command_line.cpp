#include "command_line.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::cli {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    std::ranges::move(names_of(*option), std::back_inserter(names));
  }
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

// The chosen command, or the program itself.
const CLI::App& chosen(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

Error superfluous(const CLI::App& app, const std::string& word) {
  const CLI::App& command = chosen(app);
  const std::string name = command.get_name();
  if (!word.starts_with("-") || word == "-") {
    return {ErrorKind::bad_argument,
            {.item = name},
            fmt::format("unexpected argument '{}'", word),
            fmt::format("see 'sinew {} --help'", name)};
  }
  const std::string option = word.substr(0, word.find('='));
  const auto known = option_names(command);
  const std::string nearest = nearest_word(option, known);
  return {ErrorKind::unknown_option,
          {.item = name},
          fmt::format("unknown option '{}'", option),
          nearest.empty() ? fmt::format("the options are {}", joined(known))
                          : fmt::format("did you mean {}?", nearest)};
}

Error argument_error(const CLI::App& app, const CLI::ParseError& problem) {
  if (dynamic_cast<const CLI::ExtrasError*>(&problem) != nullptr) {
    const auto rest = app.remaining(true);
    if (!rest.empty()) return superfluous(app, rest.front());
  }
  const CLI::App& command = chosen(app);
  const std::string help = &command == &app ? "" : command.get_name() + " ";
  return {ErrorKind::bad_argument,
          {.item = command.get_name()},
          problem.what(),
          fmt::format("see 'sinew {}--help'", help)};
}

void require_command(const CLI::App& app, int argc, const char* const* argv) {
  const auto names = command_names(app);
  if (argc < 2) {
    throw Error(ErrorKind::bad_argument, {.item = "sinew"}, "no command given",
                fmt::format("the commands are {}; see 'sinew --help'", joined(names)));
  }
  const std::string word = argv[1];
  if (word.starts_with("-")) return;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
  }
  const std::string nearest = nearest_word(word, names);
  throw Error(ErrorKind::unknown_option, {.item = "sinew"},
              fmt::format("unknown command '{}'", word),
              nearest.empty() ? fmt::format("the commands are {}", joined(names))
                              : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace

Option& Option::required(bool needed) {
  option_->required(needed);
  return *this;
}
Option& Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}
Option& Option::delimiter(char separator) {
  option_->delimiter(separator);
  return *this;
}
Option& Option::allow_extra_args(bool allowed) {
  option_->allow_extra_args(allowed);
  return *this;
}

Option Command::add_option(const std::string& names, std::string& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::filesystem::path& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::vector<std::string>& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::optional<std::string>& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, int& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::optional<int>& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::uint64_t& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, double& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_option(const std::string& names, std::optional<double>& value,
                           const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}
void Command::footer(const std::string& text) { app_->footer(text); }
void Command::hide() { app_->group(""); }
void Command::allow_extras() { app_->allow_extras(); }
void Command::set_action(Action action) { *action_ = std::move(action); }

CommandLine::CommandLine(const std::string& description, const std::string& version,
                         const std::string& footer)
    : app_(std::make_unique<CLI::App>(description, "sinew")) {
  app_->set_version_flag("--version", version);
  app_->footer(footer);
  app_->require_subcommand(0, 1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::add_command(const std::string& name, const std::string& description) {
  CLI::App* command = app_->add_subcommand(name, description);
  return {command, &actions_[command]};
}

std::vector<CommandWords> CommandLine::commands() const {
  std::vector<CommandWords> result;
  for (const CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    CommandWords words{command->get_name(), command->get_description(), {}};
    for (const CLI::Option* option : command->get_options()) {
      std::vector<std::string> names = names_of(*option);
      if (names.empty()) continue;  // a positional argument
      words.options.push_back(
          {std::move(names), option->get_description(), option->get_items_expected_max() > 0});
    }
    result.push_back(std::move(words));
  }
  return result;
}

int CommandLine::run(int argc, const char* const* argv) {
  require_command(*app_, argc, argv);
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app_->exit(asked);
  } catch (const CLI::ParseError& problem) {
    throw argument_error(*app_, problem);
  }
  return actions_.at(app_->get_subcommands().front())();
}

}  // namespace sinew::cli
