#include "viewer/message.hpp"

#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::viewer {
namespace {

template <typename T>
T read(const std::string& text) {
  const Message message = parse_message(text);
  const T* request = std::get_if<T>(&message.request);
  if (request == nullptr) {
    ADD_FAILURE() << text << " was read as something else";
    return {};
  }
  return *request;
}

TEST(Message, ReadsEveryKind) {
  EXPECT_EQ(read<Hello>(R"({"type": "hello", "protocol": 1})").protocol, 1);
  read<Play>(R"({"type": "play"})");
  read<Pause>(R"({"type": "pause"})");
  EXPECT_EQ(read<Step>(R"({"type": "step", "count": 10000})").count, 10000);
  read<Reset>(R"({"type": "reset"})");
  read<Settle>(R"({"type": "settle"})");
  EXPECT_EQ(read<Speed>(R"({"type": "speed", "factor": 0})").factor, 0.0);
  const auto command = read<SetCommand>(
      R"({"type": "command", "actuator": "a", "quantity": "tension", "value": 1.5})");
  EXPECT_EQ(command.actuator, "a");
  EXPECT_EQ(command.quantity, "tension");
  EXPECT_EQ(command.value, 1.5);
  EXPECT_FALSE(read<ChooseController>(R"({"type": "controller", "name": null})").name);
  EXPECT_EQ(read<ChooseController>(R"({"type": "controller", "name": "x"})").name, "x");
  const auto target =
      read<SetTarget>(R"({"type": "target", "effector": "tip", "position": [0.1, -2e-2, 0]})");
  EXPECT_EQ(*target.position, Vector3(0.1, -0.02, 0.0));
  EXPECT_FALSE(
      read<SetTarget>(R"({"type": "target", "effector": "tip", "position": null})").position);
  const auto pull = read<Pull>(
      R"({"type": "pull", "body": "b", "vertices": [5, 8, 2], "weights": [0.2, 0.3, 0.5],)"
      R"( "anchor": [0.1, 0, 0.2], "stiffness": 50})");
  EXPECT_EQ(pull.vertices, (std::array<int, 3>{5, 8, 2}));
  EXPECT_EQ(pull.stiffness, 50.0);
  read<Release>(R"({"type": "release"})");
  EXPECT_TRUE(read<Record>(R"({"type": "record", "on": true})").on);
  EXPECT_EQ(read<Seek>(R"({"type": "seek", "frame": 12})").frame, 12);
  EXPECT_EQ(read<Open>(R"({"type": "open", "name": "trunk/circle"})").name, "trunk/circle");
  read<ShowGallery>(R"({"type": "gallery"})");
  EXPECT_EQ(read<ChooseField>(R"({"type": "field", "name": "von_mises_stress"})").name,
            "von_mises_stress");
  EXPECT_FALSE(read<DriveRequest>(R"({"type": "drive", "on": false})").on);
  const auto pick = read<Pick>(R"({"type": "pick", "body": "b", "kind": "element", "number": 12})");
  EXPECT_EQ(pick.body, "b");
  EXPECT_EQ(pick.kind, PickKind::element);
  EXPECT_EQ(pick.number, 12);
  EXPECT_FALSE(read<Pick>(R"({"type": "pick", "body": null, "kind": "node", "number": 0})").body);
  EXPECT_TRUE(read<ShowInside>(R"({"type": "inside", "on": true})").on);
  EXPECT_EQ(read<Ready>(R"({"type": "ready", "generation": 3})").generation, 3);
  read<Ping>(R"({"type": "ping"})");
  EXPECT_EQ(parse_message(R"({"id": 9007199254740991, "type": "ping"})").id, 9007199254740991);
  EXPECT_FALSE(parse_message(R"({"type": "ping"})").id);
}

TEST(Message, CommandsOfEveryQuantity) {
  for (const char* quantity : {"displacement", "tension", "force", "pressure", "volume_growth",
                               "torque", "angle", "gas", "liquid", "power", "phase"}) {
    const std::string text = fmt::format(
        R"({{"type": "command", "actuator": "a", "quantity": "{}", "value": 1}})", quantity);
    EXPECT_EQ(read<SetCommand>(text).quantity, quantity);
  }
}

struct Wrong {
  const char* text;
  ErrorKind kind;
};

class WrongMessage : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongMessage, IsRefused) {
  try {
    parse_message(GetParam().text);
    ADD_FAILURE() << "accepted: " << GetParam().text;
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(GetParam().kind))
        << GetParam().text << ": " << error.what();
  }
}

using K = ErrorKind;
const Wrong kWrong[] = {
    {"", K::syntax_error},
    {" ", K::syntax_error},
    {"hello", K::syntax_error},
    {"null", K::wrong_type},
    {"1", K::wrong_type},
    {"[]", K::wrong_type},
    {"\"play\"", K::wrong_type},
    {"{}", K::missing_key},
    {"{", K::syntax_error},
    {"}", K::syntax_error},
    {R"({"type": "play"}})", K::syntax_error},
    {R"({"type": "play"} {"type": "play"})", K::syntax_error},
    {R"({"type": "play",})", K::syntax_error},
    {R"({'type': 'play'})", K::syntax_error},
    {R"({"type": "play" /* now */})", K::syntax_error},
    {R"({"type": play})", K::syntax_error},
    {R"({"type": "pla)", K::syntax_error},
    {R"({"type": 1})", K::wrong_type},
    {R"({"type": null})", K::wrong_type},
    {R"({"type": ["play"]})", K::wrong_type},
    {R"({"type": "Play"})", K::unknown_choice},
    {R"({"type": ""})", K::unknown_choice},
    {R"({"type": "shutdown"})", K::unknown_choice},
    {R"({"type": "play", "type": "play"})", K::duplicate_key},
    {R"({"type": "step", "count": 1, "count": 2})", K::duplicate_key},
    {R"({"type": "play", "now": true})", K::unknown_key},
    {R"({"type": "hello"})", K::missing_key},
    {R"({"type": "hello", "protocol": "1"})", K::wrong_type},
    {R"({"type": "hello", "protocol": 1.5})", K::wrong_type},
    {R"({"type": "hello", "protocol": -1})", K::out_of_range},
    {R"({"type": "step"})", K::missing_key},
    {R"({"type": "step", "count": 0})", K::out_of_range},
    {R"({"type": "step", "count": -1})", K::out_of_range},
    {R"({"type": "step", "count": 10001})", K::out_of_range},
    {R"({"type": "step", "count": 1e300})", K::out_of_range},
    {R"({"type": "step", "count": 1e999})", K::syntax_error},
    {R"({"type": "step", "count": 1.5})", K::wrong_type},
    {R"({"type": "step", "count": true})", K::wrong_type},
    {R"({"type": "step", "count": NaN})", K::syntax_error},
    {R"({"type": "step", "count": Infinity})", K::syntax_error},
    {R"({"type": "speed", "factor": -1})", K::out_of_range},
    {R"({"type": "speed", "factor": 0.001})", K::out_of_range},
    {R"({"type": "speed", "factor": 101})", K::out_of_range},
    {R"({"type": "command", "actuator": "a", "quantity": "tension"})", K::missing_key},
    {R"({"type": "command", "actuator": 3, "quantity": "tension", "value": 1})", K::wrong_type},
    {R"({"type": "command", "actuator": "a", "quantity": "tension", "value": "1 N"})",
     K::wrong_type},
    {R"({"type": "command", "actuator": "a", "quantity": "tension", "value": 1e300})",
     K::out_of_range},
    {R"({"type": "controller"})", K::missing_key},
    {R"({"type": "controller", "name": 1})", K::wrong_type},
    {R"({"type": "target", "effector": "tip", "position": [1, 2]})", K::wrong_length},
    {R"({"type": "target", "effector": "tip", "position": [1, 2, 3, 4]})", K::wrong_length},
    {R"({"type": "target", "effector": "tip", "position": [1, 2, "3"]})", K::wrong_type},
    {R"({"type": "target", "effector": "tip", "position": [1, 2, null]})", K::wrong_type},
    {R"({"type": "target", "effector": "tip", "position": [1, 2, 1e5]})", K::out_of_range},
    {R"({"type": "target", "effector": "tip", "position": {"x": 1}})", K::wrong_type},
    {R"({"type": "target", "effector": "tip", "position": [[1], 2, 3]})", K::syntax_error},
    {R"({"type": "pull", "body": "b", "vertices": [0, 1, 2], "weights": [0.5, 0.5, 0.5],
         "anchor": [0, 0, 0], "stiffness": 1})",
     K::out_of_range},
    {R"({"type": "pull", "body": "b", "vertices": [0, 1, 2], "weights": [-1, 1, 1],
         "anchor": [0, 0, 0], "stiffness": 1})",
     K::out_of_range},
    {R"({"type": "pull", "body": "b", "vertices": [0, 1.5, 2], "weights": [1, 0, 0],
         "anchor": [0, 0, 0], "stiffness": 1})",
     K::wrong_type},
    {R"({"type": "pull", "body": "b", "vertices": [-1, 1, 2], "weights": [1, 0, 0],
         "anchor": [0, 0, 0], "stiffness": 1})",
     K::wrong_type},
    {R"({"type": "pull", "body": "b", "vertices": [0, 1, 1e12], "weights": [1, 0, 0],
         "anchor": [0, 0, 0], "stiffness": 1})",
     K::out_of_range},
    {R"({"type": "pull", "body": "b", "vertices": [0, 1, 2], "weights": [1, 0, 0],
         "anchor": [0, 0, 0], "stiffness": 0})",
     K::out_of_range},
    {R"({"type": "record", "on": 1})", K::wrong_type},
    {R"({"type": "seek", "frame": -1})", K::out_of_range},
    {R"({"type": "pick", "body": "b", "kind": "node"})", K::missing_key},
    {R"({"type": "pick", "body": "b", "kind": "node", "number": -1})", K::out_of_range},
    {R"({"type": "pick", "body": "b", "kind": "node", "number": 0.5})", K::wrong_type},
    {R"({"type": "pick", "body": "b", "kind": "vertex", "number": 0})", K::unknown_choice},
    {R"({"type": "pick", "body": 1, "kind": "node", "number": 0})", K::wrong_type},
    {R"({"type": "inside", "on": 1})", K::wrong_type},
    {R"({"type": "ready", "generation": 65536})", K::out_of_range},
    {R"({"type": "open"})", K::missing_key},
    {R"({"type": "drive"})", K::missing_key},
    {R"({"type": "ping", "id": "a"})", K::wrong_type},
    {R"({"type": "ping", "id": -1})", K::out_of_range},
    {R"({"type": "ping", "id": 1e17})", K::out_of_range},
    {R"({"type": "ping", "id": 0.5})", K::wrong_type},
    {"{\"type\": \"open\", \"name\": \"\xff\"}", K::bad_encoding},
    {"{\"type\": \"open\", \"name\": \"\xc0\xaf\"}", K::bad_encoding},
    {"{\"type\": \"open\", \"name\": \"\xed\xa0\x80\"}", K::bad_encoding},
    {"{\"type\": \"open\", \"name\": \"a\nb\"}", K::syntax_error},
    {R"({"type": {"type": {"type": {"type": "play"}}}})", K::syntax_error},
};

INSTANTIATE_TEST_SUITE_P(All, WrongMessage, ::testing::ValuesIn(kWrong));

TEST(Message, HasALengthThatIsLimited) {
  const std::string name(300, 'a');
  EXPECT_THROW(parse_message(R"({"type": "open", "name": ")" + name + "\"}"), Error);
  EXPECT_THROW(parse_message(std::string(kLongestMessage + 1, ' ')), Error);
  EXPECT_THROW(parse_message(std::string(4000, '[')), Error);
}

// For any bytes, the parser returns or throws an Error.
TEST(Message, BearsAnyBytes) {
  std::mt19937 random(7);
  const std::string sound[] = {
      R"({"type": "target", "effector": "tip", "position": [0.1, -2e-2, 0], "id": 4})",
      R"({"type": "command", "actuator": "a", "quantity": "tension", "value": 1.5})"};
  int refused = 0;
  for (int k = 0; k < 100000; ++k) {
    std::string text = sound[random() % 2];
    for (unsigned n = 1 + random() % 4; n > 0; --n) {
      text[random() % text.size()] = static_cast<char>(random());
    }
    text.resize(text.size() - random() % 3);
    try {
      parse_message(text);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 90000);
}

}  // namespace
}  // namespace sinew::viewer
