#include "synth/noise.hpp"

#include <cmath>

#include "synth/hash.hpp"

namespace roadstereo::synth {
namespace {

constexpr std::uint32_t step_x = 0x9e3779b1u;
constexpr std::uint32_t step_y = 0x85ebca77u;
constexpr std::uint32_t step_z = 0xc2b2ae3du;

/// Lattice coordinate: cell, position in the cell, and weight of the upper end of the cell (quintic fade).
struct LatticeCoordinate {
  explicit LatticeCoordinate(double x) {
    // std::floor is a function call on processors without SSE4.
    auto floor = static_cast<std::int32_t>(x);
    if (x < floor) --floor;
    cell = static_cast<std::uint32_t>(floor);
    position = static_cast<float>(x - floor);
    weight = position * position * position * (position * (position * 6 - 15) + 10);
  }
  std::uint32_t cell;
  float position;
  float weight;
};

/// Gradient components are signed 16-bit integers; scales them to [−1, 1].
constexpr float component_scale = 1.0f / 32768;

float lower_half(std::uint32_t hash) {
  return static_cast<float>(static_cast<std::int16_t>(hash));
}

float upper_half(std::uint32_t hash) {
  return static_cast<float>(static_cast<std::int32_t>(hash) >> 16);
}

/// Gradient of a lattice point times the offset from it.
float corner(std::uint32_t key, float dx, float dy) {
  const std::uint32_t hash = mix32(key);
  return lower_half(hash) * dx + upper_half(hash) * dy;
}

float corner(std::uint32_t key, float dx, float dy, float dz) {
  const std::uint32_t hash = mix32(key);
  return lower_half(hash) * dx + upper_half(hash) * dy + upper_half(hash * step_x) * dz;
}

float lerp(float a, float b, float weight) {
  return a + weight * (b - a);
}

/// Noise in one z layer of the lattice, at distance `dz` from it.
float layer(const LatticeCoordinate& x, const LatticeCoordinate& y, std::uint32_t key, float dz) {
  const float a = corner(key, x.position, y.position, dz);
  const float b = corner(key + step_x, x.position - 1, y.position, dz);
  const float c = corner(key + step_y, x.position, y.position - 1, dz);
  const float d = corner(key + step_x + step_y, x.position - 1, y.position - 1, dz);
  return lerp(lerp(a, b, x.weight), lerp(c, d, x.weight), y.weight);
}

}  // namespace

double gradient_noise(double x, double y, std::uint32_t seed) {
  const LatticeCoordinate px(x);
  const LatticeCoordinate py(y);
  const std::uint32_t key = px.cell * step_x + py.cell * step_y + seed;
  const float a = corner(key, px.position, py.position);
  const float b = corner(key + step_x, px.position - 1, py.position);
  const float c = corner(key + step_y, px.position, py.position - 1);
  const float d = corner(key + step_x + step_y, px.position - 1, py.position - 1);
  return component_scale * lerp(lerp(a, b, px.weight), lerp(c, d, px.weight), py.weight);
}

double gradient_noise(double x, double y, double z, std::uint32_t seed) {
  const LatticeCoordinate px(x);
  const LatticeCoordinate py(y);
  const LatticeCoordinate pz(z);
  const std::uint32_t key = px.cell * step_x + py.cell * step_y + pz.cell * step_z + seed;
  return component_scale *
         lerp(layer(px, py, key, pz.position), layer(px, py, key + step_z, pz.position - 1), pz.weight);
}

}  // namespace roadstereo::synth
