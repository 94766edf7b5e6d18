#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "core/require_range.hpp"
#include "mapping/forward_path.hpp"
#include "roadstereo/road_profile.hpp"
#include "roadstereo/roughness_index.hpp"

namespace roadstereo {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Mean height of a rectangle of the road.
struct StripHeight {
  double height_m = nan;
  double sigma_m = nan;
};

/// Reads single cells of the map through a cache of blocks.
class MapReader {
 public:
  explicit MapReader(const RoadMap& map) : map_(map), cell_m_(map.options().cell_m) {}

  /// Mean over `right_m` × `forward_m` around a point beside a station, weighted by the inverse variances.
  StripHeight mean(const PathStation& station, double right_m, double forward_m, double wide_m, double long_m) {
    constexpr double window_cells = 21;  // diameter of the support of a disparity, which cells are about as large as
    const int across = std::max(1, static_cast<int>(std::lround(wide_m / cell_m_)));
    const int along = std::max(1, static_cast<int>(std::lround(long_m / cell_m_)));
    double weight = 0, sum = 0;
    int cells = 0;
    for (int i = 0; i < across; ++i) {
      for (int j = 0; j < along; ++j) {
        const auto at = station.beside(right_m + ((i + 0.5) / across - 0.5) * wide_m,
                                       forward_m + ((j + 0.5) / along - 0.5) * long_m);
        const auto [height, sigma] = cell(at);
        if (!std::isfinite(height)) continue;
        const double w = 1 / (static_cast<double>(sigma) * sigma);
        weight += w;
        sum += w * height;
        ++cells;
      }
    }
    if (2 * cells < across * along) return {};
    const double samples = std::max(1.0, across / window_cells) * std::max(1.0, along / window_cells);
    return {sum / weight, std::sqrt(cells / weight / samples)};
  }

 private:
  std::array<float, 2> cell(const std::array<double, 2>& at) {
    constexpr int side = 256;
    const int i = static_cast<int>(std::floor(at[0] / cell_m_)), j = static_cast<int>(std::floor(at[1] / cell_m_));
    const int i0 = i & ~(side - 1), j0 = j & ~(side - 1);
    if (block_ == nullptr || block_->box.i0 != i0 || block_->box.j0 != j0) {
      constexpr std::size_t max_blocks = 64;
      if (blocks_.size() >= max_blocks) blocks_.clear();
      const auto [known, fresh] = blocks_.try_emplace({i0, j0});
      if (fresh) known->second = map_.read({i0, j0, side, side});
      block_ = &known->second;
    }
    const int u = i - i0, v = side - 1 - (j - j0);
    return {block_->height(u, v), block_->sigma(u, v)};
  }

  const RoadMap& map_;
  double cell_m_;
  const MapRaster* block_ = nullptr;  ///< the last one
  std::map<std::array<int, 2>, MapRaster> blocks_;
};

/// Slope of heights against position by least squares, with its standard error.
Measurement slope_of(const std::vector<double>& heights, double spacing_m, double sigma_m) {
  double n = 0, x = 0, xx = 0, z = 0, xz = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!std::isfinite(heights[i])) continue;
    const double at = static_cast<double>(i) * spacing_m;
    n += 1;
    x += at;
    xx += at * at;
    z += heights[i];
    xz += at * heights[i];
  }
  const double spread = xx - x * x / n;
  if (!(n >= 3 && spread > 0)) return {nan, nan};
  return {(xz - x * z / n) / spread, sigma_m / std::sqrt(spread)};
}

/// Noise gap of straightedges by the number of heights: they are few.
class NoiseGaps {
 public:
  NoiseGaps(double spacing_m, double straightedge_m) : spacing_m_(spacing_m), straightedge_m_(straightedge_m) {}
  double of(std::size_t heights) {
    const auto [known, fresh] = gaps_.try_emplace(heights, 0);
    if (fresh) known->second = straightedge_noise_gap(heights, spacing_m_, straightedge_m_);
    return known->second;
  }

 private:
  double spacing_m_, straightedge_m_;
  std::map<std::size_t, double> gaps_;
};

std::vector<TransverseProfile> measure_across(MapReader& reader, const ForwardPath& path, double cell_m,
                                              const LaneOptions& options) {
  const double spacing_m = std::max(0.1, cell_m);
  constexpr double resolvable_floors = 2, min_width_share = 0.5;
  const auto count = static_cast<std::size_t>(std::lround(options.lane_width_m / spacing_m)) + 1;
  NoiseGaps noise(spacing_m, options.straightedge_m);
  std::vector<TransverseProfile> profiles;
  const auto stations = static_cast<int>(path.length_m() / options.station_m) + 1;
  for (int k = 0; k < stations; ++k) {
    const double s = k * options.station_m;
    const PathStation station = path.at(s);
    std::vector<double> heights(count, nan);
    double variance = 0;
    std::size_t measured = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double right = (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)) * spacing_m;
      const StripHeight strip = reader.mean(station, right, 0, spacing_m, options.average_m);
      heights[i] = strip.height_m;
      if (!std::isfinite(strip.height_m)) continue;
      variance += strip.sigma_m * strip.sigma_m;
      ++measured;
    }
    TransverseProfile profile;
    profile.width_m = static_cast<double>(measured) * spacing_m;
    if (profile.width_m < min_width_share * std::min(options.lane_width_m, options.straightedge_m)) continue;
    const double sigma = std::sqrt(variance / static_cast<double>(measured));
    profile.station_m = s;
    profile.at_m = station.at_m;
    profile.heading_rad = std::atan2(station.ahead[1], station.ahead[0]);
    profile.rut_depth_m = {straightedge_gap(heights, spacing_m, options.straightedge_m), std::numbers::sqrt2 * sigma};
    profile.rut_noise_floor_m = sigma * noise.of(measured);
    profile.rut_resolvable = profile.rut_depth_m.value > resolvable_floors * profile.rut_noise_floor_m;
    const Measurement slope = slope_of(heights, spacing_m, sigma);
    profile.cross_slope = {-slope.value, slope.std_error};
    profiles.push_back(profile);
  }
  return profiles;
}

/// Interpolates gaps of up to `max_gap` heights.
void close_gaps(std::vector<double>& heights, std::size_t max_gap) {
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (i == 0 || std::isfinite(heights[i]) || !std::isfinite(heights[i - 1])) continue;
    std::size_t end = i;
    while (end < heights.size() && !std::isfinite(heights[end])) ++end;
    if (end == heights.size() || end - i > max_gap) continue;
    const double before = heights[i - 1], step = (heights[end] - before) / static_cast<double>(end - i + 1);
    for (std::size_t k = i; k < end; ++k) heights[k] = before + static_cast<double>(k - i + 1) * step;
  }
}

/// Adds the sections of a run of heights without gaps, in equal parts of about the section's length.
void add_sections(std::span<const double> heights, double sigma_m, double start_m, double spacing_m, double offset_m,
                  double section_m, std::vector<RoughnessSection>& sections) {
  constexpr double max_floor_share = 0.3;
  const double length = static_cast<double>(heights.size()) * spacing_m;
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::floor(length / section_m)));
  const std::size_t count = heights.size() / parts;
  if (count < min_roughness_samples(spacing_m)) return;
  for (std::size_t part = 0; part < parts; ++part) {
    RoughnessSection section;
    section.offset_m = offset_m;
    section.start_m = start_m + static_cast<double>(part * count) * spacing_m;
    section.length_m = static_cast<double>(count) * spacing_m;
    section.index_m_km = roughness_index(heights.subspan(part * count, count), spacing_m);
    section.noise_floor_m_km = roughness_noise_floor(sigma_m, spacing_m);
    section.resolvable = section.noise_floor_m_km <= max_floor_share * section.index_m_km;
    sections.push_back(section);
  }
}

void measure_along(MapReader& reader, const ForwardPath& path, double offset_m, const LaneOptions& options,
                   LaneProfiles& lane) {
  const double spacing_m = lane.spacing_m;
  std::vector<double> heights;
  double variance = 0;
  std::size_t measured = 0;
  const auto count = static_cast<std::size_t>(path.length_m() / spacing_m) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const PathStation station = path.at(static_cast<double>(i) * spacing_m);
    const StripHeight strip = reader.mean(station, offset_m, 0, options.strip_m, spacing_m);
    lane.longitudinal.push_back({offset_m, station.s_m, station.beside(offset_m, 0), strip.height_m, strip.sigma_m});
    heights.push_back(strip.height_m);
    if (!std::isfinite(strip.height_m)) continue;
    variance += strip.sigma_m * strip.sigma_m;
    ++measured;
  }
  if (measured == 0) return;
  close_gaps(heights, static_cast<std::size_t>(options.max_gap_m / spacing_m));
  const double sigma = std::sqrt(variance / static_cast<double>(measured));
  for (std::size_t i = 0; i < heights.size();) {
    std::size_t end = i;
    while (end < heights.size() && std::isfinite(heights[end])) ++end;
    add_sections(std::span(heights).subspan(i, end - i), sigma, static_cast<double>(i) * spacing_m, spacing_m, offset_m,
                 options.section_m, lane.sections);
    i = end + 1;
  }
}

}  // namespace

void LaneOptions::validate() const {
  require_range("lane", "lane_width_m", lane_width_m, 0.5, 20.0);
  require_range("lane", "wheel_path_m", wheel_path_m, 0.0, 5.0);
  require_range("lane", "station_m", station_m, 0.1, 100.0);
  require_range("lane", "average_m", average_m, 0.01, 10.0);
  require_range("lane", "strip_m", strip_m, 0.01, 2.0);
  require_range("lane", "straightedge_m", straightedge_m, 0.5, 10.0);
  require_range("lane", "section_m", section_m, 11.5, 1000.0);
  require_range("lane", "max_gap_m", max_gap_m, 0.0, 5.0);
}

LaneProfiles measure_lane(const RoadMap& map, std::span<const std::array<double, 2>> points,
                          const LaneOptions& options) {
  options.validate();
  constexpr double spacing_m = 0.05;
  LaneProfiles lane;
  lane.spacing_m = std::clamp(map.options().cell_m, spacing_m, 0.5);
  const ForwardPath path(points);
  if (path.length_m() < lane.spacing_m) return lane;
  MapReader reader(map);
  lane.transverse = measure_across(reader, path, map.options().cell_m, options);
  for (const double offset : {-options.wheel_path_m, 0.0, options.wheel_path_m}) {
    measure_along(reader, path, offset, options, lane);
  }
  return lane;
}

}  // namespace roadstereo
