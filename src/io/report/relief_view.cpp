#include "io/report/relief_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/shortest_text.hpp"
#include "io/report/markup.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double max_steps = 32000;
constexpr std::int16_t unknown_step = -32768;

/// Values quantised to 16 bits, little-endian.
struct Steps {
  double step = 1;  ///< of quantisation
  std::string text;
};

Steps in_steps(const Image<float>& values) {
  double largest = 0;
  const float* const begin = values.row(0);
  for (const float* at = begin; at != begin + values.pixels(); ++at) {
    if (std::isfinite(*at)) largest = std::max(largest, static_cast<double>(std::abs(*at)));
  }
  const double step = largest > 0 ? largest / max_steps : 1;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.pixels());
  for (const float* at = begin; at != begin + values.pixels(); ++at) {
    const auto whole = std::isfinite(*at) ? static_cast<std::int16_t>(std::lround(*at / step)) : unknown_step;
    const auto bits = static_cast<std::uint16_t>(whole);
    bytes.push_back(static_cast<std::uint8_t>(bits & 0xffU));
    bytes.push_back(static_cast<std::uint8_t>(bits >> 8U));
  }
  return {step, base64(bytes)};
}

/// One bit per point, starting at the lowest bit.
std::string in_bits(const Image<std::uint8_t>& mask) {
  std::vector<std::uint8_t> bytes((mask.pixels() + 7) / 8);
  const std::uint8_t* const begin = mask.row(0);
  for (std::size_t i = 0; i < mask.pixels(); ++i) {
    if (begin[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | (1U << (i % 8)));
  }
  return base64(bytes);
}

}  // namespace

std::string relief_html(const Relief& relief, const std::string& id, double max_depth) {
  const Steps x = in_steps(relief.x), y = in_steps(relief.y), depth = in_steps(relief.depth);
  return fill(templates::relief, {{"id", id},
                                  {"columns", std::to_string(relief.depth.width())},
                                  {"rows", std::to_string(relief.depth.height())},
                                  {"unit", relief.metric ? "m" : "px"},
                                  {"max_depth", shortest_text(max_depth)},
                                  {"x", x.text},
                                  {"x_step", shortest_text(x.step)},
                                  {"y", y.text},
                                  {"y_step", shortest_text(y.step)},
                                  {"depth", depth.text},
                                  {"depth_step", shortest_text(depth.step)},
                                  {"measured", in_bits(relief.measured)}});
}

}  // namespace roadstereo::io
