// The server with browsers that are well-behaved, slow, broken or hostile.
#include "viewer/server.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <thread>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"

#include "viewer/assets.hpp"

namespace sinew::viewer {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using Tcp = asio::ip::tcp;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A source with one large surface that steps continuously.
class FakeSource final : public Source {
 public:
  explicit FakeSource(std::size_t vertices = 30) {
    description_.scene = R"({"name": "fake"})";
    DisplaySurface surface;
    surface.body = "ball";
    surface.nodes.assign(vertices, 0);
    surface.node_count = static_cast<int>(vertices);
    surface.element_count = 4;
    surface.inside.nodes = {0, 0};
    surface.rest.assign(3 * vertices, 0.5F);
    surface.triangles = {0, 1, 2};
    surface.elements = {-1};
    description_.surfaces = {surface};
    description_.fields = {"displacement"};
    vertices_ = vertices;
  }
  ~FakeSource() override { stop(); }
  std::string_view mode() const override { return "live"; }
  const Description& description() const override { return description_; }
  void start(Publisher& publisher) override {
    publisher.publish_status(R"({"playing": true})");
    thread_ = std::thread([this, &publisher] {
      while (!stopping_) {
        auto frame = std::make_shared<Frame>();
        frame->step = frame->shape = static_cast<std::uint64_t>(++steps);
        frame->bodies = {
            {std::vector<float>(3 * vertices_, static_cast<float>(steps)), {}, {}, {}}};
        if (publisher.wants_inside()) frame->bodies[0].inner_positions.assign(6, 1.0F);
        for (const Picked& at : publisher.picks()) frame->picks.push_back({.at = at});
        publisher.publish(frame);
        std::this_thread::sleep_for(1ms);
      }
    });
  }
  void stop() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void submit(const Request& request, std::function<void(Outcome)> done) override {
    ++requests;
    if (std::holds_alternative<Release>(request)) ++releases;
    done({});
  }
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override {
    if (name != "run.csv") return done(std::nullopt);
    done(Download{"run.csv", "text/csv", "time\n0\n"});
  }

  std::atomic<int> steps{0}, requests{0}, releases{0};

 private:
  Description description_;
  std::size_t vertices_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

class Shown {
 public:
  explicit Shown(std::size_t vertices = 30) {
    auto source = std::make_unique<FakeSource>(vertices);
    fake = source.get();
    server = std::make_unique<Server>(ServerSettings{"127.0.0.1", 0}, std::move(source));
    server->start();
  }
  FakeSource* fake;
  std::unique_ptr<Server> server;
};

/// A connection of a browser. Every wait ends after ten seconds.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(io_) {
    beast::get_lowest_layer(socket_).expires_after(10s);
    beast::get_lowest_layer(socket_).connect(
        Tcp::endpoint(asio::ip::make_address("127.0.0.1"), port));
    host_ = "127.0.0.1:" + std::to_string(port);
  }
  void handshake(const std::string& target = "/view", const std::string& origin = {}) {
    socket_.set_option(
        websocket::stream_base::decorator([origin](websocket::request_type& request) {
          if (!origin.empty()) request.set(beast::http::field::origin, origin);
        }));
    socket_.handshake(host_, target);
  }
  void say(const std::string& text) {
    socket_.text(true);
    socket_.write(asio::buffer(text));
  }
  void say_bytes(const std::string& bytes) {
    socket_.binary(true);
    socket_.write(asio::buffer(bytes));
  }
  void greet() {
    handshake();
    say(R"({"type": "hello", "protocol": 2})");
  }
  /// The next message. A binary message is "#" and its bytes.
  std::string next() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    const std::string text = beast::buffers_to_string(buffer.data());
    return socket_.got_text() ? text : "#" + text;
  }
  Json next_json(const std::string& type) {
    for (int k = 0; k < 10000; ++k) {
      const std::string text = next();
      if (text.front() == '#') continue;
      Json message = Json::parse(text);
      if (message["type"] == type) return message;
    }
    ADD_FAILURE() << "no " << type;
    return {};
  }
  /// Step of the next frame.
  std::uint64_t next_step() {
    for (int k = 0; k < 10000; ++k) {
      const std::string bytes = next();
      if (bytes.front() != '#' || bytes[5] != 2) continue;
      std::uint64_t step = 0;
      std::memcpy(&step, bytes.data() + 17, sizeof step);
      return step;
    }
    return 0;
  }
  /// Reads until the server closes the connection, and returns the reason.
  std::string closed() {
    try {
      while (true) next();
    } catch (const beast::system_error&) {
      return std::string(socket_.reason().reason.data(), socket_.reason().reason.size());
    }
  }
  beast::tcp_stream& raw() { return beast::get_lowest_layer(socket_); }

 private:
  asio::io_context io_;
  websocket::stream<beast::tcp_stream> socket_;
  std::string host_;
};

/// "#" and the bytes of the first section of a kind in a frame; empty if there is none. Frames of
/// the fake have no signals.
std::string section(const std::string& bytes, int wanted) {
  for (std::size_t at = 1 + 40; at + 8 <= bytes.size();) {
    std::uint16_t kind = 0;
    std::uint32_t length = 0;
    std::memcpy(&kind, bytes.data() + at, sizeof kind);
    std::memcpy(&length, bytes.data() + at + 4, sizeof length);
    if (kind == wanted) return "#" + bytes.substr(at + 8, length);
    at += 8 + length;
  }
  return {};
}

/// Whether a client soon receives a frame with a valid section of a kind.
template <typename Holds>
bool shows(Client& client, int kind, const Holds& holds) {
  for (int k = 0; k < 1000; ++k) {
    const std::string bytes = client.next();
    if (bytes.front() == '#' && bytes[5] == 2 && holds(section(bytes, kind))) return true;
  }
  return false;
}

/// Whether a client soon receives frames with this picked node or element; -1: none.
bool shows_pick(Client& client, int number, PickKind kind = PickKind::node) {
  return shows(client, 10, [&](const std::string& pick) {
    if (pick.empty()) return number < 0;
    std::array<std::uint32_t, 3> head{};
    std::memcpy(head.data(), pick.data() + 1, sizeof head);
    return head[1] == static_cast<std::uint32_t>(kind) && static_cast<int>(head[2]) == number;
  });
}

/// The response to raw bytes.
std::string whole_answer(std::uint16_t port, const std::string& text) {
  asio::io_context io;
  Tcp::socket socket(io);
  socket.connect(Tcp::endpoint(asio::ip::make_address("127.0.0.1"), port));
  asio::write(socket, asio::buffer(text));
  socket.shutdown(Tcp::socket::shutdown_send);
  std::string answer;
  beast::error_code error;
  asio::read(socket, asio::dynamic_buffer(answer), error);
  return answer;
}

/// The status line of the response to raw bytes.
std::string raw_request(std::uint16_t port, const std::string& text) {
  const std::string answer = whole_answer(port, text);
  return answer.substr(0, answer.find("\r\n"));
}

std::string get(std::uint16_t port, const std::string& path, const std::string& more = {}) {
  return raw_request(port, "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                               "\r\nConnection: close\r\n" + more + "\r\n");
}

TEST(Server, IntroducesItselfAndShowsFrames) {
  const Shown shown;
  Client client(shown.server->port());
  client.greet();
  const Json welcome = client.next_json("welcome");
  EXPECT_EQ(welcome["protocol"], 2);
  const Json scene = client.next_json("scene");
  EXPECT_EQ(scene["mode"], "live");
  EXPECT_EQ(scene["scene"]["name"], "fake");
  const Json status = client.next_json("status");
  EXPECT_EQ(status["driver"], welcome["client"]);
  const auto first = client.next_step();
  EXPECT_GT(client.next_step(), first);
}

TEST(Server, ServesThePageAndNothingElse) {
  const Shown shown;
  const auto port = shown.server->port();
  for (const char* path : {"/", "/app.js", "/app.css", "/?token=x", "/download/run.csv"}) {
    EXPECT_EQ(get(port, path), "HTTP/1.1 200 OK") << path;
  }
  for (const char* path :
       {"/index.html", "/../../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/app.js/../x",
        "/%2e%2e/x", "/app.js%00", "/download/../../etc/passwd", "/download/", "/download/x",
        "/view", "/viewer/server.cpp", "/.git/config", "http://127.0.0.1/etc/passwd"}) {
    EXPECT_EQ(get(port, path), "HTTP/1.1 404 Not Found") << path;
  }
}

TEST(Server, CompressesForThoseWhoTakeIt) {
  const Shown shown;
  const auto page = [&](const std::string& accepted) {
    return whole_answer(shown.server->port(), "GET / HTTP/1.1\r\nHost: 127.0.0.1:" +
                                                  std::to_string(shown.server->port()) +
                                                  "\r\nConnection: close\r\n" + accepted + "\r\n");
  };
  const std::string plain = page({});
  EXPECT_EQ(plain.find("Content-Encoding"), std::string::npos);
  EXPECT_NE(plain.find("<title>Sinew</title>"), std::string::npos);
  EXPECT_NE(plain.find("</html>"), std::string::npos) << "to its end";
  const std::string packed = page("Accept-Encoding: br, gzip\r\n");
  EXPECT_NE(packed.find("Content-Encoding: gzip"), std::string::npos);
  EXPECT_LT(packed.size(), plain.size());
  for (const char* yes : {"gzip", "GZIP;q=0.5", "deflate , gzip;q=1.0", "*", "x-gzip"}) {
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  }
  for (const char* no : {"", "identity", "gzip;q=0", "gzip; q=0.0, br", "gzipped", ",;=,"}) {
    EXPECT_FALSE(accepts_gzip(no)) << no;
  }
}

TEST(Server, TellsEachConnectionOfItsOwnNode) {
  const Shown shown;
  Client first(shown.server->port()), second(shown.server->port());
  first.greet();
  second.greet();
  second.next_json("status");
  const auto pick = [](const char* body, const char* kind, int number) {
    return R"({"type": "pick", "id": 1, "body": )" + std::string(body) + R"(, "kind": ")" + kind +
           R"(", "number": )" + std::to_string(number) + "}";
  };
  second.say(pick(R"("ball")", "node", 3));
  EXPECT_FALSE(second.next_json("reply").contains("error")) << "a looker-on may";
  EXPECT_TRUE(shows_pick(second, 3));
  first.say(pick(R"("ball")", "element", 3));
  EXPECT_FALSE(first.next_json("reply").contains("error"));
  EXPECT_TRUE(shows_pick(first, 3, PickKind::element));
  EXPECT_TRUE(shows_pick(second, 3));
  second.say(pick(R"("bell")", "node", 3));
  EXPECT_EQ(second.next_json("reply")["error"]["kind"], "unknown-name");
  second.say(pick(R"("ball")", "node", 30));
  EXPECT_EQ(second.next_json("reply")["error"]["kind"], "index-out-of-range");
  second.say(pick(R"("ball")", "element", 4));
  EXPECT_EQ(second.next_json("reply")["error"]["kind"], "index-out-of-range");
  second.say(pick("null", "node", 0));
  EXPECT_FALSE(second.next_json("reply").contains("error"));
  EXPECT_TRUE(shows_pick(second, -1));
}

TEST(Server, TellsWhatIsInsideToWhoeverAsks) {
  const Shown shown;
  Client first(shown.server->port()), second(shown.server->port());
  first.greet();
  second.greet();
  second.next_json("status");
  second.say(R"({"type": "inside", "on": true})");
  while (true) {
    const std::string bytes = second.next();
    if (bytes.front() == '#' && bytes[5] == 3) break;  // the interior
  }
  const auto has_inside = [](const std::string& inner) { return inner.size() == 1 + 24; };
  EXPECT_TRUE(shows(second, 12, has_inside));
  first.next_step();
  EXPECT_TRUE(section(first.next(), 12).empty()) << "who has not asked";
  second.say(R"({"type": "inside", "on": false})");
  EXPECT_TRUE(shows(second, 12, [](const std::string& inner) { return inner.empty(); }));
}

TEST(Server, RefusesOtherHostsAndOrigins) {
  const Shown shown;
  const auto port = shown.server->port();
  const std::string number = std::to_string(port);
  const auto with_host = [&](const std::string& host) {
    return raw_request(port, "GET / HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n");
  };
  EXPECT_EQ(with_host("localhost:" + number), "HTTP/1.1 200 OK");
  for (const std::string& host :
       {std::string("evil.example"), "evil.example:" + number, std::string("127.0.0.1"),
        std::string("127.0.0.1:1"), "127.0.0.1.evil.example:" + number, std::string()}) {
    EXPECT_EQ(with_host(host), "HTTP/1.1 403 Forbidden") << host;
  }
  Client good(port), bad(port), worse(port);
  good.handshake("/view", "http://127.0.0.1:" + number);
  EXPECT_THROW(bad.handshake("/view", "http://evil.example"), beast::system_error);
  EXPECT_THROW(worse.handshake("/view", "null"), beast::system_error);
}

TEST(Server, AsksForItsTokenWhenBoundElsewhere) {
  Server server({"0.0.0.0", 0}, std::make_unique<FakeSource>());
  server.start();
  const std::string url = server.url();
  const std::string token = url.substr(url.find("?token="));
  EXPECT_EQ(token.size(), std::string("?token=").size() + 32);
  Client good(server.port()), none(server.port()), wrong(server.port());
  good.handshake("/view" + token);
  EXPECT_THROW(none.handshake("/view"), beast::system_error);
  EXPECT_THROW(wrong.handshake("/view?token=" + std::string(32, '0')), beast::system_error);
  EXPECT_EQ(get(server.port(), "/download/run.csv"), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(get(server.port(), "/download/run.csv" + token), "HTTP/1.1 200 OK");
}

TEST(Server, LetsOneDrive) {
  const Shown shown;
  Client first(shown.server->port()), second(shown.server->port());
  first.greet();
  first.next_json("status");
  second.greet();
  second.next_json("status");
  second.say(R"({"type": "play", "id": 1})");
  EXPECT_EQ(second.next_json("reply")["error"]["kind"], "not-driving");
  EXPECT_EQ(shown.fake->requests, 0);
  second.say(R"({"type": "drive", "on": true, "id": 2})");
  EXPECT_FALSE(second.next_json("reply").contains("error"));
  second.say(R"({"type": "play", "id": 3})");
  EXPECT_FALSE(second.next_json("reply").contains("error"));
  EXPECT_EQ(shown.fake->requests, 1);
  first.say(R"({"type": "play", "id": 4})");
  EXPECT_EQ(first.next_json("reply")["error"]["kind"], "not-driving");
  first.say(R"({"type": "field", "name": "heat", "id": 5})");
  EXPECT_EQ(first.next_json("reply")["error"]["kind"], "unknown-name");
  EXPECT_EQ(shown.fake->requests, 1);
  first.say(R"({"type": "field", "name": "displacement", "id": 6})");
  EXPECT_FALSE(first.next_json("reply").contains("error")) << "a looker-on may choose colours";
  EXPECT_EQ(shown.fake->requests, 2) << "the source is to show them";
}

TEST(Server, ReleasesTheHandOfADriverThatGoes) {
  const Shown shown;
  {
    Client client(shown.server->port());
    client.greet();
    client.next_json("status");
  }
  for (int k = 0; k < 100 && shown.fake->releases == 0; ++k) std::this_thread::sleep_for(20ms);
  EXPECT_EQ(shown.fake->releases, 1);
}

TEST(Server, ClosesWithAReason) {
  const Shown shown;
  const auto closed = [&](auto&& misbehave) {
    Client client(shown.server->port());
    client.handshake();
    misbehave(client);
    return client.closed();
  };
  const std::string hello = R"({"type": "hello", "protocol": 2})";
  EXPECT_EQ(closed([](Client& c) { c.say(R"({"type": "play"})"); }),
            "the first message must be hello");
  EXPECT_NE(closed([](Client& c) { c.say(R"({"type": "hello", "protocol": 9})"); }).find("reload"),
            std::string::npos);
  EXPECT_NE(closed([](Client& c) { c.say("nonsense"); }).find("not JSON"), std::string::npos);
  EXPECT_EQ(closed([&](Client& c) {
              c.say(hello);
              c.say_bytes("\1\2\3");
            }),
            "only text is understood");
  EXPECT_EQ(closed([&](Client& c) {
              c.say(hello);
              for (int k = 0; k < 1000; ++k) c.say(R"({"type": "ping"})");
            }),
            "too many messages");
  // The message is too long for the WebSocket layer, which closes with its own code.
  Client client(shown.server->port());
  client.handshake();
  client.say(hello);
  client.say(std::string(kLongestMessage + 1, ' '));
  client.closed();
}

// A browser that does not read does not affect others, and gets the latest frame when it reads
// again.
TEST(Server, GivesASlowBrowserTheLatestFrame) {
  const Shown shown(200000);  // 2.4 MB per frame, more than socket buffers
  Client slow(shown.server->port()), quick(shown.server->port());
  slow.greet();
  quick.greet();
  quick.next_json("status");
  const auto before = quick.next_step();
  std::this_thread::sleep_for(1500ms);
  const int steps = shown.fake->steps;
  EXPECT_GT(quick.next_step(), before);
  slow.next_json("status");
  slow.next_step();  // the frame that was being sent when it stopped reading
  slow.next_step();
  EXPECT_GE(static_cast<int>(slow.next_step()) + 5, steps) << "old frames were kept for it";
}

TEST(Server, BearsTenThousandBrokenMessages) {
  const Shown shown;
  Client witness(shown.server->port());
  witness.greet();
  witness.next_json("status");
  std::mt19937 random(11);
  const std::string sound =
      R"({"type": "command", "actuator": "a", "quantity": "force", "value": 1})";
  int closed = 0;
  for (int k = 0; k < 10000; ++k) {
    if (k % 500 == 0) witness.next_step();  // a view that is silent for too long is disconnected
    try {
      Client client(shown.server->port());
      if (k % 3 == 0) {  // not even a WebSocket
        std::string noise(1 + random() % 200, ' ');
        for (char& c : noise) c = static_cast<char>(random());
        asio::write(client.raw().socket(), asio::buffer(noise));
        ++closed;
        continue;
      }
      client.handshake();
      if (k % 3 == 1) {  // a broken frame
        std::string frame(2 + random() % 20, ' ');
        for (char& c : frame) c = static_cast<char>(random());
        asio::write(client.raw().socket(), asio::buffer(frame));
      } else {  // a broken message in place of a valid one
        std::string text = sound;
        text[random() % text.size()] = static_cast<char>('!' + random() % 90);
        client.say(text);
        client.closed();
      }
      ++closed;
    } catch (const beast::system_error&) {
      ++closed;
    }
  }
  EXPECT_EQ(closed, 10000);
  const int steps = shown.fake->steps;
  EXPECT_GT(witness.next_step(), 0U);
  witness.say(R"({"type": "ping", "id": 9})");
  EXPECT_EQ(witness.next_json("reply")["id"], 9);
  for (int k = 0; k < 200 && shown.fake->steps <= steps; ++k) std::this_thread::sleep_for(10ms);
  EXPECT_GT(shown.fake->steps, steps);
}

TEST(Server, LimitsConnections) {
  const Shown shown;
  std::vector<std::unique_ptr<Client>> clients;
  int refused = 0;
  for (int k = 0; k < 60; ++k) {
    clients.push_back(std::make_unique<Client>(shown.server->port()));
    try {
      clients.back()->handshake();
    } catch (const beast::system_error&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, 20);
  EXPECT_LT(refused, 40);
}

TEST(Server, SaysThatAPortIsTaken) {
  const Shown shown;
  try {
    const Server second({"127.0.0.1", shown.server->port()}, std::make_unique<FakeSource>());
    ADD_FAILURE() << "two servers on one port";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::address_in_use);
    EXPECT_NE(error.remedy().find("--port"), std::string::npos);
  }
  EXPECT_THROW(Server({"nowhere", 0}, std::make_unique<FakeSource>()), Error);
}

TEST(Server, StopsAtOnceWhateverBrowsersDo) {
  auto shown = std::make_unique<Shown>(200000);
  Client stuck(shown->server->port());
  stuck.greet();
  Client half(shown->server->port());  // connected, says nothing
  std::this_thread::sleep_for(200ms);
  auto stopped = std::async(std::launch::async, [&] { shown.reset(); });
  ASSERT_EQ(stopped.wait_for(30s), std::future_status::ready) << "it waits for a browser";
}

}  // namespace
}  // namespace sinew::viewer
