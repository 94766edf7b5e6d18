#pragma once

#include <numbers>

namespace roadstereo {

constexpr double to_degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

constexpr double to_radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

}  // namespace roadstereo
