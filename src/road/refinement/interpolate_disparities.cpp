#include <algorithm>

#include "core/parallel.hpp"
#include "road/refinement/between_pixels.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/refinement.hpp"

namespace roadstereo {
namespace {

constexpr int rows_at_once = 32;

/// A row of a map of disparities and of their errors.
struct MatchedRow {
  const float *disparity, *sigma;

  RefinedPixel at(int x) const { return {disparity[x], sigma[x]}; }
};

/// Writes a row of all pixels from one of every second.
void fill_between(const MatchedRow& row, int columns, float half_rise, int width, float* disparity, float* sigma) {
  const auto write = [&](int u, const RefinedPixel& pixel) {
    disparity[u] = pixel.disparity;
    sigma[u] = pixel.error;
  };
  for (int x = 0; x + 1 < columns; ++x) {
    write(2 * x, row.at(x));
    write(2 * x + 1, between_pixels(row.at(x), row.at(x + 1), half_rise));
  }
  const RefinedPixel last = row.at(columns - 1);
  write(2 * columns - 2, last);
  if (2 * columns - 1 < width) write(2 * columns - 1, {last.disparity + half_rise, last.error});
}

/// Writes the row halfway between two. A function of its own, whose numbers no row can alias: it becomes vectors.
void fill_row_between(const MatchedRow& above, const MatchedRow& below, float half_rise, int width, float* disparity,
                      float* sigma) {
  for (int u = 0; u < width; ++u) {
    const RefinedPixel pixel = between_pixels(above.at(u), below.at(u), half_rise);
    disparity[u] = pixel.disparity;
    sigma[u] = pixel.error;
  }
}

}  // namespace

void interpolate_disparities(ImageView<const float> disparity, ImageView<const float> sigma, const DisparityPlane& road,
                             int width, int height, int threads, Image<float>& full, Image<float>& full_sigma) {
  const int columns = (width + 1) / 2, rows = (height + 1) / 2;
  for (const ImageView<const float>& map : {disparity, sigma}) {
    if (width < 1 || height < 1 || map.width() != columns || map.height() != rows) {
      fail("a map of every second pixel has ", map.width(), "×", map.height(), " pixels; for an image of ", width, "×",
           height, " it must have ", columns, "×", rows);
    }
  }
  full.resize(width, height);
  full_sigma.resize(width, height);
  const auto across = static_cast<float>(road.a2), down = static_cast<float>(road.a1);
  parallel_rows(disparity.height(), rows_at_once, threads, [&](int first, int last, int) {
    for (int y = first; y < last; ++y) {
      fill_between({disparity.row(y), sigma.row(y)}, disparity.width(), across, width, full.row(2 * y),
                   full_sigma.row(2 * y));
    }
  });
  parallel_rows(height / 2, rows_at_once, threads, [&](int first, int last, int) {
    for (int y = first; y < last; ++y) {
      const int v = 2 * y + 1;
      const MatchedRow above{full.row(v - 1), full_sigma.row(v - 1)};
      float *const to = full.row(v), *const error = full_sigma.row(v);
      if (v + 1 == height) {
        for (int u = 0; u < width; ++u) to[u] = above.disparity[u] + down;
        std::copy_n(above.sigma, width, error);
        continue;
      }
      fill_row_between(above, {full.row(v + 1), full_sigma.row(v + 1)}, down, width, to, error);
    }
  });
}

}  // namespace roadstereo
