#include "evaluate/labelled_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate/error_map.hpp"
#include "evaluation/tint.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {

std::vector<io::SheetCell> labelled_sheet_row(const std::string& name, const LabelledFrame& frame,
                                              ImageView<const float> ours, ImageView<const float> peer,
                                              const std::string& peer_name) {
  // Rows of a lidar lie about four pixels apart.
  const auto known = std::count_if(frame.truth.row(0), frame.truth.row(0) + frame.truth.pixels(),
                                   [](float truth) { return !std::isnan(truth); });
  const int spread_px = 2 * static_cast<std::size_t>(known) < frame.truth.pixels() ? 2 : 0;
  const io::ColourScale disparities = io::percentile_scale(frame.truth, "disparity, px");
  const io::ColourScale errors{0, 3, false, "error, px"};
  const auto error_picture = [&](ImageView<const float> map) {
    return io::colour_map(thicken(absolute_error(map, frame.truth, std::nullopt), spread_px), errors);
  };
  const Image<std::uint8_t> nothing(frame.pair.left.width, frame.pair.left.height, 0);
  const ImageView<const std::uint8_t> road = frame.road ? frame.road->view() : nothing.view();
  return {{name + ", road in magenta", io::tint_magenta(frame.pair.left.view(), frame.pair.white_level, road)},
          {"truth", io::colour_map(thicken(frame.truth, spread_px), disparities)},
          {"default preset", io::colour_map(ours, disparities)},
          {"error of the default preset", error_picture(ours)},
          {"error of " + peer_name, error_picture(peer)}};
}

}  // namespace roadstereo::cli
