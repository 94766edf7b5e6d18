#pragma once

#include <string>
#include <string_view>

namespace roadstereo::cli {

/// 128 bits from the system's source of randomness, as 32 hexadecimal digits. Throws SystemError when it has none.
std::string random_token();

/// Whether the texts are equal; takes as long wherever they differ.
bool equal_in_constant_time(std::string_view given, std::string_view wanted);

/// Whether a Host header may stand in a request to a server on this machine only: a page from elsewhere, whose name was
/// made to point here, comes with its own name.
bool names_this_machine(std::string_view host_header);

}  // namespace roadstereo::cli
