#include "stereo/coarse/texture_uncertainty.hpp"

namespace roadstereo {

void TextureUncertainty::prepare(int columns) {
  squares_.reserve(static_cast<std::size_t>(columns));
  products_.reserve(static_cast<std::size_t>(columns));
  texture_uncertainty_.reserve(static_cast<std::size_t>(columns));
}

void TextureUncertainty::start(ImageView<const std::int16_t> image, int first_row,
                               const TextureUncertaintyOptions& options) {
  image_ = image;
  options_ = options;
  row_ = first_row;
  const auto columns = static_cast<std::size_t>(image.width());
  squares_.assign(columns, 0);
  products_.assign(columns, 0);
  texture_uncertainty_.resize(columns);
  for (int v = first_row - options.block_radius; v < first_row + options.block_radius; ++v) add_row(v, 1);
}

/// Adds the gradients of one row to the column sums, or takes them away; rows without both neighbours have none.
void TextureUncertainty::add_row(int v, int sign) {
  if (v < 1 || v + 1 >= image_.height()) return;
  const std::int16_t* above = image_.row(v - 1);
  const std::int16_t* row = image_.row(v);
  const std::int16_t* below = image_.row(v + 1);
  for (int u = 1; u + 1 < image_.width(); ++u) {
    const CoarseGradient gradient = coarse_gradient(row[u - 1], row[u + 1], above[u], below[u]);
    const auto column = static_cast<std::size_t>(u);
    squares_[column] += sign * gradient.across * gradient.across;
    products_[column] += sign * gradient.across * gradient.down;
  }
}

const std::vector<float>& TextureUncertainty::next() {
  const int radius = options_.block_radius;
  add_row(row_ + radius, 1);
  const int width = image_.width();
  const UncertaintyParams terms = uncertainty_params(options_);
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
    texture_uncertainty_[static_cast<std::size_t>(u)] = texture_uncertainty(squares, products, terms);
    slide(u - radius, -1);
  }
  add_row(row_ - radius, -1);
  ++row_;
  return texture_uncertainty_;
}

}  // namespace roadstereo
