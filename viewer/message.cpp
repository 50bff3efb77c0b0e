#include "message.hpp"

#include <cmath>
#include <initializer_list>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/model/actuator.hpp"

#include "limits.hpp"

namespace sinew::viewer {

namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 2;  // an object of numbers, texts and lists
constexpr std::size_t kLongestName = 256;
constexpr double kFarthest = 1e4;  // m or rad, bound of all numbers from a browser
constexpr double kLargestId = 9007199254740992.0, kLargestIndex = 2147483647.0;

[[noreturn]] void fail(ErrorKind kind, const std::string& item, const std::string& message,
                       const std::string& remedy = "see docs/view_protocol.md") {
  throw Error(kind, {.item = item}, message, remedy);
}

/// Strict parser: refuses duplicate keys, nesting deeper than kDeepest, and text after the object.
Json parse(std::string_view text) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kDeepest) fail(ErrorKind::syntax_error, "message", "it is nested too deep");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second) {
      fail(ErrorKind::duplicate_key, value.get<std::string>(), "this key stands twice");
    }
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::exception& error) {
    const bool bytes = error.id == 316;  // invalid UTF-8 is found when text is written, not here
    fail(bytes ? ErrorKind::bad_encoding : ErrorKind::syntax_error, "message", "it is not JSON");
  }
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char first = byte(i);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xc2 && first < 0xe0 ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return false;
    }
    if (first == 0xe0 && byte(i + 1) < 0xa0) return false;
    if (first == 0xed && byte(i + 1) > 0x9f) return false;
    if (first == 0xf0 && byte(i + 1) < 0x90) return false;
    if (first == 0xf4 && byte(i + 1) > 0x8f) return false;
    i += length;
  }
  return true;
}

/// The keys of a message. Each is taken once; remaining keys are an error.
class Fields {
 public:
  explicit Fields(Json object) : object_(std::move(object)) {
    if (!object_.is_object()) fail(ErrorKind::wrong_type, "message", "it is not a JSON object");
  }

  std::string text(const char* key) {
    const Json value = take(key);
    if (!value.is_string()) fail(ErrorKind::wrong_type, key, "this is not a text");
    auto result = value.get<std::string>();
    if (result.size() > kLongestName) fail(ErrorKind::size_limit, key, "this text is too long");
    return result;
  }
  std::optional<std::string> text_or_null(const char* key) {
    if (!missing(key) && object_[key].is_null()) return take(key), std::nullopt;
    return text(key);
  }
  bool truth(const char* key) {
    const Json value = take(key);
    if (!value.is_boolean()) fail(ErrorKind::wrong_type, key, "this is neither true nor false");
    return value.get<bool>();
  }
  double number(const char* key, double least, double most) {
    return in_range(key, take(key), least, most);
  }
  std::int64_t whole(const char* key, double least, double most) {
    const double value = number(key, least, most);
    if (value != std::floor(value)) {
      fail(ErrorKind::wrong_type, key, fmt::format("{} is not a whole number", value));
    }
    return sinew::whole<std::int64_t>(value);
  }
  Vector3 vector(const char* key, double most = kFarthest) {
    const Json value = take(key);
    if (!value.is_array()) fail(ErrorKind::wrong_type, key, "this is not a list");
    if (value.size() != 3) {
      fail(ErrorKind::wrong_length, key, fmt::format("{} numbers in place of 3", value.size()));
    }
    return {in_range(key, value[0], -most, most), in_range(key, value[1], -most, most),
            in_range(key, value[2], -most, most)};
  }
  std::optional<Vector3> vector_or_null(const char* key) {
    if (!missing(key) && object_[key].is_null()) return take(key), std::nullopt;
    return vector(key);
  }
  std::optional<std::int64_t> id() {
    if (missing("id")) return std::nullopt;
    return whole("id", 0, kLargestId);
  }
  void end() const {
    if (!object_.empty()) {
      fail(ErrorKind::unknown_key, object_.begin().key(), "this message has no such key");
    }
  }

 private:
  bool missing(const char* key) const { return !object_.contains(key); }
  Json take(const char* key) {
    const auto found = object_.find(key);
    if (found == object_.end()) fail(ErrorKind::missing_key, key, "this key is missing");
    Json value = *found;
    object_.erase(found);
    return value;
  }
  static double in_range(const char* key, const Json& value, double least, double most) {
    if (!value.is_number()) fail(ErrorKind::wrong_type, key, "this is not a number");
    const auto result = value.get<double>();
    if (!std::isfinite(result)) fail(ErrorKind::not_finite, key, "this number is not finite");
    if (result < least || result > most) {
      fail(ErrorKind::out_of_range, key,
           fmt::format("{:g} is not between {:g} and {:g}", result, least, most));
    }
    return result;
  }

  Json object_;
};

Pull read_pull(Fields& fields) {
  Pull pull;
  pull.body = fields.text("body");
  const Vector3 vertices = fields.vector("vertices", kLargestIndex);
  for (int k = 0; k < 3; ++k) {
    if (vertices[k] < 0 || vertices[k] != std::floor(vertices[k])) {
      fail(ErrorKind::wrong_type, "vertices", "these are not vertex numbers");
    }
    pull.vertices[static_cast<std::size_t>(k)] = sinew::whole<int>(vertices[k], 0);
  }
  pull.weights = fields.vector("weights", 1.0);
  if (pull.weights.minCoeff() < 0.0 || std::abs(pull.weights.sum() - 1.0) > 1e-6) {
    fail(ErrorKind::out_of_range, "weights", "barycentric weights are >= 0 and sum to 1");
  }
  pull.anchor = fields.vector("anchor");
  pull.stiffness = fields.number("stiffness", 1e-9, 1e9);
  return pull;
}

Pick read_pick(Fields& fields) {
  Pick pick{.body = fields.text_or_null("body")};
  const std::string kind = fields.text("kind");
  if (kind != "node" && kind != "element") {
    fail(ErrorKind::unknown_choice, "kind", fmt::format("'{}' is neither node nor element", kind));
  }
  pick.kind = kind == "node" ? PickKind::node : PickKind::element;
  pick.number = static_cast<int>(fields.whole("number", 0, kLargestIndex));
  return pick;
}

SetCommand read_command(Fields& fields) {
  SetCommand command;
  command.actuator = fields.text("actuator");
  command.quantity = fields.text("quantity");
  command.value = fields.number("value", -1e9, 1e9);
  return command;
}

double read_speed(Fields& fields) {
  const double factor = fields.number("factor", 0.0, limits::kFastest);
  if (!limits::is_speed(factor)) {
    fail(ErrorKind::out_of_range, "factor", fmt::format("{:g} is below 0.01 and not 0", factor));
  }
  return factor;
}

Request read_request(const std::string& type, Fields& fields) {
  if (type == "hello") return Hello{static_cast<int>(fields.whole("protocol", 0, 1e6))};
  if (type == "play") return Play{};
  if (type == "pause") return Pause{};
  if (type == "step") return Step{fields.whole("count", 1, static_cast<double>(kMaxSteps))};
  if (type == "reset") return Reset{};
  if (type == "settle") return Settle{};
  if (type == "speed") return Speed{read_speed(fields)};
  if (type == "command") return read_command(fields);
  if (type == "controller") return ChooseController{fields.text_or_null("name")};
  if (type == "target") {
    SetTarget target;
    target.effector = fields.text("effector");
    target.position = fields.vector_or_null("position");
    return target;
  }
  if (type == "pull") return read_pull(fields);
  if (type == "release") return Release{};
  if (type == "record") return Record{fields.truth("on")};
  if (type == "seek") return Seek{fields.whole("frame", 0, 1e12)};
  if (type == "open") return Open{fields.text("name")};
  if (type == "gallery") return ShowGallery{};
  if (type == "field") return ChooseField{fields.text_or_null("name")};
  if (type == "pick") return read_pick(fields);
  if (type == "inside") return ShowInside{fields.truth("on")};
  if (type == "ready") return Ready{static_cast<int>(fields.whole("generation", 0, 65535))};
  if (type == "drive") return DriveRequest{fields.truth("on")};
  if (type == "ping") return Ping{};
  fail(ErrorKind::unknown_choice, "type", fmt::format("there is no message '{}'", type));
}

}  // namespace

Message parse_message(std::string_view text) {
  if (text.size() > kLongestMessage) {
    fail(ErrorKind::size_limit, "message",
         fmt::format("{} bytes are more than {}", text.size(), kLongestMessage));
  }
  if (!is_utf8(text)) fail(ErrorKind::bad_encoding, "message", "it is not UTF-8");
  Fields fields(parse(text));
  Message message;
  const std::string type = fields.text("type");
  message.id = fields.id();
  message.request = read_request(type, fields);
  fields.end();
  return message;
}

}  // namespace sinew::viewer
