#include "sinew/scene/check.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "sinew/scene/renamed_words.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

class Checker {
 public:
  explicit Checker(const Node& scene) : scene_(scene) {}

  // Checks a map. @param extra telltale key of a variants form, which is not in the table.
  void check_map(const Node& map, const KeyTable& table, const std::string& extra) {
    for (const Node::Entry& entry : map.entries()) {
      if (entry.key == extra) continue;
      const Key* key = table.find(entry.key);
      if (key == nullptr) throw_unknown_key(entry.key, table, entry.key_place);
      if (key->later) {
        throw_later(fmt::format("'{}' ({})", key->name, key->description), "remove it",
                    entry.key_place);
      }
      check_company(map, table, *key, entry.key_place);
      check_value(entry.value, key->forms, key->example);
    }
    check_required(map, table);
  }

  void check_value(const Node& node, const std::vector<Form>& forms, const std::string& example) {
    const Form& form = select_form(node, forms, example);
    switch (form.shape) {
      case Shape::quantity:
        read_numbers(node, form);
        return;
      case Shape::unit:
        read_unit(node, form);
        return;
      case Shape::integer:
        read_integer(node, form);
        return;
      case Shape::boolean:
        node.as_boolean();
        return;
      case Shape::choice:
        read_choice(node, form);
        return;
      case Shape::text:
      case Shape::file:
        read_text(node);
        return;
      case Shape::reference:
        if (std::ranges::find(form.choices, read_text(node), &Choice::word) != form.choices.end()) {
          return;
        }
        check_name(read_text(node), form.refers_to, node.place());
        if (form.refers_to == "bodies" && !form.takes_planes) refuse_plane(node);
        return;
      case Shape::samples:
        read_samples(node, form);
        return;
      case Shape::list:
        check_list(node, form, example);
        return;
      case Shape::names:
        check_names(node, form, example);
        return;
      case Shape::table:
      case Shape::variants:
        check_map(node, table_of(node, form),
                  form.shape == Shape::variants ? form.telltale : std::string());
        return;
    }
  }

 private:
  // Checks keys that exclude each other, and keys that require another key.
  void check_company(const Node& map, const KeyTable& table, const Key& key,
                     const Location& place) {
    if (!key.only_with.empty() && map.find(key.only_with) == nullptr) {
      throw Error(ErrorKind::conflicting_keys, place,
                  fmt::format("'{}' without '{}'", key.name, key.only_with),
                  fmt::format("add {}, or remove {}", key.only_with, key.name));
    }
    const Alternatives* group = table.alternatives_of(key.name);
    if (group == nullptr) return;
    for (const std::string& other : group->keys) {
      if (other == key.name) return;  // reported at the later of the two in the table
      if (map.find(other) == nullptr) continue;
      throw Error(ErrorKind::conflicting_keys, place,
                  fmt::format("'{}' and '{}' exclude each other", other, key.name),
                  "keep one of the two");
    }
  }

  static void check_required(const Node& map, const KeyTable& table) {
    for (const Key& key : table.keys) {
      if (!key.required || map.find(key.name) != nullptr) continue;
      throw Error(ErrorKind::missing_key, map.place(),
                  fmt::format("'{}' is missing in {}", key.name, table.name),
                  fmt::format("add for example {}: {}", key.name, key.example));
    }
    for (const Alternatives& group : table.alternatives) {
      if (!group.required) continue;
      const auto stands = [&](const std::string& key) { return map.find(key) != nullptr; };
      if (std::any_of(group.keys.begin(), group.keys.end(), stands)) continue;
      throw Error(ErrorKind::missing_key, map.place(),
                  fmt::format("one of {} is missing in {}", join(group.keys), table.name),
                  fmt::format("add for example {}: {}", group.keys.front(),
                              table.find(group.keys.front())->example));
    }
  }

  void check_list(const Node& node, const Form& form, const std::string& example) {
    const auto count = static_cast<int>(node.items().size());
    if (count == 0) {
      throw Error(ErrorKind::empty_list, node.place(), "the list is empty",
                  fmt::format("write for example {}", example));
    }
    for (const Node& item : node.items()) check_value(item, form.items, example);
    if (count >= form.min_count && count <= form.max_count) return;
    const std::string wanted = form.min_count == form.max_count ? fmt::format("{}", form.min_count)
                               : form.max_count < (1 << 20)
                                   ? fmt::format("{} to {}", form.min_count, form.max_count)
                                   : fmt::format("at least {}", form.min_count);
    throw Error(ErrorKind::wrong_length, node.place(),
                fmt::format("the list has {} items instead of {}", count, wanted),
                fmt::format("write for example {}", example));
  }

  void check_names(const Node& node, const Form& form, const std::string& example) {
    if (static_cast<int>(node.entries().size()) < form.min_count) {
      throw Error(ErrorKind::empty_list, node.place(), "the map is empty",
                  fmt::format("write for example {}", example));
    }
    for (const Node::Entry& entry : node.entries()) {
      check_spelling(entry);
      if (!form.refers_to.empty()) check_name(entry.key, form.refers_to, entry.key_place);
      check_value(entry.value, form.items, example);
    }
  }

  // Names appear in dotted paths, in column headings and in file names.
  static void check_spelling(const Node::Entry& entry) {
    const auto allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    };
    if (!entry.key.empty() && std::all_of(entry.key.begin(), entry.key.end(), allowed)) return;
    throw Error(ErrorKind::bad_argument, entry.key_place,
                fmt::format("{} is not a name", show(entry.key)),
                "write names with letters, digits, '_' and '-'");
  }

  void check_name(const std::string& name, const std::string& section, const Location& place) {
    auto [found, is_new] = names_.try_emplace(section);
    if (is_new) {
      for (std::string& known : names_under(scene_, section))
        found->second.insert(std::move(known));
    }
    if (found->second.contains(name) || is_part_of_robot(name, section)) return;
    if (section == "contacts" && is_pair_of_all(name)) return;
    throw_unknown_name(name, section, names_under(scene_, section), place);
  }

  void refuse_plane(const Node& name) const {
    const Node* body = scene_.find("bodies")->find(name.spelling());
    const Node* shape = body != nullptr && body->is_map() ? body->find("shape") : nullptr;
    if (shape == nullptr || !shape->is_map() || shape->find("plane") == nullptr) return;
    throw Error(ErrorKind::wrong_type, name.place(),
                fmt::format("{} is a plane, which only contacts can name", show(name.spelling())),
                "name another body, or make it a box");
  }

  // Whether a name may be ROBOT.LINK or ROBOT.JOINT. expand_urdf() checks the second part.
  bool is_part_of_robot(const std::string& name, const std::string& section) const {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos || (section != "bodies" && section != "joints")) return false;
    const Node* bodies = scene_.find("bodies");
    const Node* robot = bodies != nullptr ? bodies->find(name.substr(0, dot)) : nullptr;
    const Node* type = robot != nullptr && robot->is_map() ? robot->find("type") : nullptr;
    return type != nullptr && type->spelling() == "urdf";
  }

  // Whether a name may be ENTRY-FIRST-SECOND of a `between: all`. contact_pairs() finds the pairs.
  bool is_pair_of_all(const std::string& name) const {
    const Node* contacts = scene_.find("contacts");
    if (contacts == nullptr) return false;
    return std::ranges::any_of(contacts->entries(), [&](const Node::Entry& entry) {
      const Node* between = entry.value.is_map() ? entry.value.find("between") : nullptr;
      return between != nullptr && between->spelling() == "all" &&
             name.starts_with(entry.key + "-");
    });
  }

  const Node& scene_;
  std::map<std::string, std::set<std::string>> names_;
};

void check_version(const Node& tree) {
  const Node* version = tree.find("sinew");
  if (version == nullptr || version->kind() != Node::Kind::number) return;
  if (version->as_number() == 1.0) return;
  throw Error(ErrorKind::unsupported_version, version->place(),
              fmt::format("scene format {} is not known", version->spelling()),
              "this version reads sinew: 1");
}

}  // namespace

void check_scene(const Node& tree) {
  if (!tree.is_map()) {
    throw Error(ErrorKind::wrong_type, tree.place(),
                fmt::format("a scene is a map, not {}", node_kind_name(tree.kind())),
                "begin with the line sinew: 1");
  }
  check_version(tree);
  Checker(tree).check_map(tree, grammar(), {});
}

void check_value(const Node& node, const std::vector<Form>& forms) {
  Checker(node).check_value(node, forms, "");
}

const KeyTable& table_of(const Node& map, const Form& form) {
  if (form.shape == Shape::table) return *form.table;
  const Node* word = map.find(form.telltale);
  if (word == nullptr) {
    std::vector<std::string> words;
    for (const Choice& choice : form.choices) {
      if (!choice.later) words.push_back(choice.word);
    }
    throw Error(ErrorKind::missing_key, map.place(), fmt::format("'{}' is missing", form.telltale),
                fmt::format("add {}: followed by one of {}", form.telltale, join(words)));
  }
  return *read_choice(*word, form).table;
}

void throw_unknown_key(const std::string& key, const KeyTable& table, const Location& place) {
  const std::vector<std::string> known = table.key_names();
  if (const std::string_view path = moved_key(key, table); !path.empty()) {  // it is taken
    throw Error(ErrorKind::unknown_key, place,
                fmt::format("{} in {} has another name now", show(key), table.name),
                fmt::format("write {}", written(path)));
  }
  throw Error(ErrorKind::unknown_key, place,
              fmt::format("unknown key {} in {}", show(key), table.name),
              fmt::format("{}the keys here are {}", did_you_mean(key, known), join(known)));
}

void throw_later(const std::string& what, const std::string& instead, const Location& place) {
  throw Error(ErrorKind::not_in_this_version, place, fmt::format("{} is not in this version", what),
              instead);
}

void throw_unknown_name(const std::string& name, const std::string& section,
                        const std::vector<std::string>& known, const Location& place) {
  const std::string remedy = known.empty()
                                 ? fmt::format("there is nothing under `{}`; add it there", section)
                                 : fmt::format("{}under `{}` there are {}",
                                               did_you_mean(name, known), section, join(known));
  throw Error(ErrorKind::unknown_name, place,
              fmt::format("{} is not under `{}`", show(name), section), remedy);
}

std::vector<std::string> names_under(const Node& scene, const std::string& section) {
  std::vector<std::string> names;
  if (const Node* map = scene.find(section)) {
    for (const Node::Entry& entry : map->entries()) names.push_back(entry.key);
  }
  return names;
}

}  // namespace sinew::scene
