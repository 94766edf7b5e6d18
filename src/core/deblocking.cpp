#include "core/deblocking.hpp"

namespace roadstereo {

BlockSteps measure_block_steps(ImageView<const std::int16_t> image) {
  BlockSteps steps;
  const auto add = [&steps](int between, int beside) {
    steps.between += between;
    steps.beside += beside;
  };
  for (int v = 1; v < image.height(); v += BlockStepSamples::step) {
    const std::int16_t* const row = image.row(v);
    int between = 0, beside = 0;
    for (int u = jpeg_block; u + 1 < image.width(); u += jpeg_block) {
      add_steps(row[u - 2], row[u - 1], row[u], row[u + 1], between, beside);
    }
    add(between, beside);
  }
  for (int v = jpeg_block; v + 1 < image.height(); v += jpeg_block) {
    int between = 0, beside = 0;
    for (int u = 0; u < image.width(); u += BlockStepSamples::step) {
      add_steps(image(u, v - 2), image(u, v - 1), image(u, v), image(u, v + 1), between, beside);
    }
    add(between, beside);
  }
  return steps;
}

void smooth_block_steps(ImageView<std::int16_t> image, int strength) {
  const int width = image.width(), height = image.height();
  for (int v = 0; v < height; ++v) {
    std::int16_t* const row = image.row(v);
    for (int u = jpeg_block; u + 1 < width; u += jpeg_block) {
      smooth_step(row[u - 2], row[u - 1], row[u], row[u + 1], strength);
    }
  }
  for (int v = jpeg_block; v + 1 < height; v += jpeg_block) {
    std::int16_t *const a = image.row(v - 2), *const b = image.row(v - 1), *const c = image.row(v),
                        *const d = image.row(v + 1);
    for (int u = 0; u < width; ++u) smooth_step(a[u], b[u], c[u], d[u], strength);
  }
}

}  // namespace roadstereo
