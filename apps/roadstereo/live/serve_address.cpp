#include "live/serve_address.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <memory>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

int port_from(const std::string& text, const std::string& whole) {
  int port = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() || port < 0 || port > 65535) {
    fail("--serve is \"", whole, "\"; it must be [HOST:]PORT with a port from 0 (any) to 65535");
  }
  return port;
}

}  // namespace

bool ServeAddress::loopback() const {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127;
  return host == "localhost" || host == "::1";
}

ServeAddress serve_address(const std::string& text) {
  ServeAddress address;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) {
    address.port = port_from(text, text);
    return address;
  }
  address.host = text.substr(0, colon);
  address.port = port_from(text.substr(colon + 1), text);
  const bool bracketed = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (bracketed) address.host = address.host.substr(1, address.host.size() - 2);
  if (address.host == ":") address.host = "::";  // ":::8080"
  const bool bare_v6 = !bracketed && address.host != "::" && address.host.find(':') != std::string::npos;
  if (address.host.empty() || bare_v6) {
    fail("--serve is \"", text, "\"; it must be [HOST:]PORT, IPv6 addresses in brackets: [::]:8080");
  }
  return address;
}

std::string url_host(const std::string& host) {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::string outside_address() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) == 0) {
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, freeifaddrs);
    for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
      if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
      if ((at->ifa_flags & IFF_LOOPBACK) != 0 || (at->ifa_flags & IFF_UP) == 0) continue;
      std::array<char, INET_ADDRSTRLEN> text{};
      const auto* address = reinterpret_cast<const sockaddr_in*>(at->ifa_addr);
      return inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    }
  }
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

}  // namespace roadstereo::cli
