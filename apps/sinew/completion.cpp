#include "completion.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::cli {

namespace {

using Choices = std::map<std::string, std::vector<std::string>>;

/// Quotes a text with single quotes, for all three shells. @param escape replaces quotes in the
/// text.
std::string quoted(std::string_view text, std::string_view escape) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += escape;
    } else {
      result += c;
    }
  }
  return result + "'";
}

std::string bash_script(const std::vector<CommandWords>& commands, const Choices& choices) {
  std::string names, options, values;
  for (const CommandWords& command : commands) {
    std::string words;
    for (const OptionWords& option : command.options) {
      words += fmt::format("{} ", fmt::join(option.names, " "));
    }
    names += command.name + " ";
    options += fmt::format("    {}) words='{}' ;;\n", command.name, words);
  }
  for (const auto& [option, words] : choices) {
    values += fmt::format("    {}) words='{}' ;;\n", option, fmt::join(words, " "));
  }
  return fmt::format(R"(# Completion of sinew for bash: source <(sinew completion bash)
_sinew() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words=''
  case ${{COMP_WORDS[COMP_CWORD-1]}} in
{}  esac
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    return
  fi
  if [ "$COMP_CWORD" = 1 ]; then
    COMPREPLY=($(compgen -W '{}--help --version' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [ "${{word#-}}" = "$word" ]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  else
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  fi
}}
complete -o filenames -F _sinew sinew
)",
                     values, names, options);
}

/// An argument WORD:DESCRIPTION for zsh's _describe.
std::string zsh_entry(const std::string& word, const std::string& description) {
  std::string plain = word;
  for (std::size_t at = 0; (at = plain.find(':', at)) != std::string::npos; at += 2) {
    plain.insert(at, "\\");
  }
  return quoted(plain + ":" + description, R"('\'')");
}

std::string zsh_script(const std::vector<CommandWords>& commands, const Choices& choices) {
  std::string names, options, values;
  for (const CommandWords& command : commands) {
    std::string words;
    for (const OptionWords& option : command.options) {
      for (const std::string& name : option.names) {
        words += " " + zsh_entry(name, option.description);
      }
    }
    names += " " + zsh_entry(command.name, command.description);
    options += fmt::format("    {}) list=({}) ;;\n", command.name, words);
  }
  for (const auto& [option, words] : choices) {
    values += fmt::format("    {}) compadd -- {}; return ;;\n", option, fmt::join(words, " "));
  }
  return fmt::format(R"(#compdef sinew
# Completion of sinew for zsh: source <(sinew completion zsh), or as a file _sinew in $fpath.
_sinew() {{
  local -a list
  case $words[CURRENT-1] in
{}  esac
  if (( CURRENT == 2 )); then
    list=({})
    [[ $PREFIX == -* ]] && list=('--help:Print the help' '--version:Print the version')
    _describe command list
    return
  fi
  if [[ $PREFIX != -* ]]; then
    _files
    return
  fi
  case $words[2] in
{}  esac
  _describe -o option list
}}
if [[ $funcstack[1] == _sinew ]]; then
  _sinew "$@"
else
  compdef _sinew sinew
fi
)",
                     values, names, options);
}

std::string fish_script(const std::vector<CommandWords>& commands, const Choices& choices) {
  constexpr std::string_view kQuote = R"(\')";
  std::string text =
      "# Completion of sinew for fish: sinew completion fish | source\n"
      "complete -c sinew -e\n"
      "complete -c sinew -n __fish_use_subcommand -f\n"
      "complete -c sinew -n __fish_use_subcommand -l help -d 'Print the help'\n"
      "complete -c sinew -n __fish_use_subcommand -l version -d 'Print the version'\n";
  for (const CommandWords& command : commands) {
    text += fmt::format("complete -c sinew -n __fish_use_subcommand -a {} -d {}\n", command.name,
                        quoted(command.description, kQuote));
    const std::string seen = fmt::format("-n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionWords& option : command.options) {
      std::string words;
      for (const std::string& name : option.names) {
        const bool is_long = name.starts_with("--");
        words += fmt::format(" -{} {}", is_long ? "l" : "s", name.substr(is_long ? 2 : 1));
        const auto found = choices.find(name);
        if (found != choices.end())
          words += fmt::format(" -xa '{}'", fmt::join(found->second, " "));
      }
      text +=
          fmt::format("complete -c sinew {}{}{} -d {}\n", seen, words,
                      option.takes_value && words.find(" -xa ") == std::string::npos ? " -r" : "",
                      quoted(option.description, kQuote));
    }
    const auto arguments = choices.find(command.name);
    if (arguments == choices.end()) continue;
    text += fmt::format("complete -c sinew {} -xa '{}'\n", seen, fmt::join(arguments->second, " "));
  }
  return text;
}

struct Shell {
  const char* name;
  std::string (*script)(const std::vector<CommandWords>&, const Choices&);
};
constexpr std::array<Shell, 3> kShells = {
    {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}}};

}  // namespace

std::span<const char* const> completed_shells() {
  static const auto names = [] {
    std::array<const char*, kShells.size()> list{};
    std::ranges::transform(kShells, list.begin(), &Shell::name);
    return list;
  }();
  return names;
}

std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands,
                              const Choices& choices) {
  for (const auto& [name, script] : kShells) {
    if (shell == name) return script(commands, choices);
  }
  throw Error(ErrorKind::unknown_choice, {.item = "completion"},
              fmt::format("no completion for '{}'", shell),
              fmt::format("use one of {}", fmt::join(completed_shells(), ", ")));
}

}  // namespace sinew::cli
