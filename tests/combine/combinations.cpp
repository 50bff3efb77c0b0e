// Tries thousands of combinations of features, each in its own process, so that a crash counts as
// one outcome.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <string>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene_draft.hpp"
#include "trial.hpp"

namespace {

using namespace sinew::combine;

constexpr const char* kUsage =
    "combinations [--from SEED] [--count N]       random selections (300)\n"
    "combinations --pairs [--from K] [--count N]  the cover of all pairs of levels\n"
    "combinations --symmetric [--from SEED] [--count N]  symmetric robots of random selections\n"
    "combinations --changed [--from SEED] [--count N]  states of random scenes with a changed "
    "number\n"
    "combinations [--pairs | --symmetric] [--known] --print SEED   the scene of a seed; --known: "
    "without the kinds of tests/toys, for programs that do not know them\n";

enum class Trial { scene, symmetric, changed };

// "KIND|CAUSE|CONDITION".
std::string try_here(Trial trial, const Selection& selection, std::uint64_t seed) {
  if (trial == Trial::changed) {
    const std::string defect = try_changed_number(selection, seed);
    return defect.empty() ? "ran||solved" : "wrong|" + defect + "|";
  }
  const Outcome outcome =
      trial == Trial::symmetric ? try_symmetric_scene(selection, seed) : try_scene(selection, seed);
  return fmt::format("{}|{}|{}", outcome_name(outcome.kind), outcome.cause, outcome.condition);
}

// Tries a scene in a child process. A crash is also an outcome.
std::string try_apart(Trial trial, const Selection& selection, std::uint64_t seed) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    const std::string text = try_here(trial, selection, seed);
    if (write(ends[1], text.data(), text.size()) < 0) std::abort();
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return fmt::format("crashed|{}|", strsignal(WTERMSIG(status)));
  return text;
}

}  // namespace

int main(int count, char** words) {
  std::uint64_t from = 0, printed = 0;
  int number = 300;
  bool pairs = false, prints = false, known = false;
  Trial trial = Trial::scene;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const bool has_value = k + 1 < count;
    if (word == "--pairs") {
      pairs = true;
    } else if (word == "--symmetric") {
      trial = Trial::symmetric;
    } else if (word == "--changed") {
      trial = Trial::changed;
    } else if (word == "--known") {
      known = true;
    } else if (word == "--from" && has_value) {
      from = std::stoull(words[++k]);
    } else if (word == "--count" && has_value) {
      number = std::stoi(words[++k]);
    } else if (word == "--print" && has_value) {
      prints = true;
      printed = std::stoull(words[++k]);
    } else {
      (word == "--help" ? std::cout : std::cerr) << kUsage;
      return word == "--help" ? 0 : 2;
    }
  }
  if (prints) {
    Selection selection = pairs ? pairwise_cover().at(printed) : random_selection(printed);
    if (known) {
      set_level(selection, "other_body", "none");
      set_level(selection, "other_actuator", "none");
      set_level(selection, "factorisation", "block");
    }
    std::cout << write_scene(trial == Trial::symmetric ? draft_symmetric_scene(selection, printed)
                                                       : draft_scene(selection, printed));
    return 0;
  }
  const std::vector<Selection> cover = pairs ? pairwise_cover() : std::vector<Selection>{};
  if (pairs)
    number = std::min(number, static_cast<int>(cover.size() - std::min(cover.size(), from)));
  std::map<std::string, int> sums;
  for (int k = 0; k < number; ++k) {
    const std::uint64_t seed = from + static_cast<std::uint64_t>(k);
    const Selection selection =
        pairs ? cover[static_cast<std::size_t>(seed)] : random_selection(seed);
    const std::string outcome = try_apart(trial, selection, seed);
    ++sums[outcome.substr(0, outcome.find('|'))];
    if (!outcome.starts_with("ran||solved")) std::cout << seed << ' ' << outcome << std::endl;
  }
  for (const auto& [kind, sum] : sums) std::cout << fmt::format("{:6} {}\n", sum, kind);
  return 0;
}
