#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/error_map.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/middlebury_scenes.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluation/picture_sheet.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {
namespace {

struct MiddleburyArguments {
  std::string folder;
  MethodSettings methods;
  std::string json, figure;
};

/// Left image, truth, our disparities, our errors.
std::vector<io::SheetCell> sheet_row(const MiddleburyScene& scene, ImageView<const float> ours) {
  const io::ColourScale disparities = io::percentile_scale(scene.truth, "disparity, px");
  const Image<float> errors = absolute_error(ours, scene.truth, scene.visible.view());
  return {{scene.name, scene.pair.left},
          {"truth", io::colour_map(scene.truth, disparities)},
          {"default preset", io::colour_map(ours, disparities)},
          {"error of the default preset", io::colour_map(errors, {0, 3, false, "error, px"})}};
}

/// Score every method over the pixels that both cameras see. The disparities of the default preset go to `ours`.
Table score_scene(const MiddleburyScene& scene, const MethodSettings& settings, Image<float>& ours) {
  static const std::vector<double> tolerances_px{0.5, 1, 2};  // the benchmark's "bad 0.5", "bad 1.0", "bad 2.0"
  Table table{fmt::format("{}, {} disparities, pixels that both cameras see", scene.name, scene.disparities),
              score_columns({{"method", "method"}}, tolerances_px),
              {}};
  for (const std::string& name : method_names()) {
    const Image<float> map = run_method(name, {scene.pair, scene.disparities, false}, settings);
    table.rows.push_back(score_cells({name}, score_disparity(map, scene.truth, scene.visible.view(), tolerances_px)));
    if (name == "default") ours = map;
  }
  return table;
}

void middlebury(const MiddleburyArguments& arguments) {
  nlohmann::ordered_json document;
  std::vector<std::vector<io::SheetCell>> sheet;
  for (const std::string& folder : find_middlebury_scenes(arguments.folder)) {
    const MiddleburyScene scene = read_middlebury_scene(folder);
    Image<float> ours;
    const Table table = score_scene(scene, arguments.methods, ours);
    fmt::print("{}\n", table.text());
    document[scene.name] = table.json();
    if (!arguments.figure.empty()) sheet.push_back(sheet_row(scene, ours));
  }
  fmt::print("{}", score_legend());
  constexpr int cell_width = 480;
  if (!arguments.json.empty()) write_report(arguments.json, document);
  if (!arguments.figure.empty()) write_figure(arguments.figure, io::picture_sheet(sheet, cell_width));
}

constexpr const char* middlebury_footer =
    R"(A scene is a folder with im0.png, im1.png, disp0GT.pfm, mask0nocc.png and calib.txt, as in Middlebury v3. DIR is a scene
or contains scenes. No road is assumed: the perspective transformation is off, and ndisp disparities are searched.

Example:
  roadstereo evaluate middlebury trainingQ --figure middlebury.png)";

}  // namespace

void add_middlebury(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("middlebury", "General scenes of Middlebury v3, without a road");
  command->footer(middlebury_footer);
  const auto arguments = std::make_shared<MiddleburyArguments>();
  command->add_option("DIR", arguments->folder, "Folder of a scene, or of scenes")->required();
  add_method_options(*command, arguments->methods);
  add_json_option(*command, arguments->json);
  add_figure_option(*command, arguments->figure);
  command->callback([arguments] { middlebury(*arguments); });
}

}  // namespace roadstereo::cli
