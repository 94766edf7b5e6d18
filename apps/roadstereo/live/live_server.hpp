#pragma once

#include <memory>
#include <string>

#include "live/live_board.hpp"
#include "live/serve_address.hpp"

namespace roadstereo::cli {

/// HTTP server of the live page. Accepts requests with the token, or on loopback without one. Slow clients do not delay
/// processing or each other.
class LiveServer {
 public:
  /// Starts listening. Throws Error naming the address on failure.
  LiveServer(const ServeAddress& address, LiveBoard& board);

  /// Stops within about two seconds.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// Address of the page including the token.
  std::string url() const;

  int port() const;
  const std::string& token() const;  ///< empty on loopback

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::cli
