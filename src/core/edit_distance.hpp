#pragma once

#include <cstddef>
#include <string>

namespace roadstereo {

/// Number of letters to insert, drop or change to get from one word to the other: finds the word that was meant.
std::size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace roadstereo
