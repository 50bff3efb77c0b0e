/// @file
/// The WebSocket of one browser: receives messages, and sends texts and the latest frame.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "frame.hpp"
#include "message.hpp"

namespace sinew::viewer {

class ViewConnection;

/// The owner of all connections, which they notify. All functions run on the server's thread.
class Connections {
 public:
  virtual ~Connections() = default;
  virtual void greet(ViewConnection& connection) = 0;
  virtual void receive(ViewConnection& connection, const Message& message) = 0;
  virtual void lose(ViewConnection& connection) = 0;
  virtual std::uint16_t generation() const = 0;
};

/// A WebSocket connection. It exists as long as operations on its socket are pending.
class ViewConnection : public std::enable_shared_from_this<ViewConnection> {
 public:
  using Socket = boost::beast::websocket::stream<boost::beast::tcp_stream>;

  /// @param stream of an HTTP connection that requested a WebSocket. @param owner is notified of
  /// messages. @param number identifies the connection.
  ViewConnection(boost::beast::tcp_stream&& stream, std::shared_ptr<Connections> owner, int number);

  void accept(const boost::beast::http::request<boost::beast::http::empty_body>& request);
  /// Queues a text. Closes the connection if its queue is too long.
  void send(std::string text);
  /// Queues bytes that are never dropped (surfaces).
  void send(std::shared_ptr<const std::vector<std::byte>> bytes);
  /// Sets the frame to be sent next. It replaces a frame that has not been sent yet.
  void offer(std::shared_ptr<const Frame> frame);
  /// Forgets the frames sent so far, since another robot is shown.
  void forget_frames() {
    last_shape_ = kNoShape;
    frame_.reset();
    last_frame_.reset();
  }
  void close(boost::beast::websocket::close_code code, const std::string& reason);

  int number() const { return number_; }
  bool greeted() const { return greeted_; }
  int field() const { return field_; }
  void choose_field(int field);
  void choose_pick(const std::optional<Picked>& pick) { pick_ = pick; }
  bool inside() const { return inside_; }
  void show_inside(bool on) {
    inside_ = on;
    last_shape_ = kNoShape;  // positions of the interior are still to be sent
  }
  int pending = 0;  ///< number of unanswered requests

 private:
  using Text = std::string;
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;
  static constexpr std::uint64_t kNoShape = ~std::uint64_t{0};

  void read();
  void on_read(boost::beast::error_code error);
  bool within_rate();
  void pump();
  void on_written(boost::beast::error_code error);
  void end();

  Socket socket_;
  std::shared_ptr<Connections> owner_;
  int number_;
  boost::asio::steady_timer hello_timer_;
  boost::beast::flat_buffer incoming_;
  std::deque<std::variant<Text, Bytes>> outgoing_;
  std::size_t queued_ = 0;
  std::shared_ptr<const Frame> frame_;
  std::shared_ptr<const Frame> last_frame_;
  std::vector<std::byte> bytes_;
  std::uint64_t last_shape_ = kNoShape;
  std::uint32_t sequence_ = 0;
  int field_ = -1;
  std::optional<Picked> pick_;
  bool inside_ = false;
  bool open_ = false, writing_ = false, sending_frame_ = false, closing_ = false, greeted_ = false,
       lost_ = false;
  double allowance_;
  std::chrono::steady_clock::time_point last_message_;
};

}  // namespace sinew::viewer
