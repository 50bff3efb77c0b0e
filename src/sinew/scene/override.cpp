#include <algorithm>
#include <charconv>
#include <iterator>

#include <fmt/format.h>

#include "sinew/scene/check.hpp"
#include "sinew/scene/renamed_words.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> steps;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = path.find('.', begin);
    steps.push_back(path.substr(begin, dot - begin));
    if (dot == std::string::npos) return steps;
    begin = dot + 1;
  }
}

// Follows a path through grammar and tree at the same time. The current node may have any of the
// current forms.
class Walker {
 public:
  Walker(Node& scene, Location place)
      : place_(std::move(place)), node_(&scene), forms_({form_of_scene()}) {}

  void enter(const std::string& step, bool last) {
    if (node_->is_list()) {
      enter_item(step);
      return;
    }
    const Form form = map_form(step);
    if (form.shape == Shape::names) {
      enter_name(step, form);
    } else {
      enter_key(step, form, last);
    }
  }

  void write(Node value) { *node_ = std::move(value); }
  const std::vector<Notice>& notices() const { return notices_; }

 private:
  static Form form_of_scene() {
    Form form;
    form.shape = Shape::table;
    // The grammar exists as long as the program, so this pointer does not own it.
    form.table = std::shared_ptr<const KeyTable>(std::shared_ptr<void>(), &grammar());
    return form;
  }

  static bool offers(const Form& form, const Node& node, const std::string& step) {
    if (form.shape == Shape::names) return true;
    if (form.shape == Shape::table) return form.table->find(step) != nullptr;
    if (form.shape != Shape::variants) return false;
    if (step == form.telltale) return true;
    const Node* word = node.find(form.telltale);
    return word != nullptr && table_of(node, form).find(step) != nullptr;
  }

  // Whether all keys of a map belong to a form.
  static bool fits(const Form& form, const Node& node) {
    if (form.shape != Shape::table || !node.is_map()) return true;
    return std::ranges::all_of(node.entries(), [&](const Node::Entry& entry) {
      return form.table->find(entry.key) != nullptr;
    });
  }

  // The map form that has the key `step`, if possible that of the keys that are there; otherwise
  // the first map form, for its error message.
  Form map_form(const std::string& step) {
    const Form* first = nullptr;
    for (const Form& form : forms_) {
      const bool is_map = form.shape == Shape::table || form.shape == Shape::variants;
      if (is_map && offers(form, *node_, step) && fits(form, *node_)) return form;
    }
    for (const Form& form : forms_) {
      const bool is_map =
          form.shape == Shape::table || form.shape == Shape::variants || form.shape == Shape::names;
      if (!is_map) continue;
      if (offers(form, *node_, step)) return form;
      if (first == nullptr) first = &form;
    }
    if (first == nullptr) {
      throw Error(ErrorKind::unknown_key, place_, fmt::format("there is nothing under {}", path_),
                  fmt::format("{} takes {}", path_, describe(forms_)));
    }
    return *first;
  }

  void enter_item(const std::string& step) {
    std::size_t index = 0;
    const auto [end, status] = std::from_chars(step.data(), step.data() + step.size(), index);
    if (status != std::errc() || end != step.data() + step.size() ||
        index >= node_->items().size()) {
      throw Error(ErrorKind::unknown_key, place_,
                  fmt::format("{} is a list, and {} none of its items", path_, show(step)),
                  fmt::format("write a number from 0 to {}",
                              node_->items().empty() ? 0 : node_->items().size() - 1));
    }
    node_ = &node_->items()[index];
    std::vector<Form> items;
    for (const Form& form : forms_) {
      if (form.shape == Shape::list)
        items.insert(items.end(), form.items.begin(), form.items.end());
    }
    forms_ = std::move(items);
    note(step);
  }

  void enter_name(const std::string& step, const Form& form) {
    Node* below = node_->is_map() ? node_->find(step) : nullptr;
    if (below == nullptr) {
      std::vector<std::string> known;
      for (const Node::Entry& entry : node_->entries()) known.push_back(entry.key);
      throw_unknown_name(step, path_, known, place_);
    }
    node_ = below;
    forms_ = form.items;
    note(step);
  }

  void enter_key(const std::string& step, const Form& form, bool last) {
    if (form.shape == Shape::variants && step == form.telltale) {
      forms_ = {};
      descend(step, last);
      return;
    }
    const KeyTable& table = form.shape == Shape::variants ? table_of(*node_, form) : *form.table;
    const Key* key = table.find(step);
    if (key == nullptr) return enter_moved(step, table, last);
    require_one_form(step, table);
    clear_alternatives(step, table);
    forms_ = key->forms;
    descend(step, last);
  }

  // Enters the place to which a key has moved.
  void enter_moved(const std::string& step, const KeyTable& table, bool last) {
    std::string path(moved_key(step, table));
    if (path.empty()) path = current_word(step, table.key_names()).value_or("");
    if (path.empty()) throw_unknown_key(step, table, place_);
    notices_.push_back(moved_notice(step, path, place_));
    const std::vector<std::string> steps = split_path(path);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      enter(steps[i], last && i + 1 == steps.size());
    }
  }

  // Refuses a key of one form beside those of another: a material is given by its name, or by its
  // moduli. What the key would mean for the other form cannot be known.
  void require_one_form(const std::string& step, const KeyTable& table) const {
    if (!node_->is_map()) return;
    for (const Node::Entry& entry : node_->entries()) {
      if (table.find(entry.key) != nullptr) continue;
      for (const Form& form : forms_) {
        if (form.shape != Shape::table || form.table->find(entry.key) == nullptr) continue;
        const std::string written = entry.value.is_scalar() ? " " + entry.value.spelling() : "";
        const bool scales = form.table->find("scale") != nullptr;
        throw Error(
            ErrorKind::conflicting_keys, place_,
            fmt::format("{} is given by its {}{}, which has no {}", path_, entry.key, written,
                        step),
            fmt::format(
                "{}replace all of it: {}={{{}: ...}}",
                scales ? fmt::format("write {0}.scale=1.2 to multiply its stiffness, or ", path_)
                       : "",
                path_, step));
      }
    }
  }

  // Removes the alternatives to `step`, and the keys that require them.
  void clear_alternatives(const std::string& step, const KeyTable& table) {
    const Alternatives* group = table.alternatives_of(step);
    if (group == nullptr) return;
    for (const std::string& other : group->keys) {
      if (other == step || !node_->erase(other)) continue;
      for (const Key& key : table.keys) {
        if (key.only_with == other) node_->erase(key.name);
      }
    }
  }

  // Descends into the value of a key. Makes a map if the path is longer.
  void descend(const std::string& step, bool last) {
    if (!node_->is_map()) *node_ = Node::map();
    Node* below = node_->find(step);
    if (below == nullptr) below = &node_->set(step, Node());
    if (!last && below->is_scalar()) *below = expanded(*below);
    node_ = below;
    note(step);
  }

  // The map equivalent to a scalar. The word of a short form keeps its meaning.
  Node expanded(const Node& scalar) const {
    Node map = Node::map();
    for (const Form& form : forms_) {
      if (form.shape == Shape::choice && !form.telltale.empty() && !scalar.spelling().empty()) {
        map.set(form.telltale, scalar);
      }
    }
    return map;
  }

  void note(const std::string& step) { path_ += (path_.empty() ? "" : ".") + step; }

  Location place_;
  Node* node_;
  std::vector<Form> forms_;
  std::string path_;
  std::vector<Notice> notices_;
};

void absolute_paths(Node& node, const std::vector<Form>& forms,
                    const std::filesystem::path& base_dir);

void absolute_in_map(Node& map, const Form& form, const std::filesystem::path& base_dir) {
  for (Node::Entry& entry : map.entries()) {
    if (form.shape == Shape::names) {
      absolute_paths(entry.value, form.items, base_dir);
    } else if (const Key* key = table_of(map, form).find(entry.key)) {
      absolute_paths(entry.value, key->forms, base_dir);
    }
  }
}

void absolute_paths(Node& node, const std::vector<Form>& forms,
                    const std::filesystem::path& base_dir) {
  const Form form = select_form(node, forms, {});
  if (form.shape == Shape::file) {
    const std::filesystem::path path = read_text(node);
    if (path.is_relative()) {
      Node absolute =
          Node::text(std::filesystem::absolute(base_dir / path).lexically_normal().string());
      absolute.set_place(node.place());
      node = std::move(absolute);
    }
  } else if (form.shape == Shape::list) {
    for (Node& item : node.items()) absolute_paths(item, form.items, base_dir);
  } else if (node.is_map()) {
    absolute_in_map(node, form, base_dir);
  }
}

}  // namespace

std::vector<Notice> apply_override(Node& tree, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error(ErrorKind::bad_argument, {"", 0, 0, "--set"},
                fmt::format("{} is not an assignment", show(assignment)),
                "write a path, '=' and a value: time_step=5ms");
  }
  const std::string path = assignment.substr(0, equals);
  Node value = parse_yaml(assignment.substr(equals + 1), "--set " + path);
  value.name_file("--set");  // the nodes' own paths follow below
  Node changed = tree;
  changed.name_paths();
  std::vector<Notice> notices = replace_old_words(changed);
  Walker walker(changed, {"--set", 0, 0, path});
  const std::vector<std::string> steps = split_path(path);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    walker.enter(steps[i], i + 1 == steps.size());
  }
  walker.write(std::move(value));
  changed.name_paths();
  tree = std::move(changed);
  std::ranges::copy(walker.notices(), std::back_inserter(notices));
  return notices;
}

void resolve_paths(Node& tree, const std::filesystem::path& base_dir) {
  check_scene(tree);
  for (Node::Entry& entry : tree.entries()) {
    absolute_paths(entry.value, grammar().find(entry.key)->forms, base_dir);
  }
}

}  // namespace sinew::scene
