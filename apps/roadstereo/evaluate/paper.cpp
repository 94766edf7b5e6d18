#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/paper_figures.hpp"
#include "evaluate/paper_page.hpp"
#include "evaluate/report.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct PaperArguments {
  std::string kitti, road_masks, output;
  bool quick = false;
  MethodSettings methods;

  std::string file(const std::string& name) const { return (fs::path(output) / name).string(); }

  /// An experiment on the frames of KITTI.
  std::vector<std::string> on_kitti(const std::string& experiment) const {
    std::vector<std::string> words{experiment, kitti};
    if (!road_masks.empty()) words.insert(words.end(), {"--road-masks", road_masks});
    return words;
  }
};

/// Runs an experiment with --json NAME.json in the folder of the page, and returns what it has written.
Json run_experiment(void (*add)(CLI::App&), std::vector<std::string> words, const PaperArguments& arguments) {
  const std::string file = arguments.file(words.front() + ".json");
  fmt::print("roadstereo evaluate {}\n", fmt::join(words, " "));
  words.insert(words.end(), {"--json", file, "--threads", std::to_string(arguments.methods.threads)});
  CLI::App app;
  add(app);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  app.parse(words);
  return Json::parse(std::ifstream(file));
}

std::string command_of(const std::vector<std::string>& words) {
  return fmt::format("roadstereo evaluate {}", fmt::join(words, " "));
}

/// NaN if it is null.
double value_of(const Json& row, const std::string& key) {
  return row.at(key).is_number() ? row.at(key).get<double>() : nan;
}

/// A value of the first row in which `column` has that text; NaN if there is none.
double value_where(const Json& rows, const char* column, const std::string& text, const std::string& key) {
  for (const Json& row : rows) {
    if (row.at(column) == text) return value_of(row, key);
  }
  return nan;
}

PaperPart table_1(const Json& kitti, const std::vector<std::string>& words) {
  PaperPart part{"Table 1: disparity accuracy on KITTI", command_of(words), {}, "kitti.png", ""};
  part.table.columns = {{"", "quantity"},
                        {"PSMNet, published", "psmnet_published"},
                        {"published", "published"},
                        {"paper, road mask", "paper_road"},
                        {"paper, lane", "paper_lane"},
                        {"paper, lane without edges along the rows", "paper_lane_without_edges"},
                        {"default, road mask", "default_road"},
                        {"default, lane", "default_lane"}};
  const auto mean = [&](const char* region, const char* method, const std::string& key) {
    return kitti.contains(region) ? value_where(kitti.at(region).at("mean"), "method", method, key) : nan;
  };
  const std::vector<std::pair<const char*, std::string>> quantities{{"e_r, px", "e_r_px"},
                                                                    {"e_p(2), %", "e_p_2px_percent"},
                                                                    {"e_p(3), %", "e_p_3px_percent"},
                                                                    {"density, %", "density_percent"}};
  for (const auto& [name, key] : quantities) {
    part.table.rows.push_back({Cell(name),
                               Cell(value_where(kitti.at("published"), "method", "PSMNet (published)", key), 3),
                               Cell(value_where(kitti.at("published"), "method", "paper (published)", key), 3),
                               Cell(mean("road", "paper", key), 3), Cell(mean("lane", "paper", key), 3),
                               Cell(mean("lane_without_edges", "paper", key), 3), Cell(mean("road", "default", key), 3),
                               Cell(mean("lane", "default", key), 3)});
  }
  part.why =
      "The frames and the regions drawn by hand are unknown. Edges along the rows (stop lines, borders of shadows) "
      "hold most of the large errors of paper: NCC is flat along them, and rows of these pairs disagree by 0.15 to "
      "0.29 px. paper shifts whole pixels, which costs 0.08 px. PSMNet was not run here. The figure: left image, road "
      "in "
      "magenta, truth, disparities and errors of paper and default.";
  if (kitti.contains("not_transformed") && kitti.at("not_transformed").contains("paper")) {
    const auto frames = kitti.at("not_transformed").at("paper").get<std::vector<std::string>>();
    part.why += fmt::format(" Not transformed by paper, whose model has no roll: {}.", fmt::join(frames, ", "));
  }
  return part;
}

PaperPart runtime_part(const Json& runtime, const std::vector<std::string>& words) {
  PaperPart part{"Runtime and Mde/s (section 4.4)", command_of(words), {}, "", ""};
  part.table.columns = {{"", "quantity"},
                        {"published, Jetson TX2", "published"},
                        {"paper", "paper"},
                        {"default", "default"},
                        {"fast", "fast"}};
  const std::vector<std::pair<const char*, std::string>> quantities{{"frame, ms", "total_ms"},
                                                                    {"Mde/s", "mde_per_s"},
                                                                    {"roll angle, ms", "roll_ms"},
                                                                    {"transformation, ms", "transform_ms"}};
  for (const auto& [name, key] : quantities) {
    std::vector<Cell> row{Cell(name)};
    for (const char* method : {"published: Jetson TX2, 695×361", "paper", "default", "fast"}) {
      row.emplace_back(value_where(runtime.at("rows"), "method", method, key), 3);
    }
    part.table.rows.push_back(row);
  }
  part.why = fmt::format(
      "Another machine: {}, {} threads. paper searches only near the disparities of a coarse search "
      "(narrow_search); Mde/s counts D disparities for every pixel all the same, as published.",
      runtime.at("cpu").get<std::string>(), runtime.at("threads").get<int>());
  return part;
}

PaperPart lambda_part(const Json& lambda, const std::vector<std::string>& words) {
  PaperPart part{"Learning rate of the descent, λ(0)", command_of(words), {}, "", ""};
  part.table.columns = {{"", "quantity"}, {"published", "published"}, {"ours", "ours"}};
  part.table.rows = {{Cell("optimum of λ(0)"), Cell(lambda.at("published_optimum").get<double>(), 0),
                      Cell(lambda.at("optimum").get<double>(), 0)}};
  part.why =
      "The energy is normalised so that λ = 10 is a Newton step for a road without roll: on the plain sum of squares "
      "of "
      "the paper λ(0) = 10 does not converge (docs/method.md, errata).";
  return part;
}

PaperPart roll_part(const Json& roll, const std::vector<std::string>& words) {
  PaperPart part{"Roll angle, and the figure of rotated disparities", command_of(words), {}, "roll.png", ""};
  part.table.columns = {{"maps", "maps"},
                        {"solver", "solver"},
                        {"published mean, rad", "published"},
                        {"our mean, rad", "mean_rad"},
                        {"our maximum, rad", "max_rad"}};
  for (const Json& row : roll.at("rows")) {
    const std::string maps = row.at("maps").get<std::string>();
    if (row.at("solver") != "gradient_descent" && maps.find("match") == std::string::npos) continue;
    const double mean = value_of(row, "mean_rad"), published = maps.starts_with("published") ? mean : nan;
    part.table.rows.push_back({Cell(maps), Cell(row.at("solver").get<std::string>()), Cell(published, 3),
                               Cell(std::isnan(published) ? mean : nan, 5), Cell(value_of(row, "max_rad"), 5)});
  }
  part.why =
      "EISATS was not at hand: maps of rendered roads are rotated instead, and pairs of rendered roads matched. The "
      "descent finds the least-squares plane, which damage and camber bias; robust is the solver of default.";
  return part;
}

PaperPart flatness_part(const Json& flatness, const std::vector<std::string>& words) {
  PaperPart part{
      "σ_d of the transformed KITTI truth, and its figure", command_of(words), {}, "transformed_kitti.png", ""};
  part.table.columns = {{"σ_d, px", "disparities"},
                        {"published, ψ = 0", "published_without_roll"},
                        {"published, ψ estimated", "published_with_roll"},
                        {"ours, ψ = 0", "without_roll_px"},
                        {"ours, gradient descent", "gradient_descent_px"},
                        {"ours, robust", "robust_px"}};
  const auto published_px = [&](const Json& row, const char* key) {
    return Cell(
        row.at("disparities") == "truth" ? value_where(flatness.at("rows"), "frame", "published: KITTI", key) : nan, 3);
  };
  for (const Json& row : flatness.at("rows")) {
    if (row.at("frame") != "mean") continue;
    part.table.rows.push_back({Cell(row.at("disparities").get<std::string>()), published_px(row, "without_roll_px"),
                               published_px(row, "gradient_descent_px"), Cell(value_of(row, "without_roll_px"), 3),
                               Cell(value_of(row, "gradient_descent_px"), 3), Cell(value_of(row, "robust_px"), 3)});
  }
  part.why = "Other frames and regions: masks made from the truth instead of regions drawn by hand.";
  return part;
}

PaperPart blur_part(const Json& blur, const std::vector<std::string>& words) {
  PaperPart part{"Figure of motion blurred images", command_of(words), {}, "motion_blur.png", ""};
  part.table.columns = {{"method", "method"},
                        {"blur, px", "length_px"},
                        {"e_r, px", "rms_px"},
                        {"e_p+(1), %", "e_p_or_missing_1px_percent"}};
  for (const Json& row : blur.at("rows")) {
    part.table.rows.push_back({Cell(row.at("method").get<std::string>()), Cell(row.at("length_px").get<double>(), 1),
                               Cell(row.at("rms_px").get<double>(), 3),
                               Cell(row.at("e_p_or_missing_1px_percent").get<double>(), 1)});
  }
  part.why =
      "The paper shows pictures and no values. Roads are rendered, so that the error under blur can be measured.";
  return part;
}

PaperPage make_page(const PaperArguments& arguments) {
  PaperPage page{
      "The paper and this program",
      "Every table and figure of Fan et al., \"Real-Time Dense Stereo Embedded in A UAV for Road Inspection\" "
      "(2019): the published value, ours, the command that prints it, and why they differ. paper is the preset "
      "with every constant of the paper. –: no value.",
      {}};
  std::vector<KittiFiles> frames;
  if (!arguments.kitti.empty()) frames = find_kitti_frames(arguments.kitti, arguments.road_masks);
  const bool with_flatness =
      !frames.empty() && std::all_of(frames.begin(), frames.end(), std::mem_fn(&KittiFiles::has_road));
  std::vector<std::string> words;
  const auto run = [&](void (*add)(CLI::App&)) { return run_experiment(add, words, arguments); };
  page.parts.push_back(
      {"Figures of the workflow and of the set-up",
       "",
       {},
       "",
       "Drawings: the workflow is that of docs/architecture.md; the camera and drone were not at hand."});
  write_figure(arguments.file("results.png"), draw_results(arguments.methods));
  page.parts.push_back(
      {"Figures of results: disparities and transformed disparities",
       "roadstereo evaluate paper",
       {},
       "results.png",
       "The 11368 pairs and the data sets of damage of the paper were not at hand: roads are rendered. The lines along "
       "the rows are those of whole-pixel shifts."});
  if (arguments.kitti.empty()) {
    page.parts.push_back({"Table 1, σ_d and figures of KITTI", "", {}, "", "Left out: no folder of KITTI was given."});
  } else {
    words = arguments.on_kitti("kitti");
    words.insert(words.end(), {"--figure", arguments.file("kitti.png")});
    page.parts.push_back(table_1(run(add_kitti), arguments.on_kitti("kitti")));
  }
  words = {"blur"};
  if (arguments.quick) words.insert(words.end(), {"--steps", "2", "--directions", "0"});
  page.parts.push_back(blur_part(run(add_blur), words));
  write_figure(arguments.file("motion_blur.png"), draw_motion_blur(arguments.methods));
  words = {"runtime"};
  if (arguments.quick) words.insert(words.end(), {"--runs", "3"});
  page.parts.push_back(runtime_part(run(add_runtime), words));
  words = {"lambda"};
  if (arguments.quick) words.insert(words.end(), {"--count", "7"});
  page.parts.push_back(lambda_part(run(add_lambda), words));
  words = {"roll"};
  if (arguments.quick) words.insert(words.end(), {"--angles", "2"});
  page.parts.push_back(roll_part(run(add_roll), words));
  write_figure(arguments.file("roll.png"), draw_roll(arguments.methods));
  if (with_flatness) {
    words = arguments.on_kitti("flatness");
    page.parts.push_back(flatness_part(run(add_flatness), words));
    write_figure(arguments.file("transformed_kitti.png"), draw_transformed_kitti(frames, arguments.methods));
  } else if (!arguments.kitti.empty()) {
    page.parts.push_back({"σ_d of the transformed KITTI truth", "", {}, "", "Left out: a frame has no road mask."});
  }
  return page;
}

void paper(const PaperArguments& arguments) {
  fs::create_directories(arguments.output);
  const PaperPage page = make_page(arguments);
  write_text(arguments.file("paper.md"), markdown(page));
  write_text(arguments.file("paper.html"), html(page));
  write_report(arguments.file("paper.json"), json(page));
  fmt::print("{}\n", arguments.file("paper.html"));
}

constexpr const char* paper_footer =
    R"(Runs the experiments of the paper, some minutes, and writes paper.html, paper.md and paper.json, the figures and the JSON
of every experiment into the output folder. σ_d needs the road of every frame.

Example:
  roadstereo evaluate paper kitti2015 --output paper)";

}  // namespace

void add_paper(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("paper", "One page: every table and figure of the paper, published and ours");
  command->footer(paper_footer);
  const auto arguments = std::make_shared<PaperArguments>();
  command->add_option("DIR", arguments->kitti, "Folder of KITTI Stereo 2015 or 2012; absent: without what needs it");
  command->add_option("--output", arguments->output, "Folder of the page")->type_name("DIR")->required();
  command->add_flag("--quick", arguments->quick, "Fewer angles, lengths and runs");
  command
      ->add_option("--road-masks", arguments->road_masks,
                   "Folder of road masks, or polygons in JSON; default: DIR/road if present")
      ->type_name("DIR|FILE")
      ->needs("DIR");
  command->add_option("--threads", arguments->methods.threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command->callback([arguments] { paper(*arguments); });
}

}  // namespace roadstereo::cli
