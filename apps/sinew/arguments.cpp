#include "arguments.hpp"

#include <vector>

#include <fmt/format.h>

namespace sinew::cli {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

// The command that was chosen, or the program itself.
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
            fmt::format("'{}' is one argument too many", word),
            fmt::format("see 'sinew {} --help'", name)};
  }
  const std::string option = word.substr(0, word.find('='));
  const auto known = option_names(command);
  const std::string nearest = nearest_word(option, known);
  return {ErrorKind::unknown_option,
          {.item = name},
          fmt::format("there is no option '{}'", option),
          nearest.empty() ? fmt::format("the options are {}", joined(known))
                          : fmt::format("did you mean {}?", nearest)};
}

}  // namespace

double positive_quantity(const std::string& option, const std::string& text, Dimension dimension) {
  const double value = parse_quantity(text, dimension, {.item = option});
  if (value > 0.0) return value;
  throw Error(ErrorKind::out_of_range, {.item = option}, fmt::format("'{}' is not positive", text),
              fmt::format("write for example {}", dimension_example(dimension)));
}

double length_unit(const std::string& option, const std::string& text) {
  return parse_unit(text, dimension::kLength, {.item = option});
}

void require_range(const std::string& option, long value, long low, long high) {
  if (value >= low && value <= high) return;
  throw Error(ErrorKind::out_of_range, {.item = option}, fmt::format("{} is out of range", value),
              fmt::format("write a number from {} to {}", low, high));
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
    throw Error(ErrorKind::bad_argument, {.item = "sinew"}, "a command is missing",
                fmt::format("the commands are {}; see 'sinew --help'", joined(names)));
  }
  const std::string word = argv[1];
  if (word.starts_with("-")) return;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
  }
  const std::string nearest = nearest_word(word, names);
  throw Error(ErrorKind::unknown_option, {.item = "sinew"},
              fmt::format("there is no command '{}'", word),
              nearest.empty() ? fmt::format("the commands are {}", joined(names))
                              : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace sinew::cli
