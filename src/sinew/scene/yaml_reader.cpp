// Converts YAML text to Node by the events of yaml-cpp. The tree of yaml-cpp would expand aliases
// without limit, and would lose duplicate keys and the difference between 1 and "1".
#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/node/node.h>
#include <yaml-cpp/parser.h>

#include "sinew/scene/node.hpp"

namespace sinew::scene {

namespace {

Location place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file, 0, 0, {}};
  return {file, mark.line + 1, mark.column + 1, {}};
}

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file, const YamlLimits& limits)
      : file_(std::move(file)), limits_(limits) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(Node(), mark, anchor); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool quoted = tag == "!";
    if (!quoted) refuse_tag(tag, mark);
    if (awaits_key()) {
      take_key(value, mark);
      return;
    }
    add(quoted ? Node::text(value) : Node::plain(value), mark, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) {
      throw Error(ErrorKind::syntax_error, place_of(file_, mark), "an alias inside its own anchor",
                  "refer with * only to what is complete");
    }
    count(found->second.nodes, mark);
    if (open_.size() + found->second.height > static_cast<std::size_t>(limits_.depth)) {
      too_deep(mark);
    }
    attach(found->second.node, found->second.nodes, found->second.height, mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(Node::list(), mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(Node::map(), mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

  Node take() { return std::move(root_); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    std::size_t nodes = 1;   // of this subtree, itself included
    std::size_t height = 1;  // levels of this subtree
    std::string key;
    Location key_place;
    bool has_key = false;
    std::map<std::string, int> lines;  // of the keys so far
  };
  struct Anchored {
    Node node;
    std::size_t nodes = 1;
    std::size_t height = 1;
  };

  bool awaits_key() const {
    return !open_.empty() && open_.back().node.is_map() && !open_.back().has_key;
  }

  void refuse_tag(const std::string& tag, const YAML::Mark& mark) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw Error(ErrorKind::syntax_error, place_of(file_, mark), fmt::format("YAML tag {}", tag),
                "scenes do not use YAML tags; remove it");
  }

  [[noreturn]] void too_deep(const YAML::Mark& mark) const {
    throw Error(ErrorKind::size_limit, place_of(file_, mark),
                fmt::format("maps and lists are nested more than {} deep", limits_.depth),
                "a scene needs no more than about ten levels");
  }

  void count(std::size_t nodes, const YAML::Mark& mark) {
    nodes_ += nodes;
    if (nodes_ > limits_.nodes) {
      throw Error(ErrorKind::size_limit, place_of(file_, mark),
                  fmt::format("more than {} values, aliases expanded", limits_.nodes),
                  "keep long tables in CSV files");
    }
  }

  void take_key(const std::string& key, const YAML::Mark& mark) {
    Open& parent = open_.back();
    Location place = place_of(file_, mark);
    if (key.size() > limits_.key_length) {
      throw Error(ErrorKind::size_limit, place, fmt::format("a key of {} characters", key.size()),
                  fmt::format("keys have at most {}", limits_.key_length));
    }
    if (key == "<<") {
      throw Error(ErrorKind::syntax_error, place, "YAML merge keys (<<) are not supported",
                  "repeat the keys, or take over a whole map by an alias, `other: *name`");
    }
    const auto [first, is_new] = parent.lines.emplace(key, place.line);
    if (!is_new) {
      throw Error(ErrorKind::duplicate_key, place,
                  fmt::format("duplicate key '{}', first given in line {}", key, first->second),
                  "remove one of the two");
    }
    parent.key = key;
    parent.key_place = std::move(place);
    parent.has_key = true;
  }

  void refuse_as_key(const YAML::Mark& mark) const {
    if (!awaits_key()) return;
    throw Error(ErrorKind::syntax_error, place_of(file_, mark),
                "a list, a map or nothing in place of a key",
                "close brackets and quotes, and write keys as words");
  }

  void open(Node node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    refuse_tag(tag, mark);
    refuse_as_key(mark);
    count(1, mark);
    if (open_.size() >= static_cast<std::size_t>(limits_.depth)) too_deep(mark);
    node.set_place(place_of(file_, mark));
    Open level;
    level.node = std::move(node);
    level.anchor = anchor;
    open_.push_back(std::move(level));
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    if (done.anchor != 0) {
      count(done.nodes, YAML::Mark::null_mark());
      anchored_[done.anchor] = {done.node, done.nodes, done.height};
    }
    attach(std::move(done.node), done.nodes, done.height, YAML::Mark::null_mark());
  }

  void add(Node node, const YAML::Mark& mark, YAML::anchor_t anchor) {
    count(1, mark);
    node.set_place(place_of(file_, mark));
    if (anchor != 0) anchored_[anchor] = {node, 1, 1};
    attach(std::move(node), 1, 1, mark);
  }

  void attach(Node node, std::size_t nodes, std::size_t height, const YAML::Mark& mark) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    refuse_as_key(mark);
    Open& parent = open_.back();
    parent.nodes += nodes;
    parent.height = std::max(parent.height, height + 1);
    if (parent.node.is_list()) {
      parent.node.append(std::move(node));
      return;
    }
    // The parser gives an empty value the mark of the next token.
    if (node.kind() == Node::Kind::null) node.set_place(parent.key_place);
    parent.node.entries().push_back(
        {std::move(parent.key), std::move(parent.key_place), std::move(node)});
    parent.has_key = false;
  }

  std::string file_;
  const YamlLimits& limits_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchored_;
  std::size_t nodes_ = 0;
  Node root_;
};

// Position of the first byte that is not valid UTF-8, or is a control character that YAML forbids;
// npos if there is none.
std::size_t first_bad_byte(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x80) {
      const bool control = lead < 0x20 && lead != '\t' && lead != '\n' && lead != '\r';
      if (control || lead == 0x7f) return i;
      ++i;
      continue;
    }
    const std::size_t extra = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
    if (lead < 0xc2 || lead > 0xf4 || i + extra >= text.size()) return i;
    for (std::size_t k = 1; k <= extra; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return i;
    }
    const auto second = static_cast<unsigned char>(text[i + 1]);
    const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
    const bool surrogate = lead == 0xed && second > 0x9f;
    const bool beyond = lead == 0xf4 && second > 0x8f;
    if (overlong || surrogate || beyond) return i;
    i += extra + 1;
  }
  return std::string_view::npos;
}

void check_text(std::string_view text, const std::string& name, const YamlLimits& limits) {
  if (text.size() > limits.bytes) {
    throw Error(ErrorKind::size_limit, {name, 0, 0, {}},
                fmt::format("{} bytes, more than a scene may have ({})", text.size(), limits.bytes),
                "keep long tables in CSV files");
  }
  const std::size_t bad = first_bad_byte(text);
  if (bad == std::string_view::npos) return;
  Location place{name, 1, 1, {}};
  for (const char c : text.substr(0, bad)) {
    ++place.column;
    if (c == '\n') {
      ++place.line;
      place.column = 1;
    }
  }
  throw Error(ErrorKind::bad_encoding, place,
              fmt::format("byte 0x{:02x} is not UTF-8 text", static_cast<unsigned char>(text[bad])),
              "save the file as plain UTF-8 text");
}

// Tabs in the indentation are a frequent mistake, for which the message of the parser is obscure.
[[noreturn]] void throw_syntax(std::string_view text, const std::string& name,
                               const YAML::Exception& error) {
  Location place = place_of(name, error.mark);
  std::size_t begin = 0;
  for (int line = 1; line < place.line && begin < text.size(); ++line) {
    begin = text.find('\n', begin);
    begin = begin == std::string_view::npos ? text.size() : begin + 1;
  }
  const std::size_t first = text.find_first_not_of(' ', begin);
  if (place.line > 0 && first != std::string_view::npos && text[first] == '\t') {
    place.column = static_cast<int>(first - begin) + 1;
    throw Error(ErrorKind::syntax_error, place, "a tab in the indentation",
                "indent with spaces only");
  }
  throw Error(ErrorKind::syntax_error, place, fmt::format("not valid YAML: {}", error.msg),
              "check indentation, colons, quotes and brackets");
}

}  // namespace

Node parse_yaml(std::string_view text, const std::string& name, const YamlLimits& limits) {
  check_text(text, name, limits);
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(name, limits);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    TreeBuilder second(name, limits);
    if (parser.HandleNextDocument(second)) {
      throw Error(ErrorKind::syntax_error, second.take().place(), "a second document after '---'",
                  "a scene file holds one document");
    }
  } catch (const YAML::Exception& error) {
    throw_syntax(text, name, error);
  }
  Node tree = builder.take();
  if (tree.place().file.empty()) tree.set_place({name, 1, 1, {}});
  tree.name_paths();
  return tree;
}

Node read_yaml(const std::filesystem::path& path, const YamlLimits& limits) {
  const std::string name = path.string();
  std::error_code status;
  if (!std::filesystem::exists(path, status)) {
    throw Error(ErrorKind::file_not_found, {name, 0, 0, {}}, "there is no such file",
                "check the path");
  }
  std::ifstream file(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, status) || !file) {
    throw Error(ErrorKind::file_unreadable, {name, 0, 0, {}}, "this cannot be read as a file",
                "give a scene file that you may read");
  }
  std::string text(limits.bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return parse_yaml(text, name, limits);
}

}  // namespace sinew::scene
