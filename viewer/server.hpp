/// @file
/// Serves the page and shows a source to any number of browsers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "source.hpp"

namespace sinew::viewer {

struct ServerSettings {
  std::string host = "127.0.0.1";  ///< address to listen on
  /// 0: any that is free; none: 8080, or the next free one.
  std::optional<std::uint16_t> port;
};

/// One thread of its own serves all connections; the source has its own threads. Bound to another
/// address than this machine's own, the server asks for a random token, which url() holds.
class Server {
 public:
  /// Listens at once, serves from start() on.
  /// @param settings see there. @param source what is shown first.
  /// Throws Error: address-in-use, bad-argument (host).
  Server(const ServerSettings& settings, std::unique_ptr<Source> source);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void start();
  /// Ends all connections and the source. Called by the destructor.
  void stop();

  std::uint16_t port() const;
  /// What to open in a browser.
  const std::string& url() const;

 private:
  class Hub;
  std::shared_ptr<Hub> hub_;
};

}  // namespace sinew::viewer
