#include "evaluate/labelled_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate/error_map.hpp"
#include "evaluation/tint.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {

std::vector<io::SheetCell> labelled_sheet_row(const std::string& name, const LabelledFrame& frame,
                                              const std::vector<NamedMap>& ours, const NamedMap& peer) {
  // Rows of a lidar lie about four pixels apart.
  const auto known = std::count_if(frame.truth.row(0), frame.truth.row(0) + frame.truth.pixels(),
                                   [](float truth) { return !std::isnan(truth); });
  const int spread_px = 2 * static_cast<std::size_t>(known) < frame.truth.pixels() ? 2 : 0;
  const io::ColourScale disparities = io::percentile_scale(frame.truth, "disparity, px");
  const io::ColourScale errors{0, 3, false, "error, px"};
  const auto error_cell = [&](const NamedMap& map) -> io::SheetCell {
    return {"error of " + map.method,
            io::colour_map(thicken(absolute_error(map.disparity, frame.truth, std::nullopt), spread_px), errors)};
  };
  const Image<std::uint8_t> nothing(frame.pair.left.width, frame.pair.left.height, 0);
  const ImageView<const std::uint8_t> road = frame.road ? frame.road->view() : nothing.view();
  std::vector<io::SheetCell> row{
      {name + ", road in magenta", io::tint_magenta(frame.pair.left.view(), frame.pair.white_level, road)},
      {"truth", io::colour_map(thicken(frame.truth, spread_px), disparities)}};
  for (const NamedMap& map : ours) {
    row.push_back({"preset " + map.method, io::colour_map(map.disparity, disparities)});
    row.push_back(error_cell(map));
  }
  row.push_back(error_cell(peer));
  return row;
}

}  // namespace roadstereo::cli
