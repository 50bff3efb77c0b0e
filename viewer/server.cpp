#include "server.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/build_info.hpp"

#include "http_connection.hpp"
#include "limits.hpp"
#include "view_connection.hpp"

namespace sinew::viewer {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Tcp = boost::asio::ip::tcp;
using Json = nlohmann::json;

namespace {

constexpr int kMaxFields = 16;
constexpr int kUsualPort = 8080;
constexpr int kPortsToTry = 20;  // after the usual one

std::string random_hex(int bytes) {
  std::random_device device;
  std::string text;
  for (int k = 0; k < bytes; ++k) text += fmt::format("{:02x}", device() & 0xffU);
  return text;
}

/// Compares texts in constant time.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

std::string reply(std::optional<std::int64_t> id, const Outcome& outcome) {
  Json message = {{"type", "reply"}, {"id", *id}};
  if (outcome) {
    message["error"] = {{"kind", error_kind_name(outcome->kind())},
                        {"message", outcome->message()},
                        {"remedy", outcome->remedy()}};
  }
  return message.dump();
}

}  // namespace

/// The shared part of all connections. It is used only on the server's thread, except Publisher.
class Server::Hub final : public Publisher,
                          public Connections,
                          public Door,
                          public std::enable_shared_from_this<Server::Hub> {
 public:
  Hub(const ServerSettings& settings, std::unique_ptr<Source> source)
      : io_(std::make_unique<asio::io_context>(1)),
        acceptor_(std::in_place, *io_),
        status_timer_(std::in_place, *io_),
        source_(std::move(source)) {
    for (auto& wish : wishes_) wish = 0;
    listen(settings);
    const bool local = acceptor_->local_endpoint().address().is_loopback();
    if (!local) token_ = random_hex(16);
    const std::string host =
        local ? fmt::format("127.0.0.1:{}", port()) : fmt::format("{}:{}", settings.host, port());
    url_ = fmt::format("http://{}/{}", host, local ? "" : "?token=" + token_);
    any_host_ = !local;
  }

  void start() {
    thread_ = std::thread([self = shared_from_this()] {
      self->accept();
      self->source_->start(*self);
      self->io_->run();
    });
  }

  void stop() {
    if (!thread_.joinable()) return;
    io_->stop();
    thread_.join();
    source_->stop();
    views_.clear();
    status_timer_.reset();
    acceptor_.reset();
    io_.reset();  // and its pending operations, which keep this object alive
  }

  std::uint16_t port() const { return port_; }
  const std::string& url() const { return url_; }

  // Publisher, called from any thread.
  void publish(std::shared_ptr<const Frame> frame) override {
    const std::lock_guard lock(mutex_);
    latest_ = std::move(frame);
    if (std::exchange(delivery_posted_, true)) return;
    asio::post(*io_, [self = weak_from_this()] {
      if (auto hub = self.lock()) hub->deliver();
    });
  }
  void publish_status(std::string status) override {
    const std::lock_guard lock(mutex_);
    status_ = std::move(status);
    asio::post(*io_, [self = weak_from_this()] {
      if (auto hub = self.lock()) hub->tell_status();
    });
  }
  bool wants_field(int field) const override {
    return field >= 0 && field < kMaxFields && wishes_[static_cast<std::size_t>(field)] > 0;
  }
  std::vector<Picked> picks() const override {
    const std::lock_guard lock(mutex_);
    std::set<Picked> wanted;
    for (const auto& [number, pick] : picks_) wanted.insert(pick);
    return {wanted.begin(), wanted.end()};
  }
  bool wants_inside() const override { return inside_ > 0; }
  void replace(std::function<std::unique_ptr<Source>()> next) override {
    asio::post(*io_, [self = weak_from_this(), next = std::move(next)] {
      if (auto hub = self.lock()) hub->change_source(next);
    });
  }

  // Connections.
  std::uint16_t generation() const override { return generation_; }
  void greet(ViewConnection& view) override {
    if (!driver_) driver_ = view.number();
    view.send(Json{{"type", "welcome"},
                   {"protocol", kProtocolVersion},
                   {"version", version()},
                   {"instance", instance_},
                   {"client", view.number()}}
                  .dump());
    introduce(view);
    tell_status();
    const std::lock_guard lock(mutex_);
    if (latest_) view.offer(latest_);
  }
  void lose(ViewConnection& view) override {
    wish(view.field(), -1);
    choose_pick(view, {});
    show_inside(view, false);
    const bool drove = driver_ == view.number();
    views_.erase(view.number());
    if (drove) {
      driver_.reset();
      source_->submit(Release{}, [](const Outcome&) {});
    }
    tell_status();
  }
  void receive(ViewConnection& view, const Message& message) override;

  // Door, called on the server's thread.
  bool knows_host(std::string_view host) const override {
    if (any_host_) return !host.empty();
    for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) {
      if (host == fmt::format("{}:{}", name, port())) return true;
    }
    return false;
  }
  bool admits(std::string_view query) const override {
    if (token_.empty()) return true;
    constexpr std::string_view kKey = "token=";
    return query.starts_with(kKey) && same(query.substr(kKey.size()), token_);
  }
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override {
    source_->fetch(name, [this, done = std::move(done)](std::optional<Download> file) {
      asio::post(*io_, [done, file = std::move(file)]() mutable { done(std::move(file)); });
    });
  }
  void open_view(beast::tcp_stream&& stream,
                 const beast::http::request<beast::http::empty_body>& request) override {
    const int number = ++last_number_;
    auto view = std::make_shared<ViewConnection>(std::move(stream), shared_from_this(), number);
    views_.emplace(number, view);
    view->accept(request);
  }
  bool enter() override {
    if (entered_ + views_.size() >= limits::kConnections) return false;
    ++entered_;
    return true;
  }
  void leave() override { --entered_; }

 private:
  void listen(const ServerSettings& settings);
  void accept();
  void deliver();
  void introduce(ViewConnection& view);
  void tell_status();
  void change_source(const std::function<std::unique_ptr<Source>()>& next);
  void choose_field(ViewConnection& view, const std::optional<std::string>& name);
  void choose_pick(ViewConnection& view, const Pick& pick);
  void show_inside(ViewConnection& view, bool on);
  void wish(int field, int change) {
    if (field >= 0 && field < kMaxFields) wishes_[static_cast<std::size_t>(field)] += change;
  }

  std::unique_ptr<asio::io_context> io_;
  std::optional<Tcp::acceptor> acceptor_;
  std::optional<asio::steady_timer> status_timer_;
  std::uint16_t port_ = 0;
  std::unique_ptr<Source> source_;
  std::thread thread_;
  std::string token_, url_;
  std::string instance_ = random_hex(8);
  bool any_host_ = false;

  std::map<int, std::shared_ptr<ViewConnection>> views_;
  std::size_t entered_ = 0;
  int last_number_ = 0;
  std::optional<int> driver_;
  std::uint16_t generation_ = 1;
  std::chrono::steady_clock::time_point last_status_;
  bool status_waits_ = false;
  std::array<std::atomic<int>, kMaxFields> wishes_;
  std::atomic<int> inside_ = 0;  ///< connections that request interiors of bodies

  mutable std::mutex mutex_;  // protects the members below
  std::shared_ptr<const Frame> latest_;
  std::string status_ = "{}";
  std::map<int, Picked> picks_;  ///< by the connections' numbers
  bool delivery_posted_ = false;
};

void Server::Hub::listen(const ServerSettings& settings) {
  beast::error_code error;
  const int first = settings.port.value_or(kUsualPort);
  const int last = settings.port ? first : first + kPortsToTry;
  const auto address =
      asio::ip::make_address(settings.host == "localhost" ? "127.0.0.1" : settings.host, error);
  if (error) {
    throw Error(ErrorKind::bad_argument, {.item = "--host"},
                fmt::format("'{}' is not an address", settings.host),
                "give an address of this machine, such as 127.0.0.1 or 0.0.0.0");
  }
  for (int port = first; port <= last; ++port) {
    const Tcp::endpoint endpoint(address, static_cast<std::uint16_t>(port));
    acceptor_->open(endpoint.protocol());
    acceptor_->set_option(asio::socket_base::reuse_address(true));
    acceptor_->bind(endpoint, error);
    if (!error) acceptor_->listen(asio::socket_base::max_listen_connections, error);
    if (!error) break;
    acceptor_->close();
    if (error != asio::error::address_in_use) break;
  }
  if (error) {
    throw Error(
        error == asio::error::address_in_use ? ErrorKind::address_in_use : ErrorKind::bad_argument,
        {.item = "--port"},
        fmt::format("{}:{} cannot be listened on: {}", settings.host, first, error.message()),
        "choose another --port, or 0 for any that is free");
  }
  port_ = acceptor_->local_endpoint().port();
}

void Server::Hub::accept() {
  acceptor_->async_accept([self = weak_from_this()](beast::error_code error, Tcp::socket socket) {
    auto hub = self.lock();
    if (!hub || error == asio::error::operation_aborted) return;
    if (!error) {
      socket.set_option(Tcp::no_delay(true), error);
      std::make_shared<HttpConnection>(std::move(socket), hub)->run();
    }
    hub->accept();
  });
}

void Server::Hub::deliver() {
  std::shared_ptr<const Frame> frame;
  {
    const std::lock_guard lock(mutex_);
    delivery_posted_ = false;
    frame = latest_;
  }
  for (const auto& [number, view] : std::map(views_)) view->offer(frame);
}

void Server::Hub::introduce(ViewConnection& view) {
  const Description& shown = source_->description();
  view.send(fmt::format(R"({{"type":"scene","generation":{},"mode":"{}","scene":{}}})", generation_,
                        source_->mode(), shown.scene));
  for (std::size_t b = 0; b < shown.surfaces.size(); ++b) {
    view.send(std::make_shared<const std::vector<std::byte>>(
        encode_surface(shown.surfaces[b], static_cast<int>(b), generation_)));
  }
  view.forget_frames();
}

void Server::Hub::tell_status() {
  const auto now = std::chrono::steady_clock::now();
  if (status_waits_) return;
  if (now - last_status_ < limits::kStatusInterval) {
    status_waits_ = true;
    status_timer_->expires_at(last_status_ + limits::kStatusInterval);
    status_timer_->async_wait([self = weak_from_this()](beast::error_code error) {
      auto hub = self.lock();
      if (!hub || error) return;
      hub->status_waits_ = false;
      hub->tell_status();
    });
    return;
  }
  last_status_ = now;
  std::string status;
  {
    const std::lock_guard lock(mutex_);
    status = status_;
  }
  const std::string text =
      fmt::format(R"({{"type":"status","clients":{},"driver":{},"source":{}}})", views_.size(),
                  driver_ ? fmt::format("{}", *driver_) : "null", status);
  for (const auto& [number, view] : std::map(views_)) {
    if (view->greeted()) view->send(text);
  }
}

void Server::Hub::change_source(const std::function<std::unique_ptr<Source>()>& next) {
  std::unique_ptr<Source> source;
  try {
    source = next();
  } catch (const Error& error) {
    const std::string text =
        Json{{"type", "notice"}, {"level", "error"}, {"text", error.what()}}.dump();
    for (const auto& [number, view] : std::map(views_)) view->send(text);
    return;
  }
  source_->stop();
  source_ = std::move(source);
  ++generation_;
  for (auto& wish : wishes_) wish = 0;
  inside_ = 0;
  {
    const std::lock_guard lock(mutex_);
    latest_.reset();
    status_ = "{}";
    picks_.clear();
  }
  for (const auto& [number, view] : std::map(views_)) {
    view->forget_frames();
    view->choose_field(-1);
    view->choose_pick({});
    view->show_inside(false);
    if (view->greeted()) introduce(*view);
  }
  source_->start(*this);
}

void Server::Hub::choose_field(ViewConnection& view, const std::optional<std::string>& name) {
  const std::vector<std::string>& fields = source_->description().fields;
  int chosen = -1;
  if (name) {
    const auto found = std::ranges::find(fields, *name);
    if (found == fields.end()) {
      throw Error(ErrorKind::unknown_name, {.item = "name"},
                  fmt::format("there is no field '{}'", *name),
                  fmt::format("choose among {}", fmt::join(fields, ", ")));
    }
    chosen = static_cast<int>(found - fields.begin());
  }
  wish(view.field(), -1);
  wish(chosen, 1);
  view.choose_field(chosen);
}

void Server::Hub::choose_pick(ViewConnection& view, const Pick& pick) {
  std::optional<Picked> chosen;
  if (pick.body) {
    const std::vector<DisplaySurface>& surfaces = source_->description().surfaces;
    const auto found = std::ranges::find(surfaces, *pick.body, &DisplaySurface::body);
    if (found == surfaces.end()) {
      throw Error(ErrorKind::unknown_name, {.item = "body"},
                  fmt::format("there is no body '{}'", *pick.body),
                  "name one of the scene's bodies");
    }
    const bool node = pick.kind == PickKind::node;
    const int count = node ? found->node_count : found->element_count;
    if (pick.number >= count) {
      throw Error(ErrorKind::index_out_of_range, {.item = "number"},
                  fmt::format("{} {} of {}", node ? "node" : "element", pick.number, count),
                  node ? "name a node of the mesh" : "name an element of the mesh");
    }
    chosen = Picked{static_cast<int>(found - surfaces.begin()), pick.kind, pick.number};
  }
  view.choose_pick(chosen);
  const std::lock_guard lock(mutex_);
  picks_.erase(view.number());
  if (chosen) picks_.emplace(view.number(), *chosen);
}

void Server::Hub::show_inside(ViewConnection& view, bool on) {
  inside_ += static_cast<int>(on) - static_cast<int>(view.inside());
  const bool had = view.inside();
  view.show_inside(on);
  if (!on || had) return;
  const std::vector<DisplaySurface>& surfaces = source_->description().surfaces;
  for (std::size_t b = 0; b < surfaces.size(); ++b) {
    view.send(std::make_shared<const std::vector<std::byte>>(
        encode_interior(surfaces[b], static_cast<int>(b), generation_)));
  }
}

void Server::Hub::receive(ViewConnection& view, const Message& message) {
  const auto answer = [&view, &message](const Outcome& outcome) {
    if (message.id) view.send(reply(message.id, outcome));
  };
  try {
    if (const auto* field = std::get_if<ChooseField>(&message.request)) {
      choose_field(view, field->name);
      source_->submit(message.request, [](const Outcome&) {});  // a paused robot needs a frame
      return answer({});
    }
    if (const auto* pick = std::get_if<Pick>(&message.request)) {
      choose_pick(view, *pick);
      source_->submit(message.request, [](const Outcome&) {});
      return answer({});
    }
    if (const auto* inside = std::get_if<ShowInside>(&message.request)) {
      show_inside(view, inside->on);
      source_->submit(message.request, [](const Outcome&) {});
      return answer({});
    }
    if (const auto* ready = std::get_if<Ready>(&message.request)) {
      if (ready->generation == generation_) source_->submit(*ready, [](const Outcome&) {});
      return answer({});
    }
    if (std::holds_alternative<Ping>(message.request)) return answer({});
    if (const auto* drive = std::get_if<DriveRequest>(&message.request)) {
      if (drive->on) {
        driver_ = view.number();
      } else if (driver_ == view.number()) {
        driver_.reset();
      }
      tell_status();
      return answer({});
    }
    if (driver_ != view.number()) {
      throw Error(ErrorKind::not_driving, {}, "another browser drives this robot",
                  "take over driving first");
    }
    if (view.pending >= static_cast<int>(limits::kPendingRequests)) {
      throw Error(ErrorKind::size_limit, {}, "too many requests wait for an answer",
                  "wait for the replies");
    }
  } catch (const Error& error) {
    return answer(error);
  }
  ++view.pending;
  source_->submit(message.request, [self = weak_from_this(), number = view.number(),
                                    id = message.id](const Outcome& outcome) {
    auto hub = self.lock();
    if (!hub) return;
    asio::post(*hub->io_, [hub, number, id, outcome] {
      const auto found = hub->views_.find(number);
      if (found == hub->views_.end()) return;
      --found->second->pending;
      if (id) found->second->send(reply(id, outcome));
    });
  });
}

Server::Server(const ServerSettings& settings, std::unique_ptr<Source> source)
    : hub_(std::make_shared<Hub>(settings, std::move(source))) {}
Server::~Server() { stop(); }
void Server::start() { hub_->start(); }
void Server::stop() { hub_->stop(); }
std::uint16_t Server::port() const { return hub_->port(); }
const std::string& Server::url() const { return hub_->url(); }

}  // namespace sinew::viewer
