#include "sinew/scene/node.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/text.hpp"

namespace sinew::scene {

namespace {

std::size_t skip_digits(std::string_view text, std::size_t from) {
  while (from < text.size() && is_digit(text[from])) ++from;
  return from;
}

// [-+]? (digits [. digits?] | . digits) ([eE] [-+]? digits)?, or .inf and .nan as YAML spells them.
bool looks_like_number(std::string_view text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::string_view rest = text.substr(at);
  if (rest == ".inf" || rest == ".Inf" || rest == ".INF") return true;
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return true;
  const std::size_t whole = skip_digits(text, at) - at;
  at += whole;
  std::size_t decimals = 0;
  if (at < text.size() && text[at] == '.') {
    decimals = skip_digits(text, at + 1) - (at + 1);
    at += 1 + decimals;
  }
  if (whole + decimals == 0) return false;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    const std::size_t end = skip_digits(text, at);
    if (end == at) return false;
    at = end;
  }
  return at == text.size();
}

}  // namespace

Node::Node() = default;
Node::~Node() = default;
Node::Node(const Node&) = default;
Node::Node(Node&&) noexcept = default;
Node& Node::operator=(const Node&) = default;
Node& Node::operator=(Node&&) noexcept = default;

Node Node::boolean(bool value) {
  Node node;
  node.kind_ = Kind::boolean;
  node.spelling_ = value ? "true" : "false";
  return node;
}

Node Node::number(double value) {
  Node node;
  node.kind_ = Kind::number;
  if (std::isnan(value)) {
    node.spelling_ = ".nan";
  } else if (std::isinf(value)) {
    node.spelling_ = value > 0 ? ".inf" : "-.inf";
  } else {
    node.spelling_ = fmt::format("{}", value);
  }
  return node;
}

Node Node::integer(std::int64_t value) {
  Node node;
  node.kind_ = Kind::number;
  node.spelling_ = std::to_string(value);
  return node;
}

Node Node::text(std::string value) {
  Node node;
  node.kind_ = Kind::text;
  node.spelling_ = std::move(value);
  return node;
}

Node Node::list() {
  Node node;
  node.kind_ = Kind::list;
  return node;
}

Node Node::map() {
  Node node;
  node.kind_ = Kind::map;
  return node;
}

Node Node::plain(std::string spelling) {
  Node node = text(std::move(spelling));
  const std::string& word = node.spelling_;
  if (word.empty() || word == "~" || word == "null" || word == "Null" || word == "NULL") {
    return {};
  }
  if (word == "true" || word == "True" || word == "TRUE" || word == "false" || word == "False" ||
      word == "FALSE") {
    node.kind_ = Kind::boolean;
  } else if (looks_like_number(word)) {
    node.kind_ = Kind::number;
  }
  return node;
}

double Node::as_number() const {
  if (kind_ != Kind::number) {
    throw Error(ErrorKind::wrong_type, place_, fmt::format("'{}' is not a number", spelling_),
                "write a number");
  }
  std::string_view digits = spelling_;
  const bool negative = digits.front() == '-';
  if (negative || digits.front() == '+') digits.remove_prefix(1);
  if (digits.size() == 4 && digits[0] == '.' && !is_digit(digits[1])) {
    if (digits[1] == 'n' || digits[1] == 'N') return std::numeric_limits<double>::quiet_NaN();
    return negative ? -std::numeric_limits<double>::infinity()
                    : std::numeric_limits<double>::infinity();
  }
  double value = 0.0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) {
    throw Error(ErrorKind::out_of_range, place_,
                fmt::format("{} is outside the range of double precision", spelling_),
                "write a number between 1e-300 and 1e300");
  }
  return negative ? -value : value;
}

bool Node::as_boolean() const {
  if (kind_ != Kind::boolean) {
    throw Error(ErrorKind::wrong_type, place_, fmt::format("'{}' is not true or false", spelling_),
                "write true or false");
  }
  return spelling_[0] == 't' || spelling_[0] == 'T';
}

const Node* Node::find(std::string_view key) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  return found == entries_.end() ? nullptr : &found->value;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node& Node::append(Node item) { return items_.emplace_back(std::move(item)); }

Node& Node::set(std::string key, Node value) {
  if (Node* present = find(key)) {
    *present = std::move(value);
    return *present;
  }
  Location place = value.place();
  return entries_.emplace_back(Entry{std::move(key), std::move(place), std::move(value)}).value;
}

bool Node::erase(std::string_view key) {
  return std::erase_if(entries_, [&](const Entry& entry) { return entry.key == key; }) > 0;
}

void Node::name_paths(const std::string& path) {
  place_.item = path;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    items_[i].name_paths(fmt::format("{}[{}]", path, i));
  }
  for (Entry& entry : entries_) {
    const std::string below = path.empty() ? entry.key : fmt::format("{}.{}", path, entry.key);
    entry.key_place.item = below;
    entry.value.name_paths(below);
  }
}

void Node::name_file(const std::string& file) {
  place_ = {file, 0, 0, place_.item};
  for (Node& item : items_) item.name_file(file);
  for (Entry& entry : entries_) {
    entry.key_place = {file, 0, 0, entry.key_place.item};
    entry.value.name_file(file);
  }
}

bool Node::operator==(const Node& other) const {
  const auto same_entry = [](const Entry& a, const Entry& b) {
    return a.key == b.key && a.value == b.value;
  };
  return kind_ == other.kind_ && spelling_ == other.spelling_ && items_ == other.items_ &&
         std::equal(entries_.begin(), entries_.end(), other.entries_.begin(), other.entries_.end(),
                    same_entry);
}

std::string_view node_kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::boolean:
      return "true or false";
    case Node::Kind::number:
      return "a number";
    case Node::Kind::text:
      return "text";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a map";
  }
  return "nothing";
}

}  // namespace sinew::scene
