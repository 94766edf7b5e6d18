#pragma once

#include <string>

namespace roadstereo::cli {

/// Where the page is served.
struct ServeAddress {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free

  /// Only this machine can reach it.
  bool loopback() const;
};

/// From "[HOST:]PORT": "8080", "0.0.0.0:8080", "[::]:8080". Throws Error when it is none.
ServeAddress serve_address(const std::string& text);

/// The host as it stands in a URL: IPv6 addresses in brackets.
std::string url_host(const std::string& host);

/// An address by which other machines may reach this one; its name when it has none.
std::string outside_address();

}  // namespace roadstereo::cli
