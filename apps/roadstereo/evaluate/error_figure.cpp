#include "evaluate/error_figure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "evaluate/error_map.hpp"
#include "roadstereo/io/picture_sheet.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {
namespace {

/// Share of the compared pixels in each of many equal parts of ± `reach_px`; the outermost take what lies beyond.
io::Panel error_histogram(ImageView<const float> map, ImageView<const float> truth, ImageView<const float> compared,
                          double reach_px) {
  constexpr std::size_t bins = 81;
  const double width_px = 2 * reach_px / bins;
  std::vector<double> counts(bins, 0), middles;
  double pixels = 0;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (!std::isfinite(compared(u, v))) continue;
      const double place = (map(u, v) - truth(u, v) + reach_px) / width_px;
      counts[static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0))] += 1;
      pixels += 1;
    }
  }
  for (std::size_t i = 0; i < bins; ++i) {
    constexpr double percent = 100;
    middles.push_back((static_cast<double>(i) + 0.5) * width_px - reach_px);
    counts[i] *= percent / std::max(pixels, 1.0);
  }
  io::Panel panel{
      "Signed error (the ends hold what lies beyond)", "map - truth, px", "pixels, %", {}, false, false, 0.0, {}};
  panel.curves.push_back({"", middles, counts});
  panel.vertical_lines = {0};
  return panel;
}

}  // namespace

Frame error_figure(ImageView<const float> map, ImageView<const float> truth,
                   const std::optional<ImageView<const std::uint8_t>>& mask, double reach_px) {
  const Image<float> errors = absolute_error(map, truth, mask);
  const io::ColourScale scale{0, reach_px, false, "absolute error, px"};
  return io::collage(
      {{io::colour_map(errors, scale)}, {io::draw_plot({error_histogram(map, truth, errors, reach_px)})}});
}

}  // namespace roadstereo::cli
