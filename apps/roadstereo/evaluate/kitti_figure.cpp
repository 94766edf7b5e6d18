#include "evaluate/kitti_figure.hpp"

#include <fmt/core.h>

#include "evaluate/bar_reach.hpp"
#include "evaluate/error_map.hpp"
#include "evaluate/score_columns.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/io/plot.hpp"
#include "roadstereo/io/tint.hpp"

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

std::vector<Frame> kitti_bars(const std::string& region, const std::vector<std::string>& methods,
                              const std::vector<DisparityScore>& means, const std::vector<double>& tolerances_px) {
  io::BarGroups shares{region + ": in error or missing; cut bars carry their value", "e_p+, %", {}, methods, {}};
  io::BarGroups rms{region + ": e_r", "e_r, px", {"e_r"}, methods, {}};
  for (const double tolerance : tolerances_px) {
    shares.groups.push_back(fmt::format("more than {} px", tolerance_text(tolerance)));
  }
  for (const DisparityScore& mean : means) {
    constexpr double percent = 100;
    shares.values.emplace_back();
    for (const double share : mean.bad_or_missing_share) shares.values.back().push_back(percent * share);
    rms.values.push_back({mean.rms_px});
  }
  shares.y_highest = reach_without_bm(shares);
  rms.y_highest = reach_without_bm(rms);
  return {io::draw_bars(shares), io::draw_bars(rms)};
}

}  // namespace roadstereo::cli
