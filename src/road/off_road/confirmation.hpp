#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "roadstereo/host_device.hpp"

// What confirms the disparities of a cell, for the host and for kernels. C++17.

namespace roadstereo {

/// States of a cell.
enum CellState : std::uint8_t {
  confirmed = 0,
  unconfirmed = 1,
  off_road = 2,  ///< unconfirmed, and connected with the border
};

/// Cells to either side whose standard errors count.
constexpr int confirmation_radius = 4;

/// Sum of logarithms of standard errors, and the number of them.
struct LogSigmas {
  int sum = 0;  ///< of log2 σ / pixel, 1/256
  int count = 0;

  ROADSTEREO_HD void add(const LogSigmas& other) {
    sum += other.sum;
    count += other.count;
  }
};

/// log2 σ in 1/256: the bits of a float are its logarithm within 0.09, and whole numbers give one sum in any order. A
/// pixel without a disparity counts as 3 pixels.
ROADSTEREO_HD inline int log_sigma(float sigma) {
  constexpr float without_disparity = 3;
  constexpr int mantissa_bits = 23, fraction_bits = 8, exponent_bias = 127;
  const float known = sigma == sigma ? sigma : without_disparity;
  std::int32_t bits = 0;
  memcpy(&bits, &known, sizeof bits);
  return (bits >> (mantissa_bits - fraction_bits)) - (exponent_bias << fraction_bits);
}

/// Whether the pictures confirm a cell whose surroundings have these standard errors and this correlation.
ROADSTEREO_HD inline CellState assess_cell(const LogSigmas& sigmas, float correlation, float log2_max_sigma) {
  constexpr float log2_of_3 = 1.5849625F, steps = 256;
  const float mean = static_cast<float>(sigmas.sum) / (steps * static_cast<float>(sigmas.count));
  return mean > log2_max_sigma + log2_of_3 * (correlation - 1) ? unconfirmed : confirmed;
}

}  // namespace roadstereo
