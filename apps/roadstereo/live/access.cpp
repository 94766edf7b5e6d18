#include "live/access.hpp"

#include <sys/random.h>

#include <array>
#include <cstdint>

#include "io/plain_text.hpp"
#include "live/serve_address.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

std::string random_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    fail<SystemError>("no random numbers are available for a token");
  }
  constexpr std::string_view digits = "0123456789abcdef";
  std::string token;
  for (const std::uint8_t byte : bytes) {
    token += digits[byte >> 4U];
    token += digits[byte & 15U];
  }
  return token;
}

bool equal_in_constant_time(std::string_view given, std::string_view wanted) {
  unsigned different = given.size() == wanted.size() ? 0 : 1;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const char letter = i < given.size() ? given[i] : '\0';
    different |= static_cast<unsigned>(static_cast<unsigned char>(letter) ^ static_cast<unsigned char>(wanted[i]));
  }
  return different == 0;
}

bool names_this_machine(std::string_view host_header) {
  constexpr std::size_t max_digits = 5;
  const std::size_t colon = host_header.rfind(':');
  const std::size_t bracket = host_header.rfind(']');
  const bool has_port = colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  const std::string_view port = has_port ? host_header.substr(colon + 1) : "";
  if (port.size() > max_digits || port.find_first_not_of("0123456789") != std::string_view::npos) return false;
  std::string host(host_header.substr(0, has_port ? colon : host_header.size()));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  return ServeAddress{io::lower_case(host), 0}.loopback();
}

}  // namespace roadstereo::cli
