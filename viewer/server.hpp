/// @file
/// The server of the page, which shows a source to any number of browsers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "source.hpp"

namespace sinew::viewer {

/// Address and port of the server.
struct ServerSettings {
  std::string host = "127.0.0.1";  ///< address to listen on
  /// Port to listen on. 0: any free port; none: 8080 or the next free one.
  std::optional<std::uint16_t> port;
};

/// Serves all connections on one thread of its own; the source has its own threads. If it listens
/// on an address other than the loopback address, requests need a random token, which url()
/// contains.
class Server {
 public:
  /// Listens immediately, but serves only after start(). Throws Error: address-in-use, bad-argument
  /// (host). @param settings of the server. @param source shown first.
  Server(const ServerSettings& settings, std::unique_ptr<Source> source);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void start();
  /// Ends all connections and the source. The destructor calls it.
  void stop();

  std::uint16_t port() const;
  /// The address to open in a browser.
  const std::string& url() const;

 private:
  class Hub;
  std::shared_ptr<Hub> hub_;
};

}  // namespace sinew::viewer
