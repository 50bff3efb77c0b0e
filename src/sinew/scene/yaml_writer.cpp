#include <algorithm>

#include <fmt/format.h>

#include "sinew/scene/node.hpp"

namespace sinew::scene {

namespace {

constexpr int kIndent = 2;

bool is_safe(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '/' || c == '+' || c == '-' || c == '^' || c == '%' || c == ' ' ||
         c == '*' || byte >= 0x80;
}

// Whether an unquoted text may start with a character, which has no other meaning in YAML there.
bool may_begin(char c) { return c != ' ' && c != '-' && c != '%' && c != '*'; }

bool starts_like_number(std::string_view text) {
  return text.size() > 1 && text[0] == '-' &&
         (text[1] == '.' || (text[1] >= '0' && text[1] <= '9'));
}

// Whether unquoted text reads back as the same text.
bool reads_plain(const std::string& text) {
  if (text.empty() || text.back() == ' ' || text.size() > 120) return false;
  if (text.starts_with("...") || text.starts_with("---")) return false;
  if (!may_begin(text.front()) && !starts_like_number(text)) return false;
  if (!std::all_of(text.begin(), text.end(), is_safe)) return false;
  if (text.find("\xc2\x85") != std::string::npos ||
      text.find("\xe2\x80\xa8") != std::string::npos ||
      text.find("\xe2\x80\xa9") != std::string::npos ||
      text.find("\xc2\xa0") != std::string::npos ||
      text.find("\xef\xbb\xbf") != std::string::npos) {
    return false;
  }
  return Node::plain(text).kind() == Node::Kind::text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\x{:02x}", byte);
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string text_or_quoted(const std::string& text) {
  return reads_plain(text) ? text : quoted(text);
}

std::string scalar(const Node& node) {
  if (node.kind() == Node::Kind::null) return "~";
  if (node.kind() != Node::Kind::text) return node.spelling();
  return text_or_quoted(node.spelling());
}

std::string key_text(const std::string& key) {
  return reads_plain(key) && key.size() < 100 ? key : quoted(key);
}

bool is_leaf(const Node& node) {
  return node.is_scalar() || (node.items().empty() && node.entries().empty());
}

// Whether a list is written on one line: a list of scalars, or of such lists.
bool is_flat(const Node& node, int levels) {
  if (is_leaf(node)) return true;
  return levels > 0 && node.is_list() &&
         std::all_of(node.items().begin(), node.items().end(),
                     [&](const Node& item) { return is_flat(item, levels - 1); });
}

void write_flat(const Node& node, std::string& out) {
  if (node.is_scalar()) {
    out += scalar(node);
  } else if (node.is_map()) {
    out += "{}";
  } else {
    out += '[';
    for (std::size_t i = 0; i < node.items().size(); ++i) {
      if (i > 0) out += ", ";
      write_flat(node.items()[i], out);
    }
    out += ']';
  }
}

void write(const Node& node, int indent, std::string& out);

// Writes the value after "key:" or "-".
void write_value(const Node& node, int indent, std::string& out) {
  if (is_flat(node, 2)) {
    out += ' ';
    write_flat(node, out);
    out += '\n';
  } else {
    out += '\n';
    write(node, indent + kIndent, out);
  }
}

void write(const Node& node, int indent, std::string& out) {
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  for (const Node& item : node.items()) {
    out += margin + '-';
    write_value(item, indent, out);
  }
  for (const Node::Entry& entry : node.entries()) {
    out += margin + key_text(entry.key) + ':';
    write_value(entry.value, indent, out);
  }
}

}  // namespace

std::string to_yaml(const Node& tree) {
  std::string out;
  if (is_flat(tree, 2)) {
    write_flat(tree, out);
    out += '\n';
  } else {
    write(tree, 0, out);
  }
  return out;
}

}  // namespace sinew::scene
