#pragma once

#include <string>
#include <vector>

namespace roadstereo::cli {

/// A preset with one idea taken away, or one added.
struct Variant {
  std::string name;
  std::string preset;                   ///< where it starts from
  std::vector<std::string> settings{};  ///< KEY=VALUE
  bool with_perspective = true;         ///< false: no shift, and the disparities of the whole scene are searched
};

/// "default" with its ideas taken away one at a time, then "paper" without its own and with ours. A preset as it is
/// stands before its variants.
const std::vector<Variant>& ablation_variants();

/// Index of the preset that a variant is compared with.
std::size_t base_of(std::size_t variant);

}  // namespace roadstereo::cli
