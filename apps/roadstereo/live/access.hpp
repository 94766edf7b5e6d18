#pragma once

#include <string>
#include <string_view>

namespace roadstereo::cli {

/// Returns 128 random bits of the system as 32 hexadecimal digits. Throws SystemError if they are not available.
std::string random_token();

/// Compares two texts in constant time.
bool equal_in_constant_time(std::string_view given, std::string_view wanted);

/// Returns whether a Host header is allowed in a request to a loopback server. Protects against DNS rebinding.
bool names_this_machine(std::string_view host_header);

}  // namespace roadstereo::cli
