#pragma once

#include <string>
#include <vector>

namespace roadstereo::cli {

/// Preset with one component removed or added.
struct Variant {
  std::string name;
  std::string preset;
  std::vector<std::string> settings{};  ///< KEY=VALUE
  bool with_perspective = true;         ///< false: no perspective transformation; the full disparity range is searched
};

/// The preset "default" and its variants, then the preset "paper" and its variants. A preset precedes its variants.
const std::vector<Variant>& ablation_variants();

/// Index of the preset that a variant is based on.
std::size_t base_of(std::size_t variant);

}  // namespace roadstereo::cli
