/// @file
/// An HTTP connection: serves files of the page and downloads, and opens views.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "source.hpp"

namespace sinew::viewer {

/// The interface of the server to HTTP connections. All functions run on its thread.
class Door {
 public:
  virtual ~Door() = default;
  virtual bool knows_host(std::string_view host) const = 0;
  /// Whether the query of a request (the part after "?") has the token, if one is required.
  virtual bool admits(std::string_view query) const = 0;
  virtual void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) = 0;
  virtual void open_view(
      boost::beast::tcp_stream&& stream,
      const boost::beast::http::request<boost::beast::http::empty_body>& request) = 0;
  /// Counts a new connection; false if there are too many.
  virtual bool enter() = 0;
  virtual void leave() = 0;
};

/// One HTTP connection.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  /// @param socket of the browser. @param door interface of the server.
  HttpConnection(boost::asio::ip::tcp::socket&& socket, std::shared_ptr<Door> door);
  ~HttpConnection();
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void run();

 private:
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  void read();
  void on_read(boost::beast::error_code error);
  void answer();
  void answer_asset(std::string_view path);
  void answer_download(std::string_view name);
  void refuse(boost::beast::http::status status, const std::string& why);
  void send(Response response);
  bool from_here() const;

  boost::beast::tcp_stream stream_;
  std::shared_ptr<Door> door_;
  bool entered_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
};

}  // namespace sinew::viewer
