#pragma once

#include <array>

#include "json_text.hpp"
#include "map/build_map.hpp"

namespace roadstereo::cli {

inline nlohmann::ordered_json measurement_json(const Measurement& measured) {
  return {{"value", json_number(measured.value)}, {"std_error", json_number(measured.std_error)}};
}

/// A position of the map in the coordinates of the trajectories, with --crs.
inline std::array<double, 2> in_crs(const BuiltMap& built, const std::array<double, 2>& at_m) {
  return {built.origin_m[0] + at_m[0], built.origin_m[1] + at_m[1]};
}

}  // namespace roadstereo::cli
