#include "sinew/scene/suspicious_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "sinew/core/usual_range.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/grammar.hpp"

namespace sinew::scene {

namespace {

// Sections whose numbers are noise, tolerances and settings of solvers.
constexpr std::array kOther = {"sensors", "estimators", "probes", "solver", "record"};

// The largest number of a quantity in a map.
struct Largest {
  double value = 0.0;  // SI
  bool bare = false;   // written without a unit
  std::string written;
  Location place;
};
using Group = std::map<const UsualRange*, Largest>;

// Whether a text of numbers has no unit: "0 0 -100".
bool is_bare(const Node& node) {
  return node.kind() == Node::Kind::number ||
         node.spelling().find_first_not_of("0123456789+-.,eE \t") == std::string::npos;
}

class Finder {
 public:
  explicit Finder(const ReadContext& context) : context_(context) {}

  std::vector<Notice> notices;

  void enter_map(const Node& map, const Form& form) {
    if (form.shape == Shape::names) {
      for (const Node::Entry& entry : map.entries()) enter(entry.value, form.items, nullptr);
      return;
    }
    const KeyTable& table = table_of(map, form);
    Group group;
    for (const Node::Entry& entry : map.entries()) {
      if (const Key* key = table.find(entry.key)) enter(entry.value, key->forms, &group);
    }
    if (table.find("column") != nullptr) take_file(map, form, table, group);
    finish(group);
  }

 private:
  void enter(const Node& node, const std::vector<Form>& forms, Group* group) {
    const Form& form = select_form(node, forms, {});
    if (form.shape == Shape::quantity) {
      if (group != nullptr) take(node, form, *group);
    } else if (form.shape == Shape::samples) {
      for (const Node& pair : node.items()) {
        Form value = form;
        value.shape = Shape::quantity;
        if (pair.items().size() == 2 && group != nullptr) take(pair.items()[1], value, *group);
      }
    } else if (form.shape == Shape::list) {
      for (const Node& item : node.items()) enter(item, form.items, group);
    } else if (node.is_map()) {
      enter_map(node, form);
    }
  }

  static void consider(Group& group, const UsualRange* range, Largest found) {
    Largest& largest = group[range];
    if (found.value > largest.value) largest = std::move(found);
  }

  static void take(const Node& node, const Form& form, Group& group) {
    const UsualRange* range = usual_range(form.usual);
    if (range == nullptr) return;
    double largest = 0.0;
    for (const double value : read_numbers(node, form))
      largest = std::max(largest, std::abs(value));
    const bool bare = node.is_list() ? std::ranges::all_of(node.items(), is_bare) : is_bare(node);
    consider(group, range, {largest, bare, node.spelling(), node.place()});
  }

  // The values of a file of a signal.
  void take_file(const Node& map, const Form& form, const KeyTable& table, Group& group) const {
    const Key* unit = table.find("unit");
    const Node* file = map.find("file");
    if (unit == nullptr || file == nullptr || context_.files == Files::ignore) return;
    const UsualRange* range = usual_range(unit->forms.front().usual);
    if (range == nullptr) return;
    const TimeTable values = read_time_table(Fields(map, form), 1, context_);
    if (values.values.size() == 0) return;
    const double largest = values.values.array().abs().maxCoeff();
    consider(group, range,
             {largest, !values.unit_given, fmt::format("{:g}", largest), file->place()});
  }

  void finish(const Group& group) {
    for (const auto& [range, largest] : group) {
      if (!largest.bare || !is_unusual(*range, largest.value)) continue;
      notices.push_back(unusual_notice(*range, largest.value, largest.written, largest.place));
    }
  }

  const ReadContext& context_;
};

}  // namespace

std::vector<Notice> suspicious_units(const Node& tree, const ReadContext& context) {
  Finder finder(context);
  for (const Node::Entry& entry : tree.entries()) {
    if (std::ranges::find(kOther, entry.key) != kOther.end()) continue;
    const Key* key = grammar().find(entry.key);
    if (key == nullptr || !entry.value.is_map()) continue;
    finder.enter_map(entry.value, select_form(entry.value, key->forms, {}));
  }
  return std::move(finder.notices);
}

}  // namespace sinew::scene
