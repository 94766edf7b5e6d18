#include "stage_floors.hpp"

#include <algorithm>

#include "core/cuda/check.hpp"
#include "road/refinement/settings.hpp"
#include "stereo/trim_window.hpp"

namespace roadstereo::bench {
namespace {

double attribute(cudaDeviceAttr which) {
  int device = 0, value = 0;
  ROADSTEREO_CUDA(cudaGetDevice(&device));
  ROADSTEREO_CUDA(cudaDeviceGetAttribute(&value, which, device));
  return value;
}

/// Bytes and operations of one stage.
struct Work {
  double bytes = 0, operations = 0, shared_bytes = 0;

  /// 0 where the driver does not tell a peak.
  double ms(const Peak& peak) const {
    if (!(peak.bytes > 0 && peak.operations > 0)) return 0;
    return 1e3 * std::max({bytes / peak.bytes, operations / peak.operations, shared_bytes / peak.shared_bytes});
  }
};

/// match_view.cu, per matched pixel and disparity, but column sums of products per pixel; block_sums.cu and
/// finish_rows.cu per pixel.
Work matching(const MatcherOptions& options, double pixels, int disparities) {
  constexpr double tile_columns = 32, tile_rows = 8;
  int across = 0, down = 0;
  const std::vector<Tap> taps = trimmed_taps(options);
  for (const Tap& tap : taps) {
    across = std::max(across, tap.du);
    down = std::max(down, tap.dv);
  }
  const double step = options.pixel_step, rows = tile_rows + 2 * down / step, halo = tile_columns + 2 * across / step;
  const double surroundings = halo * rows / (tile_columns * tile_rows);
  const double block = 2 * options.block_radius + 1, window = static_cast<double>(taps.size());
  const double views = options.match_both_views ? 2 : 1;
  const double costs = views * pixels / (step * step) * disparities;
  return {.bytes = pixels * (2 * 26 + 22),
          .operations = costs * (surroundings * (4 * step * step + block + 8) + window + 6),
          .shared_bytes = costs * ((4 * (block + 1 + step) + 5 * step * step) * surroundings + 4 * window)};
}

/// stereo/coarse/cuda/*.cu, with the pair at half its size, or less.
Work coarse_search(const PipelineOptions& options, int width, double pixels, int disparities) {
  constexpr int max_columns = 800;
  int factor = std::max(2, options.coarse_search.factor);
  while (options.coarse_search.factor == 0 && factor < 8 && width / factor > max_columns) factor *= 2;
  const double coarse = pixels / (factor * factor), costs = coarse * (disparities - 1.0) / factor;
  return {.bytes = 4 * pixels + 32 * coarse + (4 + 12 + 24) * costs, .operations = costs * (62 + 5 + 14)};
}

/// slopes.cu and refinement.cu of the matched pixels, interpolation.cu and lucas_kanade.cu.
Work refinement(const PipelineOptions& options, double pixels) {
  const double refined = pixels / (options.matcher.pixel_step * options.matcher.pixel_step);
  const double between = options.matcher.pixel_step > 1 ? 1 : 0;
  const double neighbours = 2.0 * (options.refinement.radius / options.refinement.step) + 1;
  const double window = pass_count(options.refinement) * neighbours * neighbours;
  const double smoothing = options.refinement.smoothing_px > 0 ? 1 : 0;
  const RefinementPass first = refinement_pass(of_matched_pixels(options.refinement, options.matcher.pixel_step), 0, 1);
  const double sloped = first.on_slope ? 1 : 0, box = 2.0 * first.slope.step - 1;
  const double aligned = options.lucas_kanade.radius > 0 ? 1 : 0;
  const double cells = (2.0 * options.lucas_kanade.radius + 1) * (2.0 * options.lucas_kanade.radius + 1) / 16;
  return {.bytes = (16 * pass_count(options.refinement) + 24 * sloped + 12 * smoothing) * refined +
                   (10 * between + 17 * aligned) * pixels,
          .operations = (16 * window + (10 * box + 40) * sloped + 7 * smoothing) * refined +
                        (100 + 10 * cells) * aligned * pixels,
          .shared_bytes = (12 * window + 48 * box * sloped) * refined};
}

}  // namespace

Peak device_peak() {
  constexpr double khz = 1e3, bits_per_byte = 8, per_clock = 2;  // memory moves twice in a clock
  const double clock = khz * attribute(cudaDevAttrClockRate);
  const double multiprocessors = attribute(cudaDevAttrMultiProcessorCount);
  // A multiprocessor's; before compute capability 8.6, and of an A100, it has half the lanes: there floors are too low.
  constexpr double lanes = 128, shared_bytes = 128;
  return {.bytes = per_clock * khz * attribute(cudaDevAttrMemoryClockRate) *
                   attribute(cudaDevAttrGlobalMemoryBusWidth) / bits_per_byte,
          .operations = multiprocessors * clock * lanes,
          .shared_bytes = multiprocessors * clock * shared_bytes};
}

StageTimes stage_floors(const PipelineOptions& options, int width, int height, int disparities, const Peak& peak) {
  const double pixels = static_cast<double>(width) * height;
  StageTimes floors;
  floors.prepare = Work{.bytes = 6 * pixels, .operations = 16 * pixels}.ms(peak);
  floors.perspective = Work{.bytes = 4 * pixels, .operations = 20 * pixels}.ms(peak);
  floors.coarse = coarse_search(options, width, pixels, disparities).ms(peak);
  floors.match = matching(options.matcher, pixels, disparities).ms(peak);
  floors.refinement = refinement(options, pixels).ms(peak);
  floors.transform = Work{.bytes = 12 * pixels, .operations = 40 * pixels}.ms(peak);
  return floors;
}

}  // namespace roadstereo::bench
