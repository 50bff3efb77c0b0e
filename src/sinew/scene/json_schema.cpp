#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/reference.hpp"

namespace sinew::scene {

namespace {

using Json = nlohmann::ordered_json;

const char* const kNumber = R"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)";
const char* const kPrefix = "(?:p|n|u|µ|μ|m|c|d|h|k|M|G|T)?";
// Any product or power of units: its dimension is left to the parser.
const char* const kCompound = R"(1\s*/.+|[^\s\d.,+-][^\s]*[*/^· ].+)";

// Units of one word, by dimension.
std::string simple_units(const Dimension& dimension) {
  const std::string prefix = kPrefix;
  if (dimension == dimension::kLength) return prefix + "m|in";
  if (dimension == dimension::kMass) return prefix + "g";
  if (dimension == dimension::kTime) return prefix + "s|min|h";
  if (dimension == dimension::kForce) return prefix + "N";
  if (dimension == dimension::kPressure) return prefix + "(?:Pa|bar)|psi|atm";
  if (dimension == dimension::kFrequency) return prefix + "Hz";
  if (dimension == dimension::kNone) return "rad|deg|°|%";
  return {};
}

std::string unit_pattern(const Dimension& dimension) {
  const std::string simple = simple_units(dimension);
  return simple.empty() ? fmt::format("(?:{})", kCompound)
                        : fmt::format("(?:{}|{})", simple, kCompound);
}

std::string quantity_pattern(const Dimension& dimension, int least, int most) {
  const std::string repeat =
      most == 1 ? ""
                : fmt::format(R"((?:(?:\s*,\s*|\s+){}){{{},{}}})", kNumber, least - 1, most - 1);
  return fmt::format(R"(^\s*{}{}(?:\s*{})?\s*$)", kNumber, repeat, unit_pattern(dimension));
}

class Schema {
 public:
  Json write() {
    Json root = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Sinew scene"}};
    root.update(table_schema(grammar(), {}, {}));
    root["$defs"] = definitions_;
    return root;
  }

 private:
  static Json number(const Range& range) {
    Json json = {{"type", "number"}};
    if (std::isfinite(range.min))
      json[range.above_min ? "exclusiveMinimum" : "minimum"] = range.min;
    if (std::isfinite(range.max))
      json[range.below_max ? "exclusiveMaximum" : "maximum"] = range.max;
    return json;
  }

  static Json text(const std::string& pattern) {
    return {{"type", "string"}, {"pattern", pattern}};
  }

  static Json one_quantity(const Form& form) {
    return {{"anyOf", {number(form.range), text(quantity_pattern(form.dimension, 1, 1))}}};
  }

  static Json quantity(const Form& form) {
    if (form.max_count == 1) return one_quantity(form);
    Json options = Json::array();
    if (form.min_count == 1) options.push_back(number(form.range));
    options.push_back(text(quantity_pattern(form.dimension, form.min_count, form.max_count)));
    options.push_back({{"type", "array"},
                       {"items", one_quantity(form)},
                       {"minItems", form.min_count},
                       {"maxItems", form.max_count}});
    return {{"anyOf", options}};
  }

  static Json samples(const Form& form) {
    Form time;
    time.dimension = dimension::kTime;
    const Json pair = {{"type", "array"},
                       {"prefixItems", {one_quantity(time), one_quantity(form)}},
                       {"minItems", 2},
                       {"maxItems", 2}};
    return {{"type", "array"}, {"items", pair}, {"minItems", 1}};
  }

  static Json words(const Form& form) {
    Json list = Json::array();
    for (const Choice& choice : form.choices) {
      if (!choice.later) list.push_back(choice.word);
    }
    if (!form.loose) return {{"enum", list}};
    Json spellings = Json::array({{{"enum", list}}});  // which editors offer
    for (const Choice& choice : form.choices) spellings.push_back(text(any_spelling(choice.word)));
    return {{"anyOf", spellings}};
  }

  // "[dD][rR]...": a word in capitals or not, with anything or nothing for its hyphens.
  static std::string any_spelling(const std::string& word) {
    std::string pattern = "^";
    for (const char c : word) {
      const bool letter = c >= 'a' && c <= 'z';
      if (c == '-') pattern += "[^A-Za-z0-9]*";
      if (letter) pattern += fmt::format("[{}{}]", c, static_cast<char>(c - 'a' + 'A'));
      if (c != '-' && !letter) pattern += c;
    }
    return pattern + "$";
  }

  Json form_schema(const Form& form) {
    switch (form.shape) {
      case Shape::quantity:
        return quantity(form);
      case Shape::unit:
        return {{"anyOf",
                 {number(form.range), text(fmt::format("^{}$", unit_pattern(form.dimension))),
                  text(quantity_pattern(form.dimension, 1, 1))}}};
      case Shape::integer:
        return {{"type", "integer"}, {"minimum", form.range.min}, {"maximum", form.range.max}};
      case Shape::boolean:
        return {{"type", "boolean"}};
      case Shape::text:
      case Shape::reference:
        return {{"type", {"string", "number"}}};
      case Shape::file:
        return {{"type", "string"}, {"minLength", 1}};
      case Shape::choice:
        return words(form);
      case Shape::list:
        return list(form);
      case Shape::samples:
        return samples(form);
      case Shape::table:
        return reference_to(*form.table, {}, {});
      case Shape::variants:
        return variants(form);
      case Shape::names:
        return names(form);
    }
    return true;
  }

  Json forms_schema(const std::vector<Form>& forms) {
    Json options = Json::array();
    for (const Form& form : forms) {
      if (!form.later) options.push_back(form_schema(form));
    }
    return options.size() == 1 ? options.front() : Json{{"anyOf", options}};
  }

  Json list(const Form& form) {
    Json json = {
        {"type", "array"}, {"items", forms_schema(form.items)}, {"minItems", form.min_count}};
    if (form.max_count < (1 << 20)) json["maxItems"] = form.max_count;
    return json;
  }

  Json names(const Form& form) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
            {"minProperties", form.min_count},
            {"additionalProperties", forms_schema(form.items)}};
  }

  Json variants(const Form& form) {
    Json options = Json::array();
    for (const Choice& choice : form.choices) {
      if (choice.later) continue;
      options.push_back(reference_to(*choice.table, form.telltale, choice.word));
    }
    return options.size() == 1 ? options.front() : Json{{"anyOf", options}};
  }

  Json reference_to(const KeyTable& table, const std::string& telltale, const std::string& word) {
    std::string name = table.name;
    for (char& c : name) {
      const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
      if (!plain) c = '_';
    }
    if (!definitions_.contains(name)) {
      definitions_[name] = nullptr;
      Json schema = table_schema(table, telltale, word);
      definitions_[name] = std::move(schema);
    }
    return {{"$ref", "#/$defs/" + name}};
  }

  Json table_schema(const KeyTable& table, const std::string& telltale, const std::string& word) {
    Json properties = Json::object();
    Json required = Json::array();
    if (!telltale.empty()) {
      properties[telltale] = {{"const", word}};
      required.push_back(telltale);
    }
    Json company = Json::object();
    for (const Key& key : table.keys) {
      if (key.later) continue;
      Json value = forms_schema(key.forms);
      value["description"] =
          key.default_text.empty()
              ? key.description
              : fmt::format("{} Default: {}.", key.description, key.default_text);
      properties[key.name] = std::move(value);
      if (key.required) required.push_back(key.name);
      if (!key.only_with.empty()) company[key.name] = {key.only_with};
    }
    Json json = {{"type", "object"},
                 {"description", table.description},
                 {"properties", properties},
                 {"additionalProperties", false}};
    if (!required.empty()) json["required"] = required;
    if (!company.empty()) json["dependentRequired"] = company;
    const Json exclusions = alternatives(table);
    if (!exclusions.empty()) json["allOf"] = exclusions;
    return json;
  }

  static Json alternatives(const KeyTable& table) {
    Json all = Json::array();
    for (const Alternatives& group : table.alternatives) {
      Json one = Json::array();
      Json any = Json::array();
      for (const std::string& key : group.keys) {
        one.push_back({{"required", {key}}});
        any.push_back({{"required", {key}}});
      }
      if (!group.required) one.push_back({{"not", {{"anyOf", any}}}});
      all.push_back({{"oneOf", one}});
    }
    return all;
  }

  Json definitions_ = Json::object();
};

}  // namespace

std::string json_schema() { return Schema().write().dump(2) + "\n"; }

}  // namespace sinew::scene
