#include "features.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "sinew/scene/grammar.hpp"

#include "../toys/eigen_solvers.hpp"  // registers solvers
#include "../toys/scene_kinds.hpp"
#include "random.hpp"

namespace sinew::combine {

namespace {

using scene::Form;
using scene::KeyTable;
using scene::Shape;

// Whether a word belongs to a later version.
bool is_later(const KeyTable& table, const std::string& key) {
  const scene::Key* found = table.find(key);
  return found != nullptr && found->later;
}

std::vector<std::string> words(const Form& form) {
  std::vector<std::string> result;
  for (const scene::Choice& choice : form.choices) {
    if (!choice.later) result.push_back(choice.word);
  }
  return result;
}

std::vector<std::string> words(const KeyTable& table, std::string_view key) {
  return words(form_of(table, key, Shape::choice));
}

// The variants form that a key selects.
const Form& variants(const std::vector<Form>& forms, std::string_view telltale) {
  const auto found = std::ranges::find_if(forms, [&](const Form& form) {
    return form.shape == Shape::variants && form.telltale == telltale;
  });
  if (found == forms.end()) {
    throw std::logic_error("the grammar has no variants by " + std::string(telltale));
  }
  return *found;
}

// The forms of the entries in a section.
const std::vector<Form>& items(std::string_view section) {
  return form_of(scene::grammar(), section, Shape::names).items;
}

// The registered kinds of a section that this generator does not know. It writes them from the
// examples of their keys.
std::vector<std::string> other_kinds(std::string_view section,
                                     const std::vector<std::string>& known) {
  std::vector<std::string> kinds = words(variants(items(section), "type"));
  std::erase_if(kinds, [&](const std::string& kind) {
    return std::ranges::find(known, kind) != known.end();
  });
  return kinds;
}

// The alternatives of `key`, including itself.
std::vector<std::string> alternatives(const KeyTable& table, std::string_view key) {
  const scene::Alternatives* group = table.alternatives_of(key);
  if (group == nullptr) {
    throw std::logic_error(table.name + " has no alternatives to " + std::string(key));
  }
  std::vector<std::string> result;
  for (const std::string& word : group->keys) {
    if (!is_later(table, word)) result.push_back(word);
  }
  return result;
}

const KeyTable& map_of(const KeyTable& table, std::string_view key) {
  return *form_of(table, key, Shape::table).table;
}

std::vector<std::string> or_none(std::vector<std::string> levels) {
  levels.insert(levels.begin(), "none");
  return levels;
}

// Levels in addition to the words of the grammar, such as a default, or without some of them.
std::vector<std::string> with(std::vector<std::string> levels,
                              std::initializer_list<const char*> more) {
  levels.insert(levels.end(), more.begin(), more.end());
  return levels;
}

std::vector<std::string> without(std::vector<std::string> levels, std::string_view word) {
  std::erase(levels, word);
  return levels;
}

// Of the toys' kinds, it has those of bodies and actuators.
std::vector<Feature> list_features() {
  const KeyTable& solver = map_of(scene::grammar(), "solver");
  const KeyTable& fem = variant_table("bodies", "fem");
  const KeyTable& cable = variant_table("actuators", "cable");
  const KeyTable& chamber = variant_table("actuators", "chamber");
  const KeyTable& force = variant_table("actuators", "force");
  const KeyTable& torque = variant_table("actuators", "torque");
  const KeyTable& spring = variant_table("actuators", "spring");
  const KeyTable& effector = *items("effectors").front().table;
  const KeyTable& probe = *items("probes").front().table;
  const KeyTable& contact = *items("contacts").front().table;
  const KeyTable& signal = map_of(map_of(cable, "command"), "tension");
  const KeyTable& controller = variant_table("controllers", "inverse");
  const KeyTable& weld = variant_table("joints", "weld");
  const KeyTable& rigid = variant_table("bodies", "rigid");
  const KeyTable& motor = variant_table("actuators", "motor");
  const std::vector<std::string> switched{"none", "yes"};
  return {
      {"bodies", {"fem", "pcc", "fem fem", "fem pcc", "pcc fem"}},
      // A trunk has too many nodes for a test of a thousand scenes, and a ball has no ends.
      {"mesh",
       without(without(words(variants(fem.find("mesh")->forms, "shape")), "trunk"), "sphere")},
      {"element", or_none(words(fem, "element"))},
      {"material", with(words(variants(fem.find("material")->forms, "model")), {"ecoflex-00-30"})},
      {"history", {"none", "viscosity", "softening"}},
      {"mass_matrix", words(fem, "mass_matrix")},
      {"damping", switched},
      {"gravity", switched},
      {"velocity", switched},
      {"motion", switched},
      {"integrator", words(scene::grammar(), "integrator")},
      {"method", words(solver, "method")},
      {"tangent", words(solver, "tangent")},
      {"adaptive", switched},
      {"factorisation", words(solver, "factorisation")},
      {"ordering", words(solver, "ordering")},
      {"cable", or_none(with(alternatives(map_of(cable, "command"), "tension"), {"untold"}))},
      {"cable_signal", with(without(alternatives(signal, "ramp"), "file"), {"value"})},
      {"cable_pull", words(cable, "pull")},
      {"cable_friction", switched},
      {"cable_guides", {"none", "radius", "spacing"}},
      {"cable_stiffness", switched},
      {"second_cable", {"none", "twin", "antagonist"}},
      {"chamber", or_none(alternatives(map_of(chamber, "command"), "pressure"))},
      {"medium", or_none(alternatives(chamber, "gas"))},
      {"spring", or_none(with(alternatives(spring, "stiffness"), {"coil", "band"}))},
      {"force", or_none(alternatives(map_of(force, "command"), "force"))},
      {"torque", or_none(alternatives(map_of(torque, "command"), "torque"))},
      {"load", or_none(without(words(variants(items("loads"), "type")), "couple"))},
      {"mass", switched},
      // Contact with a fixed surface, a passing rigid or soft body, the body itself, or a rigid
      // body of shape plane.
      {"contact", or_none(with(alternatives(map_of(contact, "surface"), "plane"),
                               {"body", "soft", "self", "ground"}))},
      {"contact_friction", switched},
      {"contact_motion", switched},
      // A link on any body, held by its joint only. A weld holds a soft link, and its levels are
      // the kinds of weld; other joints hold a rigid link, and their levels are its shape and
      // motor.
      {"link", or_none(words(variants(items("joints"), "type")))},
      {"link_shape", without(alternatives(map_of(rigid, "shape"), "box"), "plane")},
      {"motor", or_none(alternatives(map_of(motor, "command"), "angle"))},
      {"joint_limits", switched},
      {"joint_friction", switched},
      {"weld", with(alternatives(weld, "region"), {"touching"})},
      {"cable_end", {"own", "link"}},
      {"effector", or_none(without(alternatives(effector, "point"), "points"))},
      {"probe", or_none(without(alternatives(probe, "point"), "points"))},
      {"sensor", or_none(without(words(variants(items("sensors"), "type")), "speedometer"))},
      // With feedback, a closed loop replaces it. The toys' own law is tested beside them.
      {"controller",
       or_none(without(without(words(variants(items("controllers"), "type")), "closed-loop"),
                       "proportional"))},
      {"regularisation", words(map_of(controller, "regularisation"), "of")},
      {"membrane", switched},
      {"contact_zones", switched},
      {"kinetic_friction", switched},
      {"force_task", {"none", "force", "limits", "reserve"}},
      {"feedback", switched},
      {"estimator", {"none", "force", "effort", "stiffness"}},
      {"equilibrium", or_none(words(solver, "equilibrium"))},
      {"ambient", switched},
      {"other_body", or_none(other_kinds("bodies", {"fem", "pcc", "rigid", "urdf"}))},
      {"other_actuator", or_none(other_kinds("actuators", {"cable", "force", "torque", "motor",
                                                           "linear-motor", "chamber", "spring"}))},
  };
}

int find_feature(std::string_view name) {
  const auto& all = features();
  const auto found =
      std::ranges::find_if(all, [&](const Feature& feature) { return feature.name == name; });
  if (found == all.end()) throw std::logic_error("no feature is called " + std::string(name));
  return static_cast<int>(found - all.begin());
}

// Whether this version refuses two levels together: event-driven integration repeats parts of
// steps, by Newton's method.
bool is_refused(int first, int first_level, int second, int second_level) {
  const auto is = [&](int feature, int chosen, std::string_view name, std::string_view wanted) {
    const Feature& of = features()[static_cast<std::size_t>(feature)];
    const std::string& own = of.levels[static_cast<std::size_t>(chosen)];
    return of.name == name && (wanted.empty() ? own != "none" : own == wanted);
  };
  const auto both = [&](std::string_view a, std::string_view a_level, std::string_view b,
                        std::string_view b_level) {
    return (is(first, first_level, a, a_level) && is(second, second_level, b, b_level)) ||
           (is(first, first_level, b, b_level) && is(second, second_level, a, a_level));
  };
  return both("integrator", "event-driven", "adaptive", "yes") ||
         both("integrator", "event-driven", "method", "one-linearisation") ||
         both("integrator", "event-driven", "controller", "");
}

// Pairs of levels of two features that no selection has covered yet.
class OpenPairs {
 public:
  OpenPairs() {
    const auto& all = features();
    for (const Feature& feature : all) {
      first_.push_back(count_);
      count_ += static_cast<int>(feature.levels.size());
    }
    open_.assign(static_cast<std::size_t>(count_) * static_cast<std::size_t>(count_), 0);
    for (int a = 0; a < static_cast<int>(all.size()); ++a) {
      for (int b = 0; b < a; ++b) {
        for (int i = 0; i < size(a); ++i) {
          for (int j = 0; j < size(b); ++j) mark(a, i, b, j, is_refused(a, i, b, j) ? 0 : 1);
        }
      }
    }
  }

  int left() const { return left_; }

  // Number of uncovered pairs that a level would cover with the levels chosen so far (others are
  // -1); -1 if one of them refuses it.
  int gain(const Selection& selection, int feature, int wanted) const {
    int sum = 0;
    for (int other = 0; other < static_cast<int>(selection.size()); ++other) {
      const int chosen = selection[static_cast<std::size_t>(other)];
      if (other == feature || chosen < 0) continue;
      if (is_refused(feature, wanted, other, chosen)) return -1;
      sum += open_[at(feature, wanted, other, chosen)];
    }
    return sum;
  }

  // Any uncovered pair, as the start of a selection: {feature, level, feature, level}.
  std::array<int, 4> some() const {
    const int features_count = static_cast<int>(first_.size());
    for (int a = 0; a < features_count; ++a) {
      for (int b = 0; b < a; ++b) {
        for (int i = 0; i < size(a); ++i) {
          for (int j = 0; j < size(b); ++j) {
            if (open_[at(a, i, b, j)] != 0) return {a, i, b, j};
          }
        }
      }
    }
    return {-1, -1, -1, -1};
  }

  void close(const Selection& selection) {
    for (int a = 0; a < static_cast<int>(selection.size()); ++a) {
      for (int b = 0; b < a; ++b) {
        mark(a, selection[static_cast<std::size_t>(a)], b, selection[static_cast<std::size_t>(b)],
             0);
      }
    }
  }

 private:
  static int size(int feature) {
    return static_cast<int>(features()[static_cast<std::size_t>(feature)].levels.size());
  }
  std::size_t at(int a, int i, int b, int j) const {
    const int row = first_[static_cast<std::size_t>(a)] + i;
    const int column = first_[static_cast<std::size_t>(b)] + j;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(count_) +
           static_cast<std::size_t>(column);
  }
  void mark(int a, int i, int b, int j, char open) {
    char& here = open_[at(a, i, b, j)];
    left_ += open - here;
    here = open_[at(b, j, a, i)] = open;
  }

  std::vector<int> first_;  // index of each feature's first level
  int count_ = 0;
  int left_ = 0;
  std::vector<char> open_;
};

}  // namespace

const KeyTable& variant_table(std::string_view section, std::string_view word) {
  for (const scene::Choice& choice : variants(items(section), "type").choices) {
    if (choice.word == word) return *choice.table;
  }
  throw std::logic_error("the grammar has no " + std::string(section) + " of type " +
                         std::string(word));
}

const std::vector<Feature>& features() {
  static const std::vector<Feature> all = (testing::register_toys(), list_features());
  return all;
}

const std::string& level(const Selection& selection, std::string_view feature) {
  const auto index = static_cast<std::size_t>(find_feature(feature));
  return features()[index].levels[static_cast<std::size_t>(selection[index])];
}

void set_level(Selection& selection, std::string_view feature, std::string_view wanted) {
  const auto index = static_cast<std::size_t>(find_feature(feature));
  const std::vector<std::string>& levels = features()[index].levels;
  const auto found = std::ranges::find(levels, wanted);
  if (found == levels.end()) throw std::logic_error("no level " + std::string(wanted));
  selection[index] = static_cast<int>(found - levels.begin());
}

std::vector<Selection> pairwise_cover() {
  OpenPairs open;
  Random random(1);
  std::vector<Selection> cover;
  while (open.left() > 0) {
    Selection selection(features().size(), -1);
    const auto [a, i, b, j] = open.some();
    selection[static_cast<std::size_t>(a)] = i;
    selection[static_cast<std::size_t>(b)] = j;
    std::vector<int> order(selection.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    random.shuffle(order);
    for (const int feature : order) {
      int& chosen = selection[static_cast<std::size_t>(feature)];
      if (chosen >= 0) continue;
      const int count =
          static_cast<int>(features()[static_cast<std::size_t>(feature)].levels.size());
      const int start = random.below(count);  // a random choice among equals
      int most = -1, best = 0;
      for (int k = 0; k < count; ++k) {
        const int candidate = (start + k) % count;
        const int gain = open.gain(selection, feature, candidate);
        if (gain > most) std::tie(most, best) = std::pair(gain, candidate);
      }
      chosen = best;
    }
    open.close(selection);
    cover.push_back(std::move(selection));
  }
  return cover;
}

bool is_refused(const Selection& selection) {
  for (std::size_t a = 0; a < selection.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (is_refused(static_cast<int>(a), selection[a], static_cast<int>(b), selection[b])) {
        return true;
      }
    }
  }
  return false;
}

Selection random_selection(std::uint64_t seed) {
  Random random(seed);
  Selection selection;
  for (const Feature& feature : features()) {
    const int count = static_cast<int>(feature.levels.size());
    const bool absent = feature.levels.front() == "none" && random.below(2) == 0;
    selection.push_back(absent ? 0 : random.below(count));
  }
  return selection;
}

}  // namespace sinew::combine
