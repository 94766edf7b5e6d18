#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <memory>

#include "evaluate/common_pixels.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/labelled_sheet.hpp"
#include "evaluate/lane.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "progress.hpp"

namespace roadstereo::cli {
namespace {

const std::vector<double>& tolerances_px() {
  static const std::vector<double> tolerances{1, 2, 3};  // the paper has 2 and 3
  return tolerances;
}

struct KittiArguments {
  std::string folder, road_masks;
  MethodSettings methods;
  std::string json, figure;
};

/// Scores over one set of pixels, by method and frame.
struct Region {
  std::string title, key;
  std::vector<std::string> methods;
  std::vector<std::string> frames{};
  std::vector<std::vector<DisparityScore>> scores = std::vector<std::vector<DisparityScore>>(methods.size());
};

struct Regions {
  explicit Regions(const std::vector<std::string>& methods)
      : road{"Road regions", "road", methods},
        road_common{"Road regions, pixels with a disparity of every method except BM", "road_common", methods},
        lane{"Lane: road within 1.75 m to either side, nearer than 15 m", "lane", methods},
        lane_without_edges{"Lane without edges along the rows (gradient four times as strong down as across)",
                           "lane_without_edges", methods},
        off_road{"Off the road", "off_road", methods},
        all{"All labelled pixels", "all", methods},
        all_common{"All labelled pixels with a disparity of every method except BM", "all_common", methods} {}

  Region road, road_common, lane, lane_without_edges, off_road, all, all_common;
  std::vector<std::vector<std::string>> without_shift{};  ///< frames that a preset did not transform, by method
};

void add_scores(const std::string& frame, const std::vector<Image<float>>& maps, ImageView<const float> truth,
                const std::optional<ImageView<const std::uint8_t>>& mask, Region& region) {
  region.frames.push_back(frame);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    region.scores[i].push_back(score_disparity(maps[i], truth, mask, tolerances_px()));
  }
}

Image<std::uint8_t> complement(const Image<std::uint8_t>& mask) {
  Image<std::uint8_t> rest(mask.width(), mask.height());
  std::transform(mask.row(0), mask.row(0) + mask.pixels(), rest.row(0),
                 [](std::uint8_t m) { return m == 0 ? 255 : 0; });
  return rest;
}

void add_lane_scores(const std::string& name, const std::vector<Image<float>>& maps, const LabelledFrame& frame,
                     Regions& regions) {
  if (!frame.pair.calibration) return;
  Image<std::uint8_t> lane = lane_mask(frame.truth, *frame.road, *frame.pair.calibration);
  add_scores(name, maps, frame.truth, lane.view(), regions.lane);
  GreyImage grey;
  to_grey(frame.pair.left.view(), frame.pair.white_level, grey);
  exclude(edges_along_rows(grey), lane);
  add_scores(name, maps, frame.truth, lane.view(), regions.lane_without_edges);
}

/// Adds the frame's scores to the regions and, when asked, a row to the sheet.
void score_frame(const KittiFiles& files, const MethodSettings& methods, Regions& regions,
                 std::vector<std::vector<io::SheetCell>>* sheet) {
  const LabelledFrame frame = read_kitti_frame(files);
  const MethodMaps run = run_methods({frame.pair, frame.disparities, true, files.name}, methods);
  const std::vector<Image<float>>& maps = run.maps;
  for (const std::string& method : run.without_shift) regions.without_shift[method_index(method)].push_back(files.name);
  add_scores(files.name, maps, frame.truth, std::nullopt, regions.all);
  add_scores(files.name, maps, frame.truth, common_pixels(maps, std::nullopt).view(), regions.all_common);
  if (frame.road) {
    add_scores(files.name, maps, frame.truth, frame.road->view(), regions.road);
    add_scores(files.name, maps, frame.truth, common_pixels(maps, frame.road->view()).view(), regions.road_common);
    add_lane_scores(files.name, maps, frame, regions);
    add_scores(files.name, maps, frame.truth, complement(*frame.road).view(), regions.off_road);
  }
  if (sheet != nullptr) {
    sheet->push_back(labelled_sheet_row(
        files.name, frame, {{"paper", maps[method_index("paper")]}, {"default", maps[method_index("default")]}},
        {"SGBM", maps[method_index("SGBM")]}));
  }
}

/// Row of published values, e_p in percent.
std::vector<Cell> published(const std::string& name, double rms_px, double above_2, double above_3) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  DisparityScore score;
  score.rms_px = rms_px;
  score.mean_px = score.sd_px = score.median_px = score.density = nan;
  score.bad_share = {nan, above_2 / 100, above_3 / 100};
  score.bad_or_missing_share = {nan, nan, nan};
  return score_cells({name + " (published)"}, score);
}

/// Table 1 of the paper: e_r, and e_p at 2 and 3 px.
Table published_table(const std::vector<Column>& columns) {
  return {"", columns, {published("PSMNet", 1.039, 1.345, 0.016), published("paper", 0.409, 0.217, 0.023)}};
}

/// `score(i)`: that of method i.
template <class Score>
Table method_table(const std::string& title, const Region& region, const Score& score) {
  Table table{title, score_columns({{"method", "method"}}, tolerances_px()), {}};
  for (std::size_t i = 0; i < region.methods.size(); ++i) {
    table.rows.push_back(score_cells({region.methods[i]}, score(i)));
  }
  return table;
}

Table mean_table(const Region& region) {
  return method_table(fmt::format("{}, mean over {} frames", region.title, region.frames.size()), region,
                      [&](std::size_t i) { return mean_score(region.scores[i]); });
}

/// e_r and e_p+(2) of every method by frame.
Table frame_table(const Region& region) {
  Table table{region.title + ", by frame: e_r px / e_p+(2) %", {{"frame", "frame"}}, {}};
  for (const std::string& name : region.methods) table.columns.push_back({name, name});
  for (std::size_t frame = 0; frame < region.frames.size(); ++frame) {
    table.rows.push_back({Cell(region.frames[frame])});
    for (const auto& of_method : region.scores) {
      const DisparityScore& score = of_method[frame];
      table.rows.back().push_back(
          Cell(Cell(score.rms_px, 2).text() + " / " + Cell(100 * score.bad_or_missing_share[1], 2).text()));
    }
  }
  return table;
}

nlohmann::ordered_json region_json(const Region& region) {
  nlohmann::ordered_json document;
  document["mean"] = mean_table(region).json();
  for (std::size_t frame = 0; frame < region.frames.size(); ++frame) {
    document["frames"][region.frames[frame]] =
        method_table("", region, [&](std::size_t i) { return region.scores[i][frame]; }).json();
  }
  return document;
}

/// The presets that left a frame as it is, one sentence each.
std::string untransformed_text(const std::vector<std::vector<std::string>>& without_shift) {
  std::string text;
  for (std::size_t i = 0; i < without_shift.size(); ++i) {
    if (without_shift[i].empty()) continue;
    text += fmt::format("  Not transformed by {}, which found no road: {}\n", method_names()[i],
                        fmt::join(without_shift[i], ", "));
  }
  return text;
}

void kitti(const KittiArguments& arguments) {
  const std::vector<KittiFiles> frames = find_kitti_frames(arguments.folder, arguments.road_masks);
  Regions regions(method_names(arguments.methods));
  regions.without_shift.resize(method_names().size());
  std::vector<std::vector<io::SheetCell>> sheet;
  constexpr std::size_t max_sheet_rows = 4;
  Progress progress = Progress::on_terminal(frames.size());
  for (const KittiFiles& files : frames) {
    const bool shown = !arguments.figure.empty() && sheet.size() < max_sheet_rows;
    score_frame(files, arguments.methods, regions, shown ? &sheet : nullptr);
    progress.frame_done();
  }
  progress.end();
  nlohmann::ordered_json document;
  const Table paper = published_table(mean_table(regions.road).columns);
  for (const Region* region : {&regions.road, &regions.road_common, &regions.lane, &regions.lane_without_edges,
                               &regions.off_road, &regions.all, &regions.all_common}) {
    if (region->frames.empty()) continue;
    Table table = mean_table(*region);
    document[region->key] = region_json(*region);
    if (region == &regions.road || region == &regions.lane || region == &regions.lane_without_edges) {
      table.rows.insert(table.rows.end(), paper.rows.begin(), paper.rows.end());
    }
    fmt::print("{}\n", table.text());
    if (region == &regions.road || region == &regions.all) fmt::print("{}\n", frame_table(*region).text());
  }
  document["published"] = paper.json();
  for (const std::string& method : method_names()) {
    const std::vector<std::string>& frames_without = regions.without_shift[method_index(method)];
    if (!frames_without.empty()) document["not_transformed"][method] = frames_without;
  }
  fmt::print("{}{}  published: Table 1 of the paper, on KITTI frames and road regions selected by hand\n",
             score_legend(), untransformed_text(regions.without_shift));
  constexpr int cell_width = 620;
  if (!arguments.json.empty()) write_report(arguments.json, document);
  if (!arguments.figure.empty()) write_figure(arguments.figure, io::picture_sheet(sheet, cell_width));
}

constexpr const char* kitti_footer =
    R"(DIR has the layout of KITTI Stereo 2015 (image_2, image_3, disp_noc_0, and optionally calib_cam_to_cam) or 2012
(colored_0, colored_1, or image_0, image_1; disp_noc, calib). OpenCV's matchers get the same rectified pairs and search
128 disparities, or more if the ground truth needs them.

Road regions are masks, or polygons drawn by hand, in JSON: {"000003_10": [[[412, 371], [588, 214], [655, 214], [815,
371]]]}, a list of polygons with corners [column, row] for every frame.

Examples:
  roadstereo evaluate kitti kitti2015 --figure kitti.png --json kitti.json
  roadstereo evaluate kitti kitti2015 --maps PSMNet=psmnet --road-masks regions.json)";

}  // namespace

void add_kitti(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("kitti", "Road disparities on KITTI Stereo 2012 and 2015: Table 1 of the paper");
  command->footer(kitti_footer);
  const auto arguments = std::make_shared<KittiArguments>();
  command->add_option("DIR", arguments->folder, "Folder of the frames")->required();
  command
      ->add_option("--road-masks", arguments->road_masks,
                   "Folder of road masks, or polygons in JSON; default: DIR/road if present")
      ->type_name("DIR|FILE");
  add_method_options(*command, arguments->methods);
  add_maps_option(*command, arguments->methods.maps);
  add_json_option(*command, arguments->json);
  add_figure_option(*command, arguments->figure);
  command->callback([arguments] { kitti(*arguments); });
}

}  // namespace roadstereo::cli
