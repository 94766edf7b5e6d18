#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "evaluate/error_map.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "mask_file.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {
namespace {

struct ScoreArguments {
  std::string map, truth, mask;
  std::vector<double> tolerances_px{1, 2, 3};
  std::string json, figure;
};

void score(const ScoreArguments& arguments) {
  const Image<float> map = io::read_disparity(arguments.map);
  const Image<float> truth = io::read_disparity(arguments.truth);
  Image<std::uint8_t> mask;
  std::optional<ImageView<const std::uint8_t>> inside;
  if (!arguments.mask.empty()) {
    mask = read_mask(arguments.mask);
    inside = mask.view();
  }
  const DisparityScore result = score_disparity(map, truth, inside, arguments.tolerances_px);
  if (result.labelled_pixels == 0) {
    fail(arguments.truth, " has no labelled pixel", inside ? " inside the mask" : "", "; it must have at least one");
  }
  const Table table{fmt::format("{} against {}: {} of {} labelled pixels have a disparity", arguments.map,
                                arguments.truth, result.valid_pixels, result.labelled_pixels),
                    score_columns({}, arguments.tolerances_px),
                    {score_cells({}, result)}};
  if (!arguments.json.empty()) write_report(arguments.json, table.json().front());
  if (!arguments.figure.empty()) {
    const double highest = *std::max_element(arguments.tolerances_px.begin(), arguments.tolerances_px.end());
    write_figure(arguments.figure,
                 io::colour_map(absolute_error(map, truth, inside), {0, highest, false, "absolute error, px"}));
  }
  fmt::print("{}{}", table.text(), score_legend());
}

constexpr const char* score_footer =
    R"(Maps and ground truth: float TIFF or PFM (NaN, in PFM also infinity, is missing), or 16-bit PNG (value / 256 px, 0 is
missing).

Example:
  roadstereo evaluate score out/disparity.tiff disp_noc_0/000003_10.png --mask road/000003_10.png --figure error.png)";

}  // namespace

void add_score(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("score", "Disparity map against ground truth");
  command->footer(score_footer);
  const auto arguments = std::make_shared<ScoreArguments>();
  command->add_option("MAP", arguments->map, "Disparity map")->required();
  command->add_option("TRUTH", arguments->truth, "Ground truth of the same size")->required();
  command->add_option("--mask", arguments->mask, "Image; only pixels that are not 0 count")->type_name("FILE");
  command->add_option("--tolerances", arguments->tolerances_px, "Tolerances of e_p, pixels")
      ->type_name("PX,PX…")
      ->delimiter(',')
      ->capture_default_str();
  add_json_option(*command, arguments->json);
  add_figure_option(*command, arguments->figure);
  command->callback([arguments] { score(*arguments); });
}

}  // namespace roadstereo::cli
