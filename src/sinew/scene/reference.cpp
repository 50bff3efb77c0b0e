#include "sinew/scene/reference.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/scene/grammar.hpp"

namespace sinew::scene {

namespace {

constexpr const char* kFirstPage = "scene.md";
constexpr const char* kSharedPage = "scene/shared.md";

const char* const kIntroduction = R"(
A scene file describes a robot and its run in YAML. Every quantity can carry a unit (`450 kPa`,
`0 0 190 mm`); a number without a unit is in SI units. Vectors are written `0 0 190 mm` or
`[0, 0, 190 mm]`. Paths are relative to the scene file. Unknown keys, wrong dimensions, missing
files and contradictions are errors. The message gives file, line and column, and what to write
instead. [The first tutorial](tutorials/bending_finger.md) builds a whole scene step by step.

Editors that support JSON Schema can complete and check scenes. Put
`# yaml-language-server: $schema=PATH/scene.schema.json` on the first line of the scene
([schema](scene.schema.json)).

A key marked *later* is reserved for a later version; this version rejects it.

The keys are on these pages; [all tables](#all-tables) are listed at the end of this page.

)";

const char* const kOrigin = R"(
<!-- Written from the tables in src/sinew/scene/grammar*.cpp by
     SINEW_WRITE_REFERENCE=1 ctest --test-dir build/release -R scene -->
)";

// A page, and the top-level keys whose tables it has.
struct Section {
  const char* path;
  const char* title;
  std::vector<std::string> keys;
};

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {kFirstPage, "Scene files", {}},  // and all keys that no other section names
      {"scene/bodies.md", "Scene files: bodies", {"bodies", "masses", "membranes"}},
      {"scene/actuators.md", "Scene files: actuators", {"actuators"}},
      {"scene/loads.md", "Scene files: loads", {"loads"}},
      {"scene/effectors.md", "Scene files: effectors and probes", {"effectors", "probes"}},
      {"scene/sensors.md", "Scene files: sensors", {"sensors"}},
      {"scene/estimators.md", "Scene files: estimators", {"estimators"}},
      {"scene/contacts.md", "Scene files: contacts", {"contacts"}},
      {"scene/joints.md", "Scene files: joints", {"joints"}},
      {"scene/controllers.md", "Scene files: controllers", {"controllers"}},
      {kSharedPage, "Scene files: types used in several sections", {}}};
  return all;
}

std::string page_of_key(const std::string& key) {
  for (const Section& section : sections()) {
    if (std::ranges::find(section.keys, key) != section.keys.end()) return section.path;
  }
  return kFirstPage;
}

// The anchor of a heading on GitHub.
std::string anchor(const std::string& heading) {
  std::string result;
  for (const char c : heading) {
    if (c == ' ') result += '-';
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_') result += c;
    if (c >= 'A' && c <= 'Z') result += static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

// The table that is described in place of `table`.
const KeyTable& described(const KeyTable& table) {
  return table.stand_in == nullptr ? table : *table.stand_in;
}

// All reachable tables in the order of discovery, with their pages.
class Tables {
 public:
  Tables() {
    add(grammar(), kFirstPage);
    for (const Key& key : grammar().keys) {
      const std::size_t first = order_.size();
      const std::string page = page_of_key(key.name);
      visit(key.forms, page);
      // Breadth first, so that a table is near those that link to it.
      for (std::size_t i = first; i < order_.size(); ++i) visit_keys(*order_[i], page);
      while (!again_.empty()) {
        const KeyTable& table = *again_.back();
        again_.pop_back();
        visit_keys(table, page);
      }
    }
  }

  const std::vector<const KeyTable*>& order() const { return order_; }
  const std::string& page(const std::string& table) const { return pages_.at(table); }

 private:
  void add(const KeyTable& table, const std::string& page) {
    const auto [found, added] = pages_.emplace(table.name, page);
    if (added) {
      order_.push_back(&table);
    } else if (found->second != page && found->second != kSharedPage) {
      found->second = kSharedPage;
      again_.push_back(&table);  // tables that it links to are shared, too
    }
  }

  void visit_keys(const KeyTable& table, const std::string& page) {
    for (const Key& key : table.keys) {
      if (!key.later) visit(key.forms, page);
    }
    if (table.shared != nullptr) add(*table.shared, page);
  }

  void visit(const std::vector<Form>& forms, const std::string& page) {
    for (const Form& form : forms) {
      if (form.table != nullptr) add(described(*form.table), page);
      for (const Choice& choice : form.choices) {
        if (choice.table != nullptr) add(described(*choice.table), page);
      }
      visit(form.items, page);
    }
  }

  std::vector<const KeyTable*> order_;
  std::vector<const KeyTable*> again_;
  std::map<std::string, std::string> pages_;
};

// Writes the tables of one page.
class Page {
 public:
  Page(const Tables& tables, std::string path) : tables_(tables), path_(std::move(path)) {}

  // Writes the page. @param told tables in which lists of words have already been explained.
  std::string write(std::map<std::string, const KeyTable*>& told) {
    for (const KeyTable* table : tables_.order()) {
      if (tables_.page(table->name) == path_) write_table(*table, told);
    }
    return text_;
  }

  std::string link(const KeyTable& table, const std::string& text) const {
    const KeyTable& target = described(table);
    const std::string& page = tables_.page(target.name);
    return fmt::format("[{}]({}#{})", text, page == path_ ? "" : relative(page),
                       anchor(target.name));
  }

  // Relative path from this page to another.
  std::string relative(const std::string& page) const {
    if (path_ == kFirstPage) return page;
    return page == kFirstPage ? "../" + page : page.substr(page.find('/') + 1);
  }

 private:
  // Describes a form, with links to its tables.
  std::string linked(const Form& form) const {
    switch (form.shape) {
      case Shape::table:
        return "map: " + link(*form.table, described(*form.table).name);
      case Shape::variants:
        return linked_variants(form);
      case Shape::list:
        return fmt::format("list of {}", linked(form.items));
      case Shape::names: {
        const std::string each = linked(form.items);  // "map: ...", "a path", "an angle"
        const bool has_article = each.starts_with("a ") || each.starts_with("an ");
        return fmt::format("names, each {}{}", has_article ? "" : "a ", each);
      }
      case Shape::choice:
        return words(form);
      default:
        return describe(form);
    }
  }

  std::string linked(const std::vector<Form>& forms) const {
    std::string result;
    for (const Form& form : forms) {
      result += (result.empty() ? "" : ", or ") + linked(form);
      if (form.later) result += " *(later)*";
    }
    return result;
  }

  std::string linked_variants(const Form& form) const {
    std::string result = fmt::format("map by `{}`: ", form.telltale);
    for (const Choice& choice : form.choices) {
      if (&choice != &form.choices.front()) result += ", ";
      result += choice.table == nullptr ? fmt::format("{} *(later)*", choice.word)
                                        : link(*choice.table, choice.word);
    }
    return result;
  }

  static std::string words(const Form& form) {
    std::string result;
    for (const Choice& choice : form.choices) {
      result += fmt::format("{}`{}`{}", result.empty() ? "" : ", ", choice.word,
                            choice.later ? " *(later)*" : "");
    }
    return result;
  }

  void write_table(const KeyTable& table, std::map<std::string, const KeyTable*>& told) {
    text_ += fmt::format("## {}\n\n{}\n\n", table.name, table.description);
    if (table.keys.empty()) {
      text_ += "It has no keys: `{}`.\n\n";
      return;
    }
    text_ += "| key | value | default | meaning |\n|---|---|---|---|\n";
    std::string explained;
    for (const Key& key : table.keys) {
      if (!is_shared(table, key)) write_key(table, key, explained, told);
    }
    text_ += '\n';
    if (!explained.empty()) text_ += explained + '\n';
    if (table.shared != nullptr) {
      text_ += shared_keys(table);
    }
    write_alternatives(table);
  }

  // "Also the keys of all sensors", or the list of those that the table has.
  std::string shared_keys(const KeyTable& table) const {
    std::string some;
    std::size_t count = 0;
    for (const Key& key : table.shared->keys) {
      if (table.find(key.name) == nullptr) continue;
      some += fmt::format("{}`{}`", some.empty() ? ": " : ", ", key.name);
      ++count;
    }
    const bool all = count == table.shared->keys.size();
    return fmt::format("Also {}the {}{}.\n\n", all ? "" : "these of ",
                       link(*table.shared, table.shared->name), all ? "" : some);
  }

  static bool is_shared(const KeyTable& table, const Key& key) {
    return table.shared != nullptr && table.shared->find(key.name) != nullptr;
  }

  void write_key(const KeyTable& table, const Key& key, std::string& explained,
                 std::map<std::string, const KeyTable*>& told) {
    const Alternatives* group = table.alternatives_of(key.name);
    std::string without = key.default_text.empty() ? "-" : fmt::format("`{}`", key.default_text);
    if (key.required) without = "**required**";
    if (group != nullptr && group->required) without = "**one of these**";
    if (key.later) without = "*later*";
    std::string meaning = key.description;
    if (!key.only_with.empty()) meaning += fmt::format(" Only with `{}`.", key.only_with);
    const std::string list = meanings(key);
    if (const auto [found, is_new] = told.emplace(list, &table); is_new) {
      explained += list;
    } else if (!list.empty() && found->second != &table) {
      meaning += fmt::format(" See {} for the choices.", link(*found->second, found->second->name));
    }
    if (!key.example.empty()) meaning += fmt::format(" Example: `{}: {}`", key.name, key.example);
    text_ += fmt::format("| `{}` | {} | {} | {} |\n", key.name,
                         key.later ? std::string("-") : escaped(linked(key.forms)), without,
                         escaped(meaning));
  }

  // The meanings of the words of a key's choices.
  static std::string meanings(const Key& key) {
    std::string result;
    for (const Form& form : key.forms) {
      if (form.shape != Shape::choice) continue;
      for (const Choice& choice : form.choices) {
        if (choice.later || choice.description.empty()) continue;
        result += fmt::format("- `{}: {}` - {}\n", key.name, choice.word, choice.description);
      }
    }
    return result;
  }

  void write_alternatives(const KeyTable& table) {
    for (const Alternatives& group : table.alternatives) {
      text_ += group.required ? "Exactly one of" : "At most one of";
      for (const std::string& key : group.keys) {
        text_ += fmt::format("{} `{}`", &key == &group.keys.front() ? "" : ",", key);
      }
      text_ += ".\n\n";
    }
  }

  // A bar would end the cell.
  static std::string escaped(const std::string& cell) {
    std::string result;
    for (const char c : cell) {
      if (c == '|') result += '\\';
      result += c;
    }
    return result;
  }

  const Tables& tables_;
  std::string path_;
  std::string text_;
};

// The table of pages.
std::string contents() {
  std::string text = "| page | keys of a scene |\n|---|---|\n";
  for (const Section& section : sections()) {
    if (section.path == std::string(kFirstPage)) continue;
    std::string keys;
    for (const std::string& key : section.keys) keys += (keys.empty() ? "`" : ", `") + key + "`";
    text += fmt::format("| [{}]({}) | {} |\n", section.title, section.path, keys);
  }
  return text + "| this page | all other keys |\n\n";
}

// An index of all tables, by page.
std::string table_index(const Tables& tables) {
  const Page page(tables, kFirstPage);
  std::vector<const KeyTable*> sorted = tables.order();
  std::ranges::sort(sorted, {}, &KeyTable::name);
  std::string text = "## All tables\n\n";
  for (const Section& section : sections()) {
    std::string links;
    for (const KeyTable* table : sorted) {
      if (tables.page(table->name) != section.path) continue;
      links += (links.empty() ? "" : ",\n  ") + page.link(*table, table->name);
    }
    text += fmt::format("- {}:\n  {}\n", section.title, links);
  }
  return text;
}

}  // namespace

std::vector<ReferencePage> reference_pages() {
  const Tables tables;
  std::map<std::string, const KeyTable*> told = {{"", nullptr}};
  std::vector<ReferencePage> pages;
  for (const Section& section : sections()) {
    Page page(tables, section.path);
    std::string text = fmt::format("# {}\n{}", section.title, kOrigin);
    if (section.path == std::string(kFirstPage)) {
      text += kIntroduction + contents();
    } else {
      text += fmt::format("\nUnits, vectors and paths are described in [scene files]({}).\n\n",
                          page.relative(kFirstPage));
    }
    text += page.write(told);
    if (section.path == std::string(kFirstPage)) text += table_index(tables);
    pages.push_back({section.path, text});
  }
  return pages;
}

}  // namespace sinew::scene
