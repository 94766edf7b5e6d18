#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>

#include "core/max_disparities.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/scan_frames.hpp"
#include "evaluate/scan_score.hpp"
#include "evaluate/scan_sheet.hpp"
#include "evaluate/table.hpp"
#include "evaluation/picture_sheet.hpp"
#include "mask_file.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

struct ScanArguments {
  std::vector<std::string> inputs;  ///< DIR; CLOUD and SCAN; LEFT and RIGHT
  std::vector<std::string> calibration;
  std::string label, scan;
  std::size_t labelled = 0;
  double cloud_unit_mm = 1000, scan_unit_mm = 1;
  std::vector<std::string> compared{"default", "SGBM"};
  int disparities = 352;
  bool robust = false;
  LastStep last_step() const { return robust ? LastStep::robust : LastStep::least_squares; }
  MethodSettings methods;
  std::string json, figure;
};

/// Row of the table: score of one method on one pothole.
struct Row {
  std::string frame, method;
  ScanScore score;
  Registration registration;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> columns{{"pair", "pair"},
                                           {"method", "method"},
                                           {"labelled", "labelled_pixels"},
                                           {"complete %", "completeness_percent"},
                                           {"RMS mm", "rms_mm"},
                                           {"median", "median_mm"},
                                           {"90 %", "p90_mm"},
                                           {"99 %", "p99_mm"},
                                           {"covered %", "covered_percent"},
                                           {"RMS", "rms_covered_mm"},
                                           {"RMS+10", "rms_missing_10mm"},
                                           {"pose", "pose_rms_mm"},
                                           {"next pose", "next_pose_rms_mm"}};
  return columns;
}

std::vector<Cell> cells(const Row& row) {
  constexpr double percent = 100;
  const ScanScore& score = row.score;
  return {Cell(row.frame),
          Cell(row.method),
          Cell(static_cast<double>(score.labelled), 0),
          Cell(percent * score.completeness(), 2),
          Cell(score.rms_mm, 3),
          Cell(score.median_mm, 3),
          Cell(score.p90_mm, 3),
          Cell(score.p99_mm, 3),
          Cell(percent * static_cast<double>(score.covered) / static_cast<double>(score.measured), 1),
          Cell(score.rms_covered_mm, 3),
          Cell(score.rms_or_missing_mm, 3),
          Cell(row.registration.rms, 3),
          Cell(row.registration.next_rms, 3)};
}

/// Row of the means of a method over all pairs.
std::vector<Cell> mean_cells(const std::vector<Row>& rows, const std::string& method) {
  constexpr std::size_t first_number = 2;
  std::vector<double> sums(columns().size(), 0);
  double count = 0;
  for (const Row& row : rows) {
    if (row.method != method) continue;
    const std::vector<Cell> row_cells = cells(row);
    for (std::size_t i = first_number; i < row_cells.size(); ++i) {
      const auto value = row_cells[i].json();
      sums[i] += value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
    }
    count += 1;
  }
  std::vector<Cell> result{Cell("mean"), Cell(method)};
  for (std::size_t i = first_number; i < sums.size(); ++i) {
    result.emplace_back(sums[i] / count, i == first_number ? 0 : 3);
  }
  return result;
}

constexpr const char* legend =
    R"(  RMS, median, 90 %, 99 %: distance from the point of each labelled pixel to the closest point of the scan, mm, no point
  excluded
  covered: points over the scan, not beyond its rim (labels extend farther than casts) or over its holes, and their RMS
  RMS+10: a labelled pixel without a disparity counts as 10 mm
  pose: RMS of the registration over its sample of points (with --robust of the closest 80 %); next pose: the same for
  the best distinct pose
)";

void print(const std::vector<Row>& rows, const ScanArguments& arguments) {
  Table table{"Closest distance to the laser scan", columns(), {}};
  for (const Row& row : rows) table.rows.push_back(cells(row));
  const std::size_t methods = arguments.inputs.size() == 1 ? arguments.compared.size() : 0;
  for (std::size_t i = 0; i < methods; ++i) table.rows.push_back(mean_cells(rows, arguments.compared[i]));
  fmt::print("{}\n{}", table.text(), legend);
  if (!arguments.json.empty()) write_report(arguments.json, table.json());
}

/// Throws Error if the sizes of cloud and scan differ by more than a factor of 4, for example because of wrong units.
void check_extents(const std::string& file, const Points& cloud, const PrincipalAxes& scan) {
  constexpr double max_ratio = 4;
  const double ratio = principal_axes(cloud).sigma[0] / scan.sigma[0];
  if (cloud.empty() || (ratio > 1 / max_ratio && ratio < max_ratio)) return;
  fail(file, ": the cloud is ", ratio,
       " times as large as the scan; the factor must be between 1/4 and 4 "
       "(units: --cloud-unit-mm, --scan-unit-mm)");
}

void scan_cloud(const ScanArguments& arguments) {
  const Points cloud = read_points(arguments.inputs[0], arguments.cloud_unit_mm);
  const ScanModel scan(read_points(arguments.inputs[1], arguments.scan_unit_mm));
  check_extents(arguments.inputs[0], cloud, scan.axes);
  const Registration registration = register_cloud(cloud, scan, arguments.last_step());
  const std::vector<ScanDistance> distances = closest_distances(cloud, scan, registration.motion);
  const std::size_t labelled = arguments.labelled == 0 ? cloud.size() : arguments.labelled;
  print({{"cloud", "cloud", score_distances(distances, labelled), registration}}, arguments);
  if (arguments.figure.empty()) return;
  write_figure(arguments.figure, distance_plan(cloud, scan, registration.motion));
}

/// Run the methods on one pair. Adds their rows and, if `pictures` is not null, their distance maps.
void scan_pair(const ScanFiles& files, const ScanArguments& arguments, std::vector<Row>& rows,
               std::vector<io::SheetCell>* pictures) {
  const StereoPair pair = read_pair(files.pair);
  const Image<std::uint8_t> label = read_mask(files.label);
  const ScanModel scan(read_points(files.scan, arguments.scan_unit_mm));
  if (pictures != nullptr) pictures->push_back(pothole_picture(files.name, pair, label));
  for (const std::string& method : arguments.compared) {
    try {
      const Image<float> map = run_method(method, {pair, arguments.disparities, true, files.name}, arguments.methods);
      const LabelledPoints found = labelled_points(map, label, *pair.calibration);
      const Registration registration = register_cloud(found.points, scan, arguments.last_step());
      const std::vector<ScanDistance> distances = closest_distances(found.points, scan, registration.motion);
      rows.push_back({files.name, method, score_distances(distances, found.labelled), registration});
      if (pictures != nullptr)
        pictures->push_back(distance_picture(method, rows.back().score, found, distances, label));
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      fail(files.name, ", ", method, ": ", error.what());
    }
  }
}

void scan_pairs(const std::vector<ScanFiles>& frames, ScanArguments arguments) {
  for (const std::string& method : arguments.compared) {
    if (method_index(method) == method_names().size()) {
      fail("--methods contains \"", method, "\"; it must be one of ",
           fmt::format("{}", fmt::join(method_names(), ", ")));
    }
  }
  for (const GivenMaps& maps : arguments.methods.maps) arguments.compared.push_back(maps.name);
  std::vector<Row> rows;
  std::vector<std::vector<io::SheetCell>> sheet;
  const bool drawn = !arguments.figure.empty();
  Progress progress = Progress::on_terminal(frames.size(), frames.size() == 1);
  for (const ScanFiles& files : frames) {
    if (drawn) sheet.emplace_back();
    scan_pair(files, arguments, rows, drawn ? &sheet.back() : nullptr);
    progress.frame_done();
  }
  progress.end();
  print(rows, arguments);
  constexpr int cell_width = 480;
  if (drawn) write_figure(arguments.figure, io::picture_sheet(sheet, cell_width));
}

/// Throws Error if one of the options is given, which are not of these inputs.
void refuse(const CLI::App& command, const std::vector<const char*>& options, const char* inputs) {
  for (const char* option : options) {
    if (command.count(option) > 0) fail(option, " is not of ", inputs, "; it must not be given with it");
  }
}

void scan(const CLI::App& command, const ScanArguments& arguments) {
  const bool is_pair = !arguments.label.empty() || !arguments.scan.empty() || !arguments.calibration.empty();
  if (arguments.inputs.size() == 1 || is_pair) {
    refuse(command, {"--labelled", "--cloud-unit-mm"}, arguments.inputs.size() == 1 ? "DIR" : "LEFT RIGHT");
  }
  if (arguments.inputs.size() == 1) {
    if (is_pair)
      fail("--calibration, --label and --scan are given with one input; they must be given with a pair LEFT RIGHT");
    scan_pairs(find_scan_frames(arguments.inputs[0]), arguments);
  } else if (is_pair) {
    if (arguments.label.empty() || arguments.scan.empty() || arguments.calibration.empty()) {
      fail("a pair LEFT RIGHT must be given with --calibration, --label and --scan");
    }
    scan_pairs(
        {{"pair", {arguments.inputs[0], arguments.inputs[1], arguments.calibration}, arguments.label, arguments.scan}},
        arguments);
  } else {
    refuse(command, {"--methods", "--maps", "--disparities", "--set", "--threads"}, "CLOUD SCAN");
    scan_cloud(arguments);
  }
}

constexpr const char* scan_footer =
    R"(One of
  DIR          left/pM_NN.png, right/, label/ (mask of the pothole), scan/pM_*.ply, calibration_pM*.yaml
  LEFT RIGHT   one pair, with --calibration, --label and --scan; its map in DIR of --maps is pair.png
  CLOUD SCAN   the points of a pothole (PLY, metres) and its scan (PLY, millimetres)
The cloud is registered to the scan by a rigid motion without reflection: robust iterative closest points (ICP) from many
initial poses, then least squares, as for published accuracies (not with --robust).

Examples:
  roadstereo evaluate scan potholes --figure scan.png
  roadstereo evaluate scan potholes --maps mine=my_maps    # my_maps/p1_01.png, 16 bit
  roadstereo evaluate scan cloud.ply scan.ply --labelled 25000)";

void add_inputs(CLI::App& command, ScanArguments& arguments) {
  command.add_option("INPUT", arguments.inputs, "DIR, or CLOUD SCAN, or LEFT RIGHT")->required()->expected(1, 2);
  command.add_option("--calibration", arguments.calibration, "Calibration of the pair")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false);
  command.add_option("--label", arguments.label, "Mask of the pothole in the left image")->type_name("FILE");
  command.add_option("--scan", arguments.scan, "Laser scan of the pothole")->type_name("FILE");
  command
      .add_option("--labelled", arguments.labelled, "Number of labelled pixels behind CLOUD; 0: number of its points")
      ->type_name("N");
  command.add_option("--cloud-unit-mm", arguments.cloud_unit_mm, "Unit of CLOUD, millimetres")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command.add_option("--scan-unit-mm", arguments.scan_unit_mm, "Unit of the scan, millimetres")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_scan(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("scan", "Potholes against laser scans of their casts");
  command->footer(scan_footer);
  const auto arguments = std::make_shared<ScanArguments>();
  add_inputs(*command, *arguments);
  command->add_option("--methods", arguments->compared, "Presets and OpenCV's matchers, separated by commas")
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all()
      ->capture_default_str();
  command->add_option("--disparities", arguments->disparities, "Number of disparities for OpenCV's matchers")
      ->check(CLI::Range(16, max_disparities))
      ->capture_default_str();
  command->add_flag("--robust", arguments->robust, "Omit the final least-squares step of the registration");
  add_method_options(*command, arguments->methods);
  add_maps_option(*command, arguments->methods.maps);
  add_json_option(*command, arguments->json);
  add_figure_option(*command, arguments->figure);
  command->callback([arguments, command] { scan(*command, *arguments); });
}

}  // namespace roadstereo::cli
