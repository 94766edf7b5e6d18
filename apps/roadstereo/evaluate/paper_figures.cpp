#include "evaluate/paper_figures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "core/degrees.hpp"
#include "evaluate/error_map.hpp"
#include "evaluate/rendered_pair.hpp"
#include "evaluate/roll_maps.hpp"
#include "evaluation/picture_sheet.hpp"
#include "evaluation/tint.hpp"
#include "roadstereo/io/pictures.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {
namespace {

constexpr int cell_width = 480;

Frame process_paper(const synth::SyntheticPair& pair, const MethodSettings& methods, FrameResult& result) {
  Pipeline pipeline(with_settings(preset("paper"), methods), pair.calibration);
  pipeline.process(pair.left.view(), pair.right.view(), result);
  return io::tint_magenta(pair.left.view(), 0, Image<std::uint8_t>(pair.left.width, pair.left.height, 0));
}

io::SheetCell transformed_cell(const FrameResult& result) {
  return {"transformed disparities",
          io::colour_map(result.transformed, io::transformed_scale(result.transformed, result.delta_t))};
}

io::SheetCell disparity_cell(ImageView<const float> map, const std::string& title) {
  return {title, io::colour_map(map, io::percentile_scale(map, "disparity, px"))};
}

std::vector<io::SheetCell> result_row(const std::string& name, const synth::Scene& scene,
                                      const MethodSettings& methods) {
  FrameResult result;
  const Frame left = process_paper(synth::render(scene, methods.threads), methods, result);
  return {{name, left}, disparity_cell(result.disparity, "disparities, preset paper"), transformed_cell(result)};
}

}  // namespace

Frame draw_results(const MethodSettings& methods) {
  std::vector<std::vector<io::SheetCell>> rows;
  for (const char* name : {"uav", "demo", "close"}) {
    rows.push_back(result_row(std::string("rendered road \"") + name + "\"", synth::named_scene(name), methods));
  }
  return io::picture_sheet(rows, cell_width);
}

Frame draw_motion_blur(const MethodSettings& methods) {
  std::vector<std::vector<io::SheetCell>> rows;
  for (const double length_px : {0.0, 7.0, 14.0}) {
    synth::Scene scene = synth::named_scene("uav");
    scene.degradation.motion_blur_px = length_px;
    scene.degradation.motion_blur_angle_deg = 70;
    rows.push_back(result_row(fmt::format("motion blur {} px", length_px), scene, methods));
  }
  return io::picture_sheet(rows, cell_width);
}

Frame draw_roll(const MethodSettings& methods) {
  std::vector<std::vector<io::SheetCell>> rows;
  for (const double roll_deg : {-10.0, 5.0}) {
    const synth::SyntheticPair pair = synth::render(roll_scene({2.6, 60}, roll_deg, false, 0), methods.threads);
    const Image<float> map = exact_map(pair);
    RollOptions options;
    options.solver = RollSolver::gradient_descent;
    const RollEstimate estimate = estimate_roll(map, {}, std::nullopt, 0, options, methods.threads);
    rows.push_back({{fmt::format("roll {:.3f}°", to_degrees(pair.roll_rad)),
                     io::tint_magenta(pair.left.view(), 0, Image<std::uint8_t>(map.width(), map.height(), 0))},
                    disparity_cell(map, "disparities"),
                    disparity_cell(rotate_map(map, -estimate.roll_rad, Resampling::bilinear),
                                   fmt::format("rotated by {:.3f}°", to_degrees(-estimate.roll_rad)))});
  }
  return io::picture_sheet(rows, cell_width);
}

Frame draw_transformed_kitti(const std::vector<KittiFiles>& frames, const MethodSettings& methods) {
  constexpr std::size_t max_rows = 4;
  constexpr int lidar_radius_px = 2;
  std::vector<std::vector<io::SheetCell>> rows;
  for (const KittiFiles& files : frames) {
    if (rows.size() >= max_rows) break;
    LabelledFrame frame = read_kitti_frame(files);
    if (!frame.road) continue;
    const Frame left = io::tint_magenta(frame.pair.left.view(), frame.pair.white_level, *frame.road);
    const io::SheetCell truth = disparity_cell(thicken(frame.truth, lidar_radius_px), "truth");
    for (int v = 0; v < frame.truth.height(); ++v) {
      for (int u = 0; u < frame.truth.width(); ++u) {
        if ((*frame.road)(u, v) == 0) frame.truth(u, v) = std::numeric_limits<float>::quiet_NaN();
      }
    }
    RollOptions options;
    options.solver = RollSolver::gradient_descent;
    FrameResult result;
    const RollEstimate estimate = estimate_roll(frame.truth, {}, std::nullopt, 0, options, methods.threads);
    Image<float> transformed;
    result.delta_t = transform_disparity(frame.truth, estimate, 0, options, methods.threads, transformed);
    result.transformed = thicken(transformed, lidar_radius_px);
    rows.push_back({{files.name, left}, truth, transformed_cell(result)});
  }
  return io::picture_sheet(rows, cell_width);
}

}  // namespace roadstereo::cli
