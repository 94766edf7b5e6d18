#include "evaluate/fault_trials.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/degrees.hpp"
#include "evaluate/damage_regions.hpp"
#include "evaluation/image_faults.hpp"
#include "find_damage_or_warn.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

using synth::SyntheticPair;

/// Centre and focal length of the warps.
struct Lens {
  double cx, cy, focal_px;

  explicit Lens(const SyntheticPair& pair)
      : cx(pair.calibration.cx_px), cy(pair.calibration.cy_px), focal_px(pair.calibration.focal_px) {}
};

/// Coordinates of the undistorted image that an image with radial distortion 1 + k r² shows.
Frame distorted(const Frame& frame, const Lens& lens, double k) {
  return io::warped(frame, [&](double u, double v) {
    const double x = (u - lens.cx) / lens.focal_px, y = (v - lens.cy) / lens.focal_px;
    const double scale = 1 + k * (x * x + y * y);
    return std::array{lens.cx + lens.focal_px * x * scale, lens.cy + lens.focal_px * y * scale};
  });
}

Frame turned(const Frame& frame, const Lens& lens, double scale, double angle_deg) {
  const double angle = to_radians(angle_deg);
  const double c = scale * std::cos(angle), s = scale * std::sin(angle);
  return io::warped(frame, [&](double u, double v) {
    const double x = u - lens.cx, y = v - lens.cy;
    return std::array{lens.cx + c * x - s * y, lens.cy + s * x + c * y};
  });
}

/// Every row moved along itself by `shift(row / height)`.
Frame with_moved_rows(const Frame& frame, const std::function<double(double)>& shift) {
  return io::warped(frame, [&](double u, double v) { return std::array{u + shift(v / frame.height), v}; });
}

Frame with_wave(const Frame& frame, double amplitude_px, double cycles) {
  return with_moved_rows(frame, [&](double t) { return amplitude_px * std::sin(2 * std::numbers::pi * cycles * t); });
}

Frame lowered(const Frame& frame, double rows) {
  return io::warped(frame, [&](double u, double v) { return std::array{u, v - rows}; });
}

using PerView = std::function<void(Frame& frame, std::uint32_t seed)>;

/// A fault that hits both views in other pixels.
Fault each_view(const std::string& name, const PerView& apply) {
  return {name, [apply](SyntheticPair& pair, std::uint32_t seed) {
            apply(pair.left, 2 * seed);
            apply(pair.right, 2 * seed + 1);
          }};
}

Fault right_view(const std::string& name, const std::function<Frame(const Frame& frame, const Lens& lens)>& apply) {
  return {name, [apply](SyntheticPair& pair, std::uint32_t) { pair.right = apply(pair.right, Lens(pair)); }};
}

Fault calibration_fault(const std::string& name, const std::function<void(StereoCalibration&)>& apply) {
  return {name, [apply](SyntheticPair& pair, std::uint32_t) { apply(pair.calibration); }};
}

void add_weather(std::vector<Fault>& list) {
  for (const int count : {5, 20, 60, 150, 600}) {
    list.push_back(each_view(fmt::format("{} streaks", count),
                             [count](Frame& frame, std::uint32_t seed) { io::add_streaks(frame, count, seed); }));
  }
  list.push_back(each_view("100 snow dots", [](Frame& frame, std::uint32_t seed) { io::add_dots(frame, 100, seed); }));
  list.push_back(each_view("0.5 % dead pixels",
                           [](Frame& frame, std::uint32_t seed) { io::add_dead_pixels(frame, 0.005, seed); }));
  list.push_back(
      {"6 specks, left", [](SyntheticPair& pair, std::uint32_t seed) { io::add_specks(pair.left, 6, seed); }});
}

void add_geometry(std::vector<Fault>& list) {
  for (const double k : {0.002, 0.005, 0.01, 0.05}) {
    list.push_back(right_view(fmt::format("right k = {}", k),
                              [k](const Frame& frame, const Lens& lens) { return distorted(frame, lens, k); }));
  }
  list.push_back({"both k = -0.1", [](SyntheticPair& pair, std::uint32_t) {
                    const Lens lens(pair);
                    pair.left = distorted(pair.left, lens, -0.1);
                    pair.right = distorted(pair.right, lens, -0.1);
                  }});
  list.push_back(right_view("right scaled 1 %",
                            [](const Frame& frame, const Lens& lens) { return turned(frame, lens, 1.01, 0); }));
  list.push_back(right_view("right turned 0.5°",
                            [](const Frame& frame, const Lens& lens) { return turned(frame, lens, 1, 0.5); }));
  for (const double rows : {0.5, 1.0, 3.0}) {
    list.push_back(right_view(fmt::format("right {} rows lower", rows),
                              [rows](const Frame& frame, const Lens&) { return lowered(frame, rows); }));
  }
  for (const double amplitude : {0.5, 2.0}) {
    list.push_back(right_view(fmt::format("right vibrates {} px", amplitude),
                              [amplitude](const Frame& frame, const Lens&) { return with_wave(frame, amplitude, 3); }));
  }
  const auto skew = [](double px) { return [px](double t) { return px * (t - 0.5); }; };
  list.push_back(right_view("right skewed 4 px",
                            [skew](const Frame& frame, const Lens&) { return with_moved_rows(frame, skew(4)); }));
  list.push_back({"both skewed 10 px", [skew](SyntheticPair& pair, std::uint32_t) {
                    pair.left = with_moved_rows(pair.left, skew(10));
                    pair.right = with_moved_rows(pair.right, skew(10));
                  }});
}

void add_calibration(std::vector<Fault>& list) {
  for (const double offset : {5.0, -5.0}) {
    list.push_back(calibration_fault(fmt::format("doffs {:+}", offset), [offset](StereoCalibration& calibration) {
      calibration.disparity_offset_px += offset;
    }));
  }
  list.push_back(calibration_fault("focal +20 %", [](StereoCalibration& c) { c.focal_px *= 1.2; }));
  list.push_back(calibration_fault("baseline +10 %", [](StereoCalibration& c) { c.baseline_m *= 1.1; }));
}

void add_sensor(std::vector<Fault>& list) {
  for (const int quality : {90, 75, 50, 20, 5}) {
    list.push_back(each_view(fmt::format("JPEG {}", quality),
                             [quality](Frame& frame, std::uint32_t) { frame = io::with_jpeg_loss(frame, quality); }));
  }
  for (const int sigma : {4, 8, 10, 25}) {
    list.push_back(each_view(fmt::format("noise {}", sigma),
                             [sigma](Frame& frame, std::uint32_t seed) { io::add_noise(frame, sigma, seed); }));
  }
  for (const double gain : {0.1, 0.5, 2.0, 4.0}) {
    list.push_back({fmt::format("right gain {}", gain),
                    [gain](SyntheticPair& pair, std::uint32_t) { io::scale_levels(pair.right, gain); }});
  }
  list.push_back({"right blurred 3 px", [](SyntheticPair& pair, std::uint32_t) { io::blur(pair.right, 3); }});
}

/// The roads of the faults: random seeds 1 to 8, flat, uav; rendered once.
const std::vector<SyntheticPair>& scenes() {
  static const std::vector<SyntheticPair> pairs = [] {
    constexpr std::uint64_t random_scenes = 8;
    std::vector<SyntheticPair> rendered;
    for (std::uint64_t seed = 1; seed <= random_scenes; ++seed) rendered.push_back(render(synth::random_scene(seed)));
    rendered.push_back(render(synth::named_scene("flat")));
    rendered.push_back(render(synth::named_scene("uav")));
    return rendered;
  }();
  return pairs;
}

/// Whether a pixel lies within 4 pixels of any damage of the truth.
Image<std::uint8_t> near_truth(const Image<std::uint16_t>& labels) {
  constexpr int radius = 4;
  Image<std::uint8_t> near(labels.width(), labels.height(), 0);
  for (int v = 0; v < labels.height(); ++v) {
    for (int u = 0; u < labels.width(); ++u) {
      if (labels(u, v) == 0) continue;
      for (int y = std::max(0, v - radius); y <= std::min(labels.height() - 1, v + radius); ++y) {
        for (int x = std::max(0, u - radius); x <= std::min(labels.width() - 1, u + radius); ++x) near(x, y) = 1;
      }
    }
  }
  return near;
}

bool is_graded(const Damage& damage) {
  return damage.metrics && damage.metrics->severity >= Severity::minor;
}

void count_invented(const SyntheticPair& pair, const DamageMap& map, FaultCounts& counts) {
  const Image<std::uint8_t> near = near_truth(pair.labels);
  std::vector<std::size_t> true_pixels(map.damages.size());
  for (int v = 0; v < near.height(); ++v) {
    for (int u = 0; u < near.width(); ++u) {
      if (map.ids(u, v) != 0 && near(u, v) != 0) ++true_pixels[map.ids(u, v) - 1U];
    }
  }
  for (std::size_t i = 0; i < map.damages.size(); ++i) {
    constexpr std::size_t parts = 10;
    const Damage& damage = map.damages[i];
    if (parts * true_pixels[i] >= damage.pixels) continue;
    ++counts.invented;
    counts.invented_graded += is_graded(damage) ? 1 : 0;
    if (damage.metrics) counts.deepest_m = std::max(counts.deepest_m, damage.metrics->max_depth_m.value);
  }
}

void count_found(const SyntheticPair& pair, const DamageMap& map, FaultCounts& counts) {
  for (const synth::DamageTruth& truth : pair.damages) {
    if (truth.kind == "crack") continue;
    std::size_t pixels = 0;
    std::map<int, std::size_t> by_id;
    for (int v = 0; v < pair.labels.height(); ++v) {
      for (int u = 0; u < pair.labels.width(); ++u) {
        if (pair.labels(u, v) != truth.id) continue;
        ++pixels;
        if (map.ids(u, v) != 0) ++by_id[map.ids(u, v)];
      }
    }
    if (pixels == 0) continue;
    ++counts.in_view;
    const auto best = std::max_element(by_id.begin(), by_id.end(),
                                       [](const auto& one, const auto& other) { return one.second < other.second; });
    if (best == by_id.end() || static_cast<double>(best->second) < min_damage_share * static_cast<double>(pixels)) {
      continue;
    }
    ++counts.found;
    const Damage& damage = map.damages[static_cast<std::size_t>(best->first - 1)];
    if (!is_graded(damage)) continue;
    const Measurement& depth = damage.metrics->max_depth_m;
    ++counts.depths;
    counts.depths_within_2 += std::abs(depth.value - truth.depth_m) <= 2 * depth.std_error ? 1 : 0;
  }
}

/// The words before the first number: warnings of one kind begin alike.
std::string kind_of(const std::string& warning) {
  return warning.substr(0, warning.find_first_of("0123456789"));
}

void count_warnings(const std::vector<std::string>& warnings, FaultCounts& counts) {
  counts.warned += warnings.empty() ? 0 : 1;
  for (const std::string& warning : warnings) {
    const bool is_known = std::any_of(counts.warnings.begin(), counts.warnings.end(),
                                      [&](const std::string& known) { return kind_of(known) == kind_of(warning); });
    if (!is_known) counts.warnings.push_back(warning);
  }
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = [] {
    std::vector<Fault> list{{"none", [](SyntheticPair&, std::uint32_t) {}}};
    add_weather(list);
    add_geometry(list);
    add_calibration(list);
    add_sensor(list);
    return list;
  }();
  return all;
}

FaultCounts run_fault(const Fault& fault, int pictures, const MethodSettings& settings) {
  const PipelineOptions options = with_settings(preset("default"), settings);
  FaultCounts counts;
  for (int i = 0; i < pictures; ++i) {
    SyntheticPair pair = scenes()[static_cast<std::size_t>(i) % scenes().size()];
    fault.apply(pair, static_cast<std::uint32_t>(i + 1));
    ++counts.pictures;
    try {
      Pipeline pipeline(options, pair.calibration);
      const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
      std::vector<std::string> warnings = result.warnings;
      DamageMap map;
      PairHealth health;
      find_damage_or_warn(result, pair.calibration, options.damage, options.threads, map, health, warnings);
      count_found(pair, map, counts);
      count_invented(pair, map, counts);
      count_warnings(warnings, counts);
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      count_found(pair, make_empty_damage_map(pair.labels.width(), pair.labels.height(), ""), counts);
      count_warnings({error.what()}, counts);
    }
  }
  return counts;
}

}  // namespace roadstereo::cli
