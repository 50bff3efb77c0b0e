#include "sinew/scene/reference.hpp"

#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/scene/grammar.hpp"

namespace sinew::scene {

namespace {

const char* const kIntroduction = R"(# Scene files

<!-- Written from the tables in src/sinew/scene/grammar*.cpp by
     SINEW_WRITE_REFERENCE=1 ctest --test-dir build/release -R scene -->

A scene file describes a robot and its run in YAML. Every quantity may carry its unit (`450 kPa`,
`0 0 190 mm`); a number without a unit is SI. Vectors are written `0 0 190 mm` or
`[0, 0, 190 mm]`. Paths are relative to the scene file. Unknown keys, wrong dimensions, missing
files and contradictions are errors that name file, line and column and say what to write instead.

Editors that know JSON Schema complete and check scenes with [scene.schema.json](scene.schema.json):
put `# yaml-language-server: $schema=PATH/scene.schema.json` on the first line.

A key marked *later* is known but not in this version, and is refused.

)";

// GitHub's anchor of a heading.
std::string anchor(const std::string& heading) {
  std::string result;
  for (const char c : heading) {
    if (c == ' ') result += '-';
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_') result += c;
    if (c >= 'A' && c <= 'Z') result += static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string link(const KeyTable& table) {
  return fmt::format("[{}](#{})", table.name, anchor(table.name));
}

class Page {
 public:
  std::string write() {
    text_ = kIntroduction;
    queue_ = {&grammar()};
    // Writing a table puts those that it leads to at the end of the queue.
    std::size_t next = 0;
    while (next < queue_.size()) write_table(*queue_[next++]);
    return text_;
  }

 private:
  void enqueue(const KeyTable& table) {
    if (seen_.insert(table.name).second) queue_.push_back(&table);
  }

  // The form with links to the tables it leads to.
  std::string linked(const Form& form) {
    switch (form.shape) {
      case Shape::table:
        enqueue(*form.table);
        return "map: " + link(*form.table);
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

  std::string linked(const std::vector<Form>& forms) {
    std::string result;
    for (const Form& form : forms) {
      result += (result.empty() ? "" : ", or ") + linked(form);
      if (form.later) result += " *(later)*";
    }
    return result;
  }

  std::string linked_variants(const Form& form) {
    std::string result = fmt::format("map by `{}`: ", form.telltale);
    for (const Choice& choice : form.choices) {
      if (&choice != &form.choices.front()) result += ", ";
      if (choice.table == nullptr) {
        result += fmt::format("{} *(later)*", choice.word);
        continue;
      }
      enqueue(*choice.table);
      result += fmt::format("[{}](#{})", choice.word, anchor(choice.table->name));
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

  void write_table(const KeyTable& table) {
    text_ += fmt::format("## {}\n\n{}\n\n", table.name, table.description);
    text_ += "| key | value | without it | meaning |\n|---|---|---|---|\n";
    for (const Key& key : table.keys) write_key(table, key);
    text_ += '\n';
    write_words(table);
    write_alternatives(table);
  }

  void write_key(const KeyTable& table, const Key& key) {
    const Alternatives* group = table.alternatives_of(key.name);
    std::string without = key.default_text.empty() ? "-" : fmt::format("`{}`", key.default_text);
    if (key.required) without = "**required**";
    if (group != nullptr && group->required) without = "**one of these**";
    if (key.later) without = "*later*";
    std::string meaning = key.description;
    if (!key.only_with.empty()) meaning += fmt::format(" Only with `{}`.", key.only_with);
    if (!key.example.empty()) meaning += fmt::format(" Example: `{}: {}`", key.name, key.example);
    text_ += fmt::format("| `{}` | {} | {} | {} |\n", key.name,
                         key.later ? std::string("-") : escaped(linked(key.forms)), without,
                         escaped(meaning));
  }

  // What the words of the table's choices mean.
  void write_words(const KeyTable& table) {
    bool any = false;
    for (const Key& key : table.keys) {
      for (const Form& form : key.forms) {
        if (form.shape != Shape::choice) continue;
        for (const Choice& choice : form.choices) {
          if (choice.later || choice.description.empty()) continue;
          text_ += fmt::format("- `{}: {}` - {}\n", key.name, choice.word, choice.description);
          any = true;
        }
      }
    }
    if (any) text_ += '\n';
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

  std::string text_;
  std::vector<const KeyTable*> queue_;
  std::set<std::string> seen_ = {"scene"};
};

}  // namespace

std::string reference_page() { return Page().write(); }

}  // namespace sinew::scene
