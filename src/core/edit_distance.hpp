#pragma once

#include <cstddef>
#include <string>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Levenshtein distance of two words, to suggest the word that was meant.
std::size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace roadstereo
#pragma GCC visibility pop
