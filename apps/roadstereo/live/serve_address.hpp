#pragma once

#include <string>

namespace roadstereo::cli {

/// Address of the live page.
struct ServeAddress {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any free port

  /// Whether only this machine can connect.
  bool loopback() const;
};

/// Parses "[HOST:]PORT": "8080", "0.0.0.0:8080", "[::]:8080". Throws Error if it is invalid.
ServeAddress serve_address(const std::string& text);

/// Formats the host for a URL: IPv6 addresses in brackets.
std::string url_host(const std::string& host);

/// Returns an address of this machine for other machines; its host name if there is none.
std::string outside_address();

}  // namespace roadstereo::cli
