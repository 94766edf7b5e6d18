#pragma once

#include <memory>
#include <string>

#include "live/live_board.hpp"
#include "live/serve_address.hpp"

namespace roadstereo::cli {

/// The page and what it fetches, by HTTP. To this machine alone, unless the address says otherwise; then only to those
/// who know the token. Clients, slow or hung, keep nobody waiting but themselves.
class LiveServer {
 public:
  /// Listens. Throws Error naming the address when it cannot.
  LiveServer(const ServeAddress& address, LiveBoard& board);

  /// Ends the requests that are being served, within about two seconds.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// For a browser; with the token, where there is one.
  std::string url() const;

  int port() const;
  const std::string& token() const;  ///< empty on loopback

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadstereo::cli
