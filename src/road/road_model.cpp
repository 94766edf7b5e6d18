#include "roadstereo/road_model.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/format_message.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "road/black_border.hpp"
#include "road/coarse_match.hpp"
#include "road/fine_search.hpp"
#include "road/plane_evidence.hpp"
#include "road/rig_prior.hpp"
#include "road/road_assessment.hpp"
#include "road/road_search.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// Where the correspondences near the road lie.
void measure_range(std::span<const DisparityPoint> matches, RoadModelEstimate& estimate) {
  auto residuals = scratch_vector<double>();
  for (const DisparityPoint& p : matches) {
    const double expected = estimate.model.disparity(p.u, p.v);
    const double residual = p.d - expected;
    if (near_road(residual, expected)) residuals.push_back(residual);
  }
  if (residuals.size() < static_cast<std::size_t>(min_matches)) return;
  estimate.residual_p01_px = lower_quantile(residuals, residual_p01);
  estimate.residual_p99_px = lower_quantile(residuals, residual_p99);
}

/// The pair at full size, and downsampled as for the coarse search, where noise that hides every block averages out;
/// that is made when it is asked for.
class FinePairs {
 public:
  static constexpr int count = 2;

  FinePairs(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, ImageView<const std::uint8_t> mask,
            int coarse_factor)
      : left_(left),
        right_(right),
        mask_(mask),
        coarse_factor_(coarse_factor),
        full_(left, right, mask, fine_factor(left.width())) {}

  const FinePair& operator[](int i) {
    if (i == 0) return full_;
    if (!downsampled_) downsampled_.emplace(left_, right_, mask_, coarse_factor_);
    return *downsampled_;
  }

 private:
  ImageView<const std::int16_t> left_, right_;
  ImageView<const std::uint8_t> mask_;
  int coarse_factor_;
  FinePair full_;
  std::optional<FinePair> downsampled_;
};

/// By single blocks, and where these find nothing by cells of them.
PlaneFitStatistics find_around(const FinePair& pair, const DisparityPlane& plane, bool with_roll, int threads) {
  const TwoSearches by_blocks(pair, plane, match_along_plane, first_search, close_search, with_roll, threads);
  if (by_blocks.last().found) return by_blocks.last();
  return TwoSearches(pair, plane, match_cells_along_plane, first_cell_search, close_cell_search, with_roll, threads)
      .last();
}

/// Assess one plane in the full-size pair, or in the downsampled one.
RoadModelEstimate assess_plane(FinePairs& pairs, const PlaneHypothesis& hypothesis, const PlaneEvidence& evidence,
                               const TiltLimit& limit, const RoadModelOptions& options, int threads,
                               const RoadModelEstimate& matched) {
  const auto weigh = [&](const DisparityPlane& plane) { return limit.pose_weight(plane) * evidence.of_plane(plane); };
  RoadModelEstimate first = matched;
  for (int i = 0; i < FinePairs::count; ++i) {
    const FinePair& pair = pairs[i];
    PlaneFitStatistics fit = find_around(pair, hypothesis.plane, options.with_roll, threads);
    if (fit.found) {
      const DisparityPlane even = fit_evenly(pair, fit.plane, limit, options.with_roll, threads);
      if (weigh(even) >= min_even_evidence * weigh(fit.plane)) fit.plane = even;
    }
    RoadModelEstimate assessed = matched;
    assess_found_road(fit, hypothesis.evidence, limit, options, assessed);
    if (assessed.has_road()) return assessed;
    if (i == 0) first = assessed;
  }
  return first;
}

/// Assess the planes in turn until one is a road. If none is, the reason is that of the first.
RoadModelEstimate assess_planes(FinePairs& pairs, std::span<const PlaneHypothesis> planes,
                                const PlaneEvidence& evidence, const TiltLimit& limit, const RoadModelOptions& options,
                                int threads, const RoadModelEstimate& matched) {
  RoadModelEstimate estimate = matched;
  for (const PlaneHypothesis& hypothesis : planes) {
    RoadModelEstimate assessed = assess_plane(pairs, hypothesis, evidence, limit, options, threads, matched);
    if (assessed.has_road()) return assessed;
    if (&hypothesis == &planes.front()) estimate = assessed;
  }
  return estimate;
}

/// A wall or a ceiling crosses any plane somewhere and so gives it evidence, but has several times as much itself. If
/// so, a found road becomes weak, and a weak one is rejected. House fronts beside a road have up to three times the
/// evidence of the road; objects above a road seldom have more, except low ceilings.
void doubt_road(double wall, double ceiling, RoadModelEstimate& road) {
  constexpr double wall_ratio = 4, ceiling_ratio = 2;
  if (ceiling > ceiling_ratio * road.evidence) {
    road.reason = format_message("the pair looks upside down: the evidence for a plane above the camera is ", ceiling,
                                 " per pixel, that for a road only ", road.evidence);
  } else if (wall > wall_ratio * road.evidence) {
    road.reason =
        format_message("the evidence for a wall is ", wall, " per pixel, that for a road only ", road.evidence);
  }
  if (!road.reason.empty()) road.status = road.status == RoadStatus::weak ? RoadStatus::none : RoadStatus::weak;
}

/// Searches around the last frame's plane.
RoadModelEstimate track_road(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                             const TrackedRoad& previous, PlaneMatcher match, const FineSearch& first,
                             const FineSearch& second, const std::optional<StereoCalibration>& calibration,
                             const RoadModelOptions& options, int threads, ImageView<const std::uint8_t> mask) {
  require_one_size({left.width(), left.height()}, {right.width(), right.height()});
  require_mask_size({mask.width(), mask.height()}, {left.width(), left.height()});
  options.validate();
  const FinePair fine(left, right, mask, fine_factor(left.width()));
  const TwoSearches found(fine, previous.model, match, first, second, options.with_roll, threads);
  RoadModelEstimate estimate = assess_tracked_road(found.wide.evidence, found.close.evidence, previous, first.range_px,
                                                   left.width(), left.height(), calibration, options);
  measure_range(found.wide.points, estimate);
  return estimate;
}

/// The reason for no road if few blocks match. Few matches alone are no reason to reject a road, since noise that
/// leaves no block reliable averages out over a plane.
std::string too_few(int matches) {
  return format_message("only ", matches, " reliable correspondences in the whole image");
}

/// Whether exchanging the images explains them far better than the order they came in. Only asked when few pixels of
/// the downsampled image matched.
bool look_swapped(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int factor,
                  double max_disparity_px, std::size_t matches, int threads, ImageView<const std::uint8_t> mask) {
  constexpr std::size_t usual_share = 5;  // a fifth of the pixels
  const std::size_t pixels = left.pixels() / static_cast<std::size_t>(factor * factor);
  if (matches > pixels / usual_share) return false;
  const auto swapped = match_coarsely(right, left, factor, max_disparity_px, threads, mask).points;
  return swapped.size() > std::max<std::size_t>(3 * matches, min_matches);
}

/// Disparities that the coarse search covers, and the factor by which it downsamples the pair.
struct CoarseRange {
  int factor;
  double max_disparity_px;
};

/// The range of what was matched, if none of it counts in full as evidence: a cell does from a share of the range on,
/// since the far road is a small patch. Below a camera that looks down from a height all is far, and may be less than a
/// pixel of the downsampled image.
std::optional<CoarseRange> range_of_matches(const RoadModelEstimate& estimate, const CoarseRange& searched) {
  constexpr double reserve = 1.5;
  constexpr int min_disparities = 8;
  CoarseRange range{searched.factor, reserve * estimate.max_disparity_px};
  const bool all_far = estimate.max_disparity_px < full_weight_share * searched.max_disparity_px;
  if (estimate.matches < min_matches || !all_far) return {};
  while (range.factor > 1 && range.max_disparity_px < min_disparities * range.factor) range.factor /= 2;
  range.max_disparity_px = std::max<double>(range.max_disparity_px, min_disparities * range.factor);
  return range;
}

/// The search of a road in a pair.
struct RoadSearch {
  ImageView<const std::int16_t> left, right;
  ImageView<const std::uint8_t> mask;
  const std::optional<StereoCalibration>& calibration;
  const RoadModelOptions& options;
  int threads;
  const std::optional<DisparityPlane>& last;

  /// The road with the most evidence among the disparities of a range, or why there is none.
  RoadModelEstimate in_range(const CoarseRange& range) const {
    const CoarseMatches coarse = match_coarsely(left, right, range.factor, range.max_disparity_px, threads, mask);
    const ScratchVector<DisparityPoint>& matches = coarse.points;
    RoadModelEstimate estimate;
    estimate.matches = static_cast<int>(matches.size());
    const bool few_match = estimate.matches < min_matches;
    if (!few_match) {
      auto disparities = scratch_vector<double>();
      disparities.reserve(matches.size());
      for (const DisparityPoint& p : matches) disparities.push_back(p.d);
      estimate.max_disparity_px = lower_quantile(disparities, 0.99);
    }
    const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
    // The plane with the most evidence; the next where that is no road after all.
    constexpr int max_planes = 3;
    const PlaneEvidence evidence(coarse);
    const RigPrior rig(options, calibration);
    const double at_infinity = calibration ? -calibration->disparity_offset_px : 0;
    const auto prior = [&](const DisparityPlane& plane) {
      return rig.weight(plane) * (last ? weight_near(plane, *last, at_infinity, left.width(), left.height()) : 1);
    };
    const PlaneSearchResult planes = search_planes(evidence, limit, prior, road_max_slope, max_planes, threads);
    if (planes.roads.empty()) {
      estimate.reason = few_match ? too_few(estimate.matches) : "no plane has more evidence for it than against it";
      return estimate;
    }
    FinePairs pairs(left, right, mask, range.factor);
    RoadModelEstimate found = assess_planes(pairs, planes.roads, evidence, limit, options, threads, estimate);
    if (few_match && !found.has_road()) found.reason = too_few(estimate.matches);
    const bool expected = (rig || last) && prior(found.model) >= 0.5;
    if (found.has_road() && !expected) {
      doubt_road(planes.wall_evidence, ceiling_evidence(coarse, limit, threads), found);
    }
    measure_range(matches, found);
    return found;
  }
};

}  // namespace

const char* name_of(RoadStatus status) {
  switch (status) {
    case RoadStatus::none:
      return "none";
    case RoadStatus::weak:
      return "weak";
    case RoadStatus::found:
      return "found";
    case RoadStatus::tracked:
      return "tracked";
  }
  return "none";
}

void RoadModelOptions::validate() const {
  require_range("road_model", "max_disparity_share", max_disparity_share, 0.05, 0.9);
  require_range("road_model", "max_road_tilt_deg", max_road_tilt_deg, 5.0, 80.0);
  require_range("road_model", "min_evidence", min_evidence, 0.0, 1.0);
  require_range("road_model", "weak_evidence", weak_evidence, 0.0, 1.0);
  require_range("road_model", "height_m", height_m, 0.0, 1000.0);
  require_range("road_model", "pitch_deg", pitch_deg, unknown_pitch_deg, 90.0);
  require_range("road_model", "verify_tolerance_px", verify_tolerance_px, Above{0.0}, 100.0);
}

RoadModelEstimate estimate_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options, int threads, ImageView<const std::uint8_t> mask,
                                      const std::optional<DisparityPlane>& last) {
  require_one_size({left.width(), left.height()}, {right.width(), right.height()});
  require_mask_size({mask.width(), mask.height()}, {left.width(), left.height()});
  options.validate();
  const PictureMask picture(left, mask);
  const RoadSearch search{left, right, picture.view(), calibration, options, threads, last};
  const CoarseRange whole{coarse_factor(left.width(), left.height()), options.max_disparity_share * left.width()};
  RoadModelEstimate found = search.in_range(whole);
  constexpr double noteworthy_px = 1;  // what is far has a negative disparity then
  const bool crosses_zero = calibration && calibration->disparity_offset_px > noteworthy_px;
  if (!crosses_zero && look_swapped(left, right, whole.factor, whole.max_disparity_px,
                                    static_cast<std::size_t>(found.matches), threads, picture.view())) {
    fail("left and right look swapped: the matches lie at negative disparities");
  }
  if (found.status == RoadStatus::found) return found;
  const std::optional<CoarseRange> seen = range_of_matches(found, whole);
  if (!seen) return found;
  const RoadModelEstimate again = search.in_range(*seen);
  // Most of what the camera shows is road then, as from a drone; in what is far a plane through some of it is none.
  constexpr double majority = 0.5;
  const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
  const bool is_below = limit.share_below_horizon(again.model) == 1 && again.inlier_share > majority;
  return again.status > found.status && is_below ? again : found;
}

RoadModelEstimate verify_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                    const TrackedRoad& previous, const std::optional<StereoCalibration>& calibration,
                                    const RoadModelOptions& options, int threads, ImageView<const std::uint8_t> mask) {
  return track_road(left, right, previous, match_along_plane, first_search_again, close_search_again, calibration,
                    options, threads, mask);
}

RoadModelEstimate verify_road_model_in_noise(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                             const TrackedRoad& previous,
                                             const std::optional<StereoCalibration>& calibration,
                                             const RoadModelOptions& options, int threads,
                                             ImageView<const std::uint8_t> mask) {
  return track_road(left, right, previous, match_cells_along_plane, first_cell_search, close_cell_search, calibration,
                    options, threads, mask);
}

}  // namespace roadstereo
