#include "http_connection.hpp"

#include <utility>

#include <fmt/format.h>

#include "assets.hpp"
#include "limits.hpp"

namespace sinew::viewer {

namespace beast = boost::beast;
namespace http = boost::beast::http;

namespace {

// Forbids scripts and resources of other origins, and embedding in pages that are not from this
// machine (such as a notebook).
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors http://localhost:* http://127.0.0.1:*";

std::string_view text(boost::beast::string_view view) { return {view.data(), view.size()}; }

/// Splits the target of a request into path and query.
std::pair<std::string_view, std::string_view> split_target(std::string_view target) {
  const std::size_t mark = target.find('?');
  if (mark == std::string_view::npos) return {target, {}};
  return {target.substr(0, mark), target.substr(mark + 1)};
}

}  // namespace

HttpConnection::HttpConnection(boost::asio::ip::tcp::socket&& socket, std::shared_ptr<Door> door)
    : stream_(std::move(socket)), door_(std::move(door)), entered_(door_->enter()) {}

HttpConnection::~HttpConnection() {
  if (entered_) door_->leave();
}

void HttpConnection::run() {
  if (entered_) return read();
  stream_.expires_after(limits::kRequestTime);
  refuse(http::status::service_unavailable, "there are too many connections");
}

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(limits::kRequestHeader));
  parser_->body_limit(0);
  stream_.expires_after(limits::kRequestTime);
  auto self = shared_from_this();
  http::async_read(stream_, buffer_, *parser_,
                   [self](beast::error_code error, std::size_t) { self->on_read(error); });
}

void HttpConnection::on_read(beast::error_code error) {
  if (error == http::error::end_of_stream || error == beast::error::timeout) {
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
    return;
  }
  if (error == http::error::header_limit) {
    return refuse(http::status::request_header_fields_too_large, "the request is too long");
  }
  if (error) return refuse(http::status::bad_request, "this request is not understood");
  answer();
}

// Whether a request comes from a page of this server. Pages of other origins are refused, whatever
// host name they use (DNS rebinding).
bool HttpConnection::from_here() const {
  const auto& request = parser_->get();
  const std::string_view host = text(request[http::field::host]);
  if (!door_->knows_host(host)) return false;
  const auto origin = request.find(http::field::origin);
  return origin == request.end() || text(origin->value()) == fmt::format("http://{}", host);
}

void HttpConnection::answer() {
  const auto& request = parser_->get();
  if (!from_here()) return refuse(http::status::forbidden, "this host or origin is not served");
  const auto [path, query] = split_target(text(request.target()));
  if (beast::websocket::is_upgrade(request)) {
    if (path != "/view") return refuse(http::status::not_found, "the view is at /view");
    if (!door_->admits(query)) return refuse(http::status::forbidden, "the token is missing");
    stream_.expires_never();
    return door_->open_view(std::move(stream_), request);
  }
  if (request.method() != http::verb::get && request.method() != http::verb::head) {
    return refuse(http::status::method_not_allowed, "only GET is served");
  }
  constexpr std::string_view kDownload = "/download/";
  if (path.starts_with(kDownload)) {
    if (!door_->admits(query)) return refuse(http::status::forbidden, "the token is missing");
    return answer_download(path.substr(kDownload.size()));
  }
  answer_asset(path);
}

void HttpConnection::answer_asset(std::string_view path) {
  const Asset* asset = find_asset(path);
  if (asset == nullptr) return refuse(http::status::not_found, "there is no such file");
  Response response(http::status::ok, parser_->get().version());
  response.set(http::field::content_type,
               beast::string_view(asset->content_type.data(), asset->content_type.size()));
  const bool packed = accepts_gzip(text(parser_->get()[http::field::accept_encoding]));
  if (packed) response.set(http::field::content_encoding, "gzip");
  response.set(http::field::vary, "Accept-Encoding");
  response.set(http::field::cache_control, "no-cache");
  if (parser_->get().method() == http::verb::get) {
    response.body() = packed ? std::string(asset->bytes) : unpack(*asset);
  }
  send(std::move(response));
}

void HttpConnection::answer_download(std::string_view name) {
  auto self = shared_from_this();
  stream_.expires_never();
  door_->fetch(name, [self](std::optional<Download> file) {
    self->stream_.expires_after(limits::kDownloadTime);
    if (!file) return self->refuse(http::status::not_found, "there is no such file");
    Response response(http::status::ok, self->parser_->get().version());
    response.set(http::field::content_type, file->content_type);
    response.set(http::field::cache_control, "no-store");
    if (!file->content_type.starts_with("image/")) {
      response.set(http::field::content_disposition,
                   fmt::format("attachment; filename=\"{}\"", file->name));
    }
    response.body() = std::move(file->bytes);
    self->send(std::move(response));
  });
}

void HttpConnection::refuse(http::status status, const std::string& why) {
  Response response(status, 11);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.body() = why + "\n";
  response.keep_alive(false);
  send(std::move(response));
}

void HttpConnection::send(Response response) {
  response.set("Content-Security-Policy", kPolicy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  const bool refused = response.result() != http::status::ok;
  if (!refused) response.keep_alive(parser_->get().keep_alive());
  response.prepare_payload();
  auto kept = std::make_shared<Response>(std::move(response));
  auto self = shared_from_this();
  http::async_write(stream_, *kept, [self, kept](beast::error_code error, std::size_t) {
    if (!error && kept->keep_alive()) return self->read();
    self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
  });
}

}  // namespace sinew::viewer
