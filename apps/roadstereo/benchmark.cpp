#include <fmt/core.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "benchmark_frames.hpp"
#include "benchmark_report.hpp"
#include "commands.hpp"
#include "core/parallel.hpp"
#include "evaluation/peer_matchers.hpp"
#include "image_size.hpp"
#include "roadstereo/device.hpp"
#include "roadstereo/error.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {
namespace {

struct BenchmarkArguments {
  PairFiles files;
  std::string size = "640x360";
  int disparities = 32;
  std::string preset = "default";
  std::string engine = "auto";
  int threads = 0;
  int runs = 30;
  bool no_peers = false;
  int raw_disparities = 0;
  std::string json;
};

StereoPair make_pair(const BenchmarkArguments& arguments) {
  if (!arguments.files.left.empty()) return read_pair(arguments.files, arguments.threads);
  const ImageSize size = parse_image_size("--size", arguments.size);
  constexpr int largest = 8192;
  if (size.width > largest || size.height > largest) {
    fail("--size is ", arguments.size, "; the sides must be at most ", largest, " pixels");
  }
  return synthetic_pair(size.width, size.height);
}

void add_stages(const StageTimes& ms, std::vector<Timing>& stages) {
  const std::pair<const char*, double> values[] = {
      {"prepare", ms.prepare},    {"road model", ms.road_model}, {"perspective", ms.perspective},
      {"coarse", ms.coarse},      {"match", ms.match},           {"refinement", ms.refinement},
      {"road geometry", ms.roll}, {"transform", ms.transform},   {"download", ms.download}};
  if (stages.empty()) {
    for (const auto& [name, value] : values) stages.push_back({name, {}});
  }
  for (std::size_t i = 0; i < stages.size(); ++i) stages[i].ms.push_back(values[i].second);
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr std::size_t kilobyte = 1024;
  return static_cast<std::size_t>(usage.ru_maxrss) * kilobyte;
}

/// OpenCV's matchers, after a first run, on the pair as the pipeline has transformed it, or as it is for
/// `--raw-disparities`.
std::vector<io::PeerMatcher> make_baselines(const BenchmarkArguments& arguments, const StereoPair& pair,
                                            const PerspectiveShift& shift, BenchmarkReport& report) {
  const bool raw = arguments.raw_disparities > 0;
  const int searched = io::peer_disparities(raw ? arguments.raw_disparities : report.disparities);
  if (searched >= report.width) {
    fail("OpenCV's matchers cannot search ", searched, " disparities in ", report.width,
         " columns; --no-peers leaves them out");
  }
  if (raw) report.raw_disparities = searched;
  PerspectiveShift none;
  none.enabled = false;
  const PeerPair grey = peer_pair(pair, raw ? none : shift);
  std::vector<io::PeerMatcher> baselines;
  for (const std::string& name : io::peer_names()) {
    baselines.emplace_back(name, searched);
    baselines.back().set_pair(grey.reference, grey.target);
    baselines.back().match();
    report.baselines.push_back({name, {}});
  }
  return baselines;
}

/// Runs the pipeline and OpenCV's matchers alternately for equal conditions; the first run of each is not counted.
BenchmarkReport measure(const BenchmarkArguments& arguments) {
  const StereoPair pair = make_pair(arguments);
  PipelineOptions options = preset(arguments.preset);
  options.engine = arguments.engine;
  options.threads = arguments.threads;
  options.white_level = pair.white_level;
  options.perspective.disparities = arguments.disparities;
  const auto before = allocations();
  reset_peak();
  Pipeline pipeline(options, pair.calibration);
  const bool on_device = pipeline.engine_name() == "cuda";
  if (on_device) pipeline.set_device_options({.timing = DeviceTiming::stages});
  const auto process = [&] { pipeline.process(pair.left.view(), pair.right.view()); };
  process();
  const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());

  BenchmarkReport report;
  report.width = pair.left.width;
  report.height = pair.left.height;
  report.disparities = result.shift.disparities;
  report.preset = arguments.preset;
  report.engine = pipeline.engine_name();
  report.threads = resolve_threads(arguments.threads);
  report.cpu = cpu_name();
  report.target = find_engine(report.engine).description;
  if (before) report.scratch_bytes = allocations()->peak_bytes - before->live_bytes;

  std::vector<io::PeerMatcher> baselines;
  if (!arguments.no_peers) baselines = make_baselines(arguments, pair, result.shift, report);
  std::size_t allocated = 0;
  for (int run = 0; run < arguments.runs; ++run) {
    pipeline.reset();
    report.first.ms.push_back(time_ms(process));
    const std::size_t count = before ? allocations()->count : 0;
    report.total.ms.push_back(time_ms(process));
    if (before) allocated += allocations()->count - count;
    add_stages(result.ms, report.stages);
    for (std::size_t i = 0; i < baselines.size(); ++i)
      report.baselines[i].ms.push_back(time_ms([&] { baselines[i].match(); }));
  }
  if (on_device) {
    // The total without the time of the stages' events, and the kernels in a frame of their own.
    pipeline.set_device_options({.timing = DeviceTiming::none});
    report.total.ms.clear();
    for (int run = 0; run < arguments.runs; ++run) report.total.ms.push_back(time_ms(process));
    pipeline.set_device_options({.timing = DeviceTiming::kernels});
    process();
    report.device = pipeline.device_profile();
  }
  if (before) report.allocations = static_cast<double>(allocated) / arguments.runs;
  report.peak_memory_bytes = peak_memory_bytes();
  return report;
}

/// Called before minutes of measurement.
void require_writable(const std::string& path) {
  if (!std::ofstream(path, std::ios::app)) fail("cannot write ", path, ": ", std::generic_category().message(errno));
}

void write_json(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) fail<SystemError>("cannot write ", path, ": ", std::generic_category().message(errno));
}

void benchmark(const BenchmarkArguments& arguments) {
  if (arguments.files.left.empty() != arguments.files.right.empty())
    fail("benchmark needs both LEFT and RIGHT, or neither");
  if (arguments.runs < 1 || arguments.runs > 100000) {
    fail("--runs is ", arguments.runs, "; it must be between 1 and 100000");
  }
  constexpr int most_disparities = 1024;
  if (arguments.raw_disparities < 0 || arguments.raw_disparities > most_disparities) {
    fail("--raw-disparities is ", arguments.raw_disparities, "; it must be between 0 and ", most_disparities);
  }
  if (!arguments.json.empty()) require_writable(arguments.json);
  const BenchmarkReport report = measure(arguments);
  fmt::print("{}", report_text(report));
  if (!arguments.json.empty()) write_json(arguments.json, report_json(report));
}

constexpr const char* benchmark_footer =
    R"(Measures the time of every stage of the pipeline on frames whose road model is known from the previous frame,
alternating with OpenCV's matchers on the same frames and disparities. Without LEFT and RIGHT a synthetic road is used.
With --raw-disparities OpenCV's matchers get the pair without the perspective transformation, and the disparities that it needs.
With the engine cuda it adds the kernels of a frame, with times and occupancy, launches, waits and bytes copied.

Examples:
  roadstereo benchmark
  roadstereo benchmark --size 1242x375 --disparities 64 --preset fast --json result.json
  roadstereo benchmark left.png right.png --calibration calibration.yaml --disparities 0 --raw-disparities 128)";

}  // namespace

void add_benchmark(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("benchmark", "Measure the time of every stage, compared with OpenCV's matchers");
  command->footer(benchmark_footer);
  const auto arguments = std::make_shared<BenchmarkArguments>();
  command->add_option("LEFT", arguments->files.left, "Left image");
  command->add_option("RIGHT", arguments->files.right, "Right image");
  command->add_option("--calibration", arguments->files.calibration, "Calibration file")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("--size", arguments->size, "Size of the synthetic frame")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--disparities", arguments->disparities, "Number of disparities; 0: derived from the road model")
      ->type_name("D")
      ->capture_default_str();
  command->add_option("--preset", arguments->preset, "Preset of the options")->type_name("NAME")->capture_default_str();
  command->add_option("--engine", arguments->engine, "Matching engine")->type_name("NAME")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--runs", arguments->runs, "Number of runs")->type_name("N")->capture_default_str();
  command->add_flag("--no-peers", arguments->no_peers, "Skip OpenCV's matchers");
  command
      ->add_option("--raw-disparities", arguments->raw_disparities,
                   "OpenCV's matchers search so many disparities of the pair as it is, a multiple of 16; 0: of the "
                   "transformed pair")
      ->type_name("D");
  command->add_option("--json", arguments->json, "Also write the results to this JSON file")->type_name("FILE");
  command->callback([arguments] { benchmark(*arguments); });
}

}  // namespace roadstereo::cli
