#include "stereo/coarse/evidence.hpp"

#include <algorithm>

namespace roadstereo {
namespace {

/// Gradients are counted in quarters of a grey level over two pixels, so that their sums stay exact in 32 bits.
constexpr int gradient_shift = 2;
constexpr double gradient_unit = 2.0 * grey_scale / (1 << gradient_shift);

}  // namespace

void Evidence::prepare(int columns) {
  squares_.reserve(static_cast<std::size_t>(columns));
  products_.reserve(static_cast<std::size_t>(columns));
  ignorance_.reserve(static_cast<std::size_t>(columns));
}

void Evidence::start(ImageView<const std::int16_t> image, int first_row, const EvidenceOptions& options) {
  image_ = image;
  options_ = options;
  row_ = first_row;
  const auto columns = static_cast<std::size_t>(image.width());
  squares_.assign(columns, 0);
  products_.assign(columns, 0);
  ignorance_.resize(columns);
  for (int v = first_row - options.block_radius; v < first_row + options.block_radius; ++v) add_row(v, 1);
}

/// Adds the gradients of one row to the column sums, or takes them away; rows without both neighbours have none.
void Evidence::add_row(int v, int sign) {
  if (v < 1 || v + 1 >= image_.height()) return;
  const std::int16_t* above = image_.row(v - 1);
  const std::int16_t* row = image_.row(v);
  const std::int16_t* below = image_.row(v + 1);
  for (int u = 1; u + 1 < image_.width(); ++u) {
    const int across = (row[u + 1] - row[u - 1]) >> gradient_shift;
    const int down = (below[u] - above[u]) >> gradient_shift;
    const auto column = static_cast<std::size_t>(u);
    squares_[column] += sign * across * across;
    products_[column] += sign * across * down;
  }
}

const std::vector<float>& Evidence::next() {
  const int radius = options_.block_radius;
  add_row(row_ + radius, 1);
  const int width = image_.width();
  const auto noise2 = static_cast<float>(options_.noise * options_.noise * gradient_unit * gradient_unit);
  const auto row_error2 = static_cast<float>(options_.row_error * options_.row_error);
  const auto half2 = static_cast<float>(options_.half_at * options_.half_at);
  std::int32_t squares = 0, products = 0;
  const auto slide = [&](int u, std::int32_t sign) {
    if (u < 0 || u >= width) return;
    const auto column = static_cast<std::size_t>(u);
    squares += sign * squares_[column];
    products += sign * products_[column];
  };
  for (int u = 0; u < radius; ++u) slide(u, 1);
  for (int u = 0; u < width; ++u) {
    slide(u + radius, 1);
    const float known = std::max(1.0f, static_cast<float>(squares));
    const float tilt = static_cast<float>(products) / known;
    const float variance = noise2 / known + row_error2 * tilt * tilt;
    ignorance_[static_cast<std::size_t>(u)] = variance / (variance + half2);
    slide(u - radius, -1);
  }
  add_row(row_ - radius, -1);
  ++row_;
  return ignorance_;
}

}  // namespace roadstereo
