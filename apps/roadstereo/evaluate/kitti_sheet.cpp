#include "evaluate/kitti_sheet.hpp"

#include "evaluate/error_map.hpp"
#include "evaluation/tint.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {

std::vector<io::SheetCell> kitti_sheet_row(const std::string& name, const KittiFrame& frame,
                                           ImageView<const float> ours, ImageView<const float> peer,
                                           const std::string& peer_name) {
  constexpr int lidar_reach_px = 2;  // rows of the lidar lie about four pixels apart
  const io::ColourScale disparities = io::percentile_scale(frame.truth, "disparity, px");
  const io::ColourScale errors{0, 3, false, "error, px"};
  const auto error_picture = [&](ImageView<const float> map) {
    return io::colour_map(thicken(absolute_error(map, frame.truth, std::nullopt), lidar_reach_px), errors);
  };
  const Image<std::uint8_t> nothing(frame.pair.left.width, frame.pair.left.height, 0);
  const ImageView<const std::uint8_t> road = frame.road ? frame.road->view() : nothing.view();
  return {{name + ", road in magenta", io::tint_magenta(frame.pair.left.view(), frame.pair.white_level, road)},
          {"truth", io::colour_map(thicken(frame.truth, lidar_reach_px), disparities)},
          {"default preset", io::colour_map(ours, disparities)},
          {"error of the default preset", error_picture(ours)},
          {"error of " + peer_name, error_picture(peer)}};
}

}  // namespace roadstereo::cli
