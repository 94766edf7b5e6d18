#include "damage/candidate_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/binned_selection.hpp"
#include "damage/contours.hpp"
#include "damage/morphology.hpp"
#include "damage/neighbours.hpp"

namespace roadstereo {
namespace {

/// Shares of the rim of a region in the view that lie on the border of the view and on that of what is seen: the rim of
/// a damage is not known there.
void measure_border(const BoxMask& region, const CommonView& view, const Image<std::uint8_t>& unseen,
                    DamageEvidence& evidence) {
  double rim = 0, on_border = 0, on_gap = 0;
  for (const auto [i, j] : rim_cells(region)) {
    const bool at_border = view.is_on_border(i, j);
    bool at_gap = false;
    for_each_neighbour(i, j, unseen.width(), unseen.height(),
                       [&](int x, int y) { at_gap |= unseen(x, y) != 0 && !region(x, y); });
    ++rim;
    on_border += at_border ? 1 : 0;
    on_gap += at_gap && !at_border ? 1 : 0;
  }
  if (rim == 0) return;
  evidence.border_share = on_border / rim;
  evidence.unseen_share = on_gap / rim;
}

/// Share of the band around a candidate of that depth that is road, the relief of a rough one included, or a hollow no
/// deeper than the outline. Without metres relief is what is small beside the depth. Cells of other damages and outside
/// the view do not count; 1 if no cell is left.
double road_share(const SearchInput& input, const Candidate& candidate, float depth_inside, SearchImages& images) {
  constexpr double margin_radii = 0.5;  // width of the band, radii √(area / π) of the region
  constexpr int min_margin_cells = 3;
  constexpr float max_hollow_sigmas = 10;  // depth of a hollow around a pothole that counts as road
  const double radius = std::sqrt(static_cast<double>(candidate.size) / std::numbers::pi);
  constexpr float relief_share = 0.1F;  // 5 mm beside a pothole of 50 mm
  const float min_relief = input.thresholds.metric() ? 0 : relief_share * depth_inside;
  const int margin = std::max(min_margin_cells, static_cast<int>(margin_radii * radius));
  const CellBox around = candidate.box().grown(margin, input.road.width(), input.road.height());
  const BoxMask dilated = dilate(candidate.cells, margin, around);
  const Image<std::uint8_t>& assigned = images.labels(around);
  const float sign = sign_of(candidate.kind);
  const float max_hollow =
      candidate.kind == DamageKind::depression
          ? std::min(candidate.level, max_hollow_sigmas * static_cast<float>(input.depth_cells.noise))
          : 0.0F;
  double cells = 0;
  double on_road = 0;
  const BoxMask inside = candidate.cells.cropped(around);
  for (int j = around.first_row; j <= around.last_row; ++j) {
    const std::uint8_t* const in_band = dilated.cells().row(j - around.first_row);
    const std::uint8_t* const is_inside = inside.cells().row(j - around.first_row);
    const std::uint8_t *const labels = assigned.row(j), *const valid = input.depth_cells.valid.row(j);
    const std::uint8_t* const road = input.road.row(j);
    const float* const depths = input.depth_cells.depth.row(j);
    for (int k = 0; k < around.columns(); ++k) {
      if ((in_band[k] & ~is_inside[k]) == 0) continue;
      const int i = around.first_column + k;
      const bool other_damage = labels[i] != 0 && labels[i] != obstacle_label;
      if (other_damage || !input.view.contains(i, j)) continue;
      ++cells;
      if (valid[i] == 0) continue;
      const float depth = sign * depths[i];
      const bool is_road = road[i] != 0 || (depth > 0 && depth <= max_hollow) ||
                           std::abs(depth) < std::max(min_relief, input.thresholds.relief(i, j));
      on_road += is_road ? 1 : 0;
    }
  }
  return cells == 0 ? 1 : on_road / cells;
}

/// Contrast of a depth to the surroundings, in standard deviations: to the band around a region, or to the half of the
/// band where it is least. A part of a verge is no rougher than the rest of it, which may be less than half of the
/// band.
double least_contrast(double depth, const BandAround& band, double noise) {
  constexpr std::size_t min_samples = 12, min_share = 8;  // 1/8 of the band: of half of it, less is not seen
  const auto contrast_to = [&](const RobustNormal& part) {
    return (depth - part.median) / std::max(part.sigma, noise);
  };
  double least = contrast_to(band.whole);
  for (const RobustNormal& half : band.halves) {
    if (half.samples < min_samples || min_share * half.samples < band.whole.samples) continue;
    least = std::min(least, contrast_to(half));
  }
  return least;
}

double least_sigma(const BandAround& band) {
  const auto least = std::min_element(band.halves.begin(), band.halves.end(),
                                      [](const auto& one, const auto& other) { return one.sigma < other.sigma; });
  return std::min(band.whole.sigma, least->sigma);
}

/// Standard deviation of the road around a region, or of all road if that is less: in the distance, on gravel or in the
/// shade the road may be noisier than here. A band that is noisier than all road needs no other measure.
double noise_around(const DepthField& field, const Candidate& candidate, const BandAround& band, int near_cells,
                    double of_road) {
  constexpr double wide_band_radii = 3;
  if (least_sigma(band) >= of_road) return of_road;
  const RobustNormal wide = depths_around(field, candidate.cells, near_cells, wide_band_radii);
  return wide.samples >= candidate.size ? std::min(of_road, wide.sigma) : of_road;
}

/// Number of cells, each counted by the square of its share of the depth of the floor, as by a matched filter: the
/// smeared rim of a narrow hole says little of it.
double floor_cells(std::span<const float> depths, double around, double floor) {
  if (floor <= around) return 0;
  double cells = 0;
  for (const float depth : depths) {
    const double share = std::clamp((double{depth} - around) / (floor - around), 0.0, 1.0);
    cells += share * share;
  }
  return cells;
}

/// Find the share of a region that lies in a rut, and the significance of that rut times the share.
void measure_ruts(const Ruts& ruts, Candidate& candidate) {
  const BoxMask& region = candidate.cells;
  candidate.rut_share = candidate.evidence.rut_significance = 0;
  if (ruts.empty()) return;
  std::vector<std::size_t> counts(ruts.significances.size() + 1, 0);
  const CellBox& box = region.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (region(i, j)) ++counts[ruts.labels(i, j)];
    }
  }
  for (std::size_t k = 1; k < counts.size(); ++k) {
    const double share = static_cast<double>(counts[k]) / static_cast<double>(candidate.size);
    candidate.rut_share = std::max(candidate.rut_share, share);
    candidate.evidence.rut_significance =
        std::max(candidate.evidence.rut_significance, ruts.significances[k - 1] * share);
  }
}

}  // namespace

std::vector<float> depths_inside(const SearchImages& images, const Candidate& candidate) {
  std::vector<float> inside;
  inside.reserve(candidate.size);
  const CellBox& box = candidate.box();
  for (int j = box.first_row; j <= box.last_row; ++j) {
    const std::uint8_t* const is_inside = candidate.cells.cells().row(j - box.first_row);
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (is_inside[i - box.first_column] != 0) inside.push_back(images.depth(i, j));
    }
  }
  return inside;
}

void add_evidence(const SearchInput& input, SearchImages& images, Candidate& candidate) {
  constexpr int near_cells = 3;  // closer to the rim the depth is smoothed
  constexpr double band_radii = 1;
  constexpr double min_noise_px = 1e-6;  // of maps without noise
  const std::vector<float> inside = depths_inside(images, candidate);
  const BandAround around = band_around(images.field(), candidate.cells, near_cells, band_radii);
  const double noise = noise_around(images.field(), candidate, around, near_cells, input.depth_cells.noise);
  const double window = input.image_edges.window_radius, floor = floor_of(inside);
  const double samples = floor_cells(inside, around.whole.median, floor) / (std::numbers::pi * window * window);
  DamageEvidence& evidence = candidate.evidence;
  evidence.contrast_sigmas = least_contrast(floor, around, std::max(noise, min_noise_px));
  evidence.significance = evidence.contrast_sigmas * std::sqrt(std::max(1.0, samples));
  evidence.road_share = road_share(input, candidate, binned_median(inside), images);
  measure_border(candidate.cells, input.view, input.gaps.unseen, evidence);
  if (candidate.kind == DamageKind::depression) measure_ruts(input.ruts, candidate);
}

double confidence_at_best(const Candidate& candidate, const Thresholds& thresholds) {
  DamageEvidence steepest = candidate.evidence;
  if (candidate.kind == DamageKind::depression && thresholds.walls_measured()) steepest.likely_wall_slope = 1;
  return steepest.confidence();
}

}  // namespace roadstereo
