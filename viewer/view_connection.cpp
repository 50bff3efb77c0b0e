#include "view_connection.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

#include "limits.hpp"

namespace sinew::viewer {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

ViewConnection::ViewConnection(beast::tcp_stream&& stream, std::shared_ptr<Connections> owner,
                               int number)
    : socket_(std::move(stream)),
      owner_(std::move(owner)),
      number_(number),
      hello_timer_(socket_.get_executor()),
      allowance_(limits::kMessageBurst),
      last_message_(std::chrono::steady_clock::now()) {
  socket_.read_message_max(kLongestMessage);
}

void ViewConnection::accept(const beast::http::request<beast::http::empty_body>& request) {
  beast::get_lowest_layer(socket_).expires_never();
  auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeout.idle_timeout = limits::kIdleTime;
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  auto self = shared_from_this();
  socket_.async_accept(request, [self](beast::error_code error) {
    if (error) return self->end();
    self->open_ = true;
    self->hello_timer_.expires_after(limits::kHelloTime);
    self->hello_timer_.async_wait([self](beast::error_code cancelled) {
      if (!cancelled && !self->greeted_) {
        self->close(websocket::close_code::policy_error, "no hello within five seconds");
      }
    });
    self->read();
  });
}

void ViewConnection::read() {
  auto self = shared_from_this();
  incoming_.clear();
  socket_.async_read(incoming_,
                     [self](beast::error_code error, std::size_t) { self->on_read(error); });
}

bool ViewConnection::within_rate() {
  const auto now = std::chrono::steady_clock::now();
  const double since = std::chrono::duration<double>(now - last_message_).count();
  last_message_ = now;
  allowance_ = std::min(limits::kMessageBurst, allowance_ + since * limits::kMessagesPerSecond);
  allowance_ -= 1.0;
  return allowance_ >= 0.0;
}

void ViewConnection::on_read(beast::error_code error) {
  if (error) return end();
  if (closing_) return read();
  if (!within_rate()) {
    close(websocket::close_code::policy_error, "too many messages");
  } else if (!socket_.got_text()) {
    close(websocket::close_code::unknown_data, "only text is understood");
  } else {
    try {
      const auto* text = static_cast<const char*>(incoming_.data().data());
      const Message message = parse_message({text, incoming_.size()});
      const auto* hello = std::get_if<Hello>(&message.request);
      if (!greeted_ && hello == nullptr) {
        close(websocket::close_code::policy_error, "the first message must be hello");
      } else if (hello != nullptr && hello->protocol != kProtocolVersion) {
        close(websocket::close_code::policy_error,
              fmt::format("protocol {} is spoken here; reload the page", kProtocolVersion));
      } else if (hello != nullptr) {
        if (!greeted_) {
          greeted_ = true;
          hello_timer_.cancel();
          owner_->greet(*this);
        }
      } else {
        owner_->receive(*this, message);
      }
    } catch (const Error& wrong) {
      close(wrong.kind() == ErrorKind::bad_encoding ? websocket::close_code::bad_payload
                                                    : websocket::close_code::policy_error,
            wrong.what());
    }
  }
  read();
}

void ViewConnection::send(std::string text) {
  if (closing_) return;
  queued_ += text.size();
  if (queued_ > limits::kQueuedText) {
    return close(websocket::close_code::try_again_later, "the connection is too slow");
  }
  outgoing_.emplace_back(std::move(text));
  pump();
}

void ViewConnection::send(std::shared_ptr<const std::vector<std::byte>> bytes) {
  if (closing_) return;
  outgoing_.emplace_back(std::move(bytes));
  pump();
}

void ViewConnection::offer(std::shared_ptr<const Frame> frame) {
  if (!greeted_ || closing_) return;
  frame_ = std::move(frame);
  pump();
}

void ViewConnection::choose_field(int field) {
  field_ = field;
  if (last_frame_ && !frame_) offer(last_frame_);
}

void ViewConnection::pump() {
  if (writing_ || !open_ || closing_) return;
  auto self = shared_from_this();
  const auto done = [self](beast::error_code error, std::size_t) { self->on_written(error); };
  if (!outgoing_.empty()) {
    writing_ = true;
    sending_frame_ = false;
    if (const auto* text = std::get_if<Text>(&outgoing_.front())) {
      socket_.text(true);
      socket_.async_write(boost::asio::buffer(*text), done);
    } else {
      const Bytes& bytes = std::get<Bytes>(outgoing_.front());
      socket_.binary(true);
      socket_.async_write(boost::asio::buffer(bytes->data(), bytes->size()), done);
    }
  } else if (frame_) {
    writing_ = sending_frame_ = true;
    last_frame_ = std::move(frame_);
    frame_.reset();
    const FrameChoice choice{owner_->generation(),
                             ++sequence_,
                             last_frame_->shape != last_shape_,
                             field_,
                             pick_,
                             inside_};
    // An older frame may lack the requested interior. The next one is then sent in full, even
    // without motion.
    last_shape_ = inside_ && !last_frame_->inside ? kNoShape : last_frame_->shape;
    encode_frame(*last_frame_, choice, bytes_);
    socket_.binary(true);
    socket_.async_write(boost::asio::buffer(bytes_.data(), bytes_.size()), done);
  }
}

void ViewConnection::on_written(beast::error_code error) {
  writing_ = false;
  if (error) return end();
  if (!sending_frame_) {
    if (const auto* text = std::get_if<Text>(&outgoing_.front())) queued_ -= text->size();
    outgoing_.pop_front();
  }
  pump();
}

void ViewConnection::close(websocket::close_code code, const std::string& reason) {
  if (closing_ || !open_) return;
  closing_ = true;
  hello_timer_.cancel();
  auto self = shared_from_this();
  // The reason in a control frame is limited to 123 bytes.
  socket_.async_close({code, reason.substr(0, 120)}, [self](beast::error_code) { self->end(); });
}

void ViewConnection::end() {
  open_ = false;
  hello_timer_.cancel();
  if (lost_) return;
  lost_ = true;
  owner_->lose(*this);
}

}  // namespace sinew::viewer
