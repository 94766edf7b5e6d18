#include "roadstereo/road_model.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/downsample.hpp"
#include "core/format_message.hpp"
#include "core/require_range.hpp"
#include "road/coarse_match.hpp"
#include "road/plane_fit.hpp"
#include "road/plane_match.hpp"
#include "road/road_assessment.hpp"
#include "road/road_search.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

/// How much a match speaks for a plane. The road is what fills the lower part of the picture, and nothing but damage
/// lies below it: a match beyond the plane speaks against it, one in front of it (a vehicle, a verge) hardly.
double vote(const DisparityPoint& point, const DisparityPlane& plane, double tolerance_px, int height) {
  const double expected = plane.disparity(point.u, point.v);
  if (expected <= 0) return 0;  // above the horizon
  const double relative = (point.d - expected) / tolerance_px;
  const double lower = point.v / height;
  const double weight = 0.2 + lower * lower;
  if (std::abs(relative) < 1) return weight * (1 - relative * relative);
  return relative < 0 ? -0.7 * weight : -0.1 * weight;
}

std::optional<DisparityPlane> search_road(std::span<const DisparityPoint> matches, double tolerance_px, int height,
                                          const TiltLimit& limit) {
  const auto votes = [&](std::span<const DisparityPoint> points, const DisparityPlane& plane) {
    double sum = 0;
    for (const DisparityPoint& p : points) sum += vote(p, plane, tolerance_px, height);
    return sum;
  };
  return ransac_plane(matches, votes, [&](const DisparityPlane& plane) { return limit.can_be_road(plane); });
}

/// The same plane in the coordinates of the image shrunk by `factor`.
DisparityPlane downsample_plane(const DisparityPlane& plane, int factor) {
  const double centre = to_full_resolution(0, factor);
  return {plane.disparity(centre, centre) / factor, plane.a1, plane.a2};
}

ScratchVector<DisparityPoint> points_to_full_resolution(ScratchVector<DisparityPoint> points, int factor) {
  for (DisparityPoint& p : points) p = {to_full_resolution(p.u, factor), to_full_resolution(p.v, factor), p.d * factor};
  return points;
}

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

/// What the fine search around a plane and a robust fit leave.
struct Refinement {
  PlaneFitStatistics evidence;
  ScratchVector<DisparityPoint> points = scratch_vector<DisparityPoint>();  ///< full-size coordinates
};

/// Where the plane that a refinement starts from comes from.
enum class Origin { this_pair, last_frame };

/// The pair as the fine search sees it: at full size, or a large one shrunk.
class FinePair {
 public:
  FinePair(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right)
      : factor_(fine_factor(left.width())) {
    // At full size there is nothing to shrink, and nothing to copy.
    const std::size_t size = factor_ > 1 ? left.pixels() / static_cast<std::size_t>(factor_ * factor_) : 0;
    pixels_.resize(2 * size);
    left_ = shrunk(left, pixels_.data());
    right_ = shrunk(right, pixels_.data() + size);
  }

  ImageView<const std::int16_t> left() const { return left_; }
  ImageView<const std::int16_t> right() const { return right_; }
  int factor() const { return factor_; }

 private:
  ImageView<const std::int16_t> shrunk(ImageView<const std::int16_t> image, std::int16_t* pixels) const {
    if (factor_ == 1) return image;
    const ImageView<std::int16_t> small(pixels, image.width() / factor_, image.height() / factor_);
    downsample(image, factor_, small);
    return small;
  }

  int factor_;
  ScratchVector<std::int16_t> pixels_ = scratch_vector<std::int16_t>();
  ImageView<const std::int16_t> left_, right_;
};

Refinement refine_road(const FinePair& pair, const DisparityPlane& plane, Origin origin, const FineSearch& search,
                       const TiltLimit& limit, bool with_roll, int threads) {
  constexpr double tolerance = 1.0;  // of the vote, pixels of the shrunk image
  const int factor = pair.factor();
  const int height = pair.left().height() * factor;
  PlaneMatches found = match_along_plane(pair.left(), pair.right(), downsample_plane(plane, factor), search.range_px,
                                         search.places, threads);
  Refinement result;
  PlaneFitStatistics& evidence = result.evidence;
  evidence.tried = found.tried;
  result.points = points_to_full_resolution(std::move(found.points), factor);
  evidence.points = static_cast<int>(result.points.size());
  if (evidence.points < min_matches) return result;
  // The supposed plane may lie between a road and its pavement: vote anew with the sharper points.
  const auto start = origin == Origin::last_frame ? std::optional(plane)
                                                  : search_road(result.points, tolerance * factor, height, limit);
  if (!start) return result;
  const auto fit = fit_plane_irls(result.points, *start, fine_fit_scale * factor, with_roll, fine_fit_iterations);
  if (!fit) return result;
  evidence.plane = fit->plane;
  evidence.scale_px = fit->scale_px;
  auto rows = scratch_vector<double>();
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (fit->weights[i] > 0) rows.push_back(result.points[i].v);
  }
  evidence.inliers = static_cast<int>(rows.size());
  evidence.found = evidence.inliers >= min_matches;
  if (evidence.found) {
    evidence.rows_covered = (lower_quantile(rows, row_p95) - lower_quantile(rows, row_p05)) / height;
  }
  return result;
}

/// Whether exchanging the images explains them far better than the order they came in. Only asked when few pixels of
/// the shrunk image matched.
bool look_swapped(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int factor,
                  double max_disparity_px, std::size_t matches, int threads) {
  constexpr std::size_t usual_share = 5;  // a fifth of the pixels
  const std::size_t pixels = left.pixels() / static_cast<std::size_t>(factor * factor);
  if (matches > pixels / usual_share) return false;
  const auto swapped = match_coarsely(right, left, factor, max_disparity_px, threads);
  return swapped.size() > std::max<std::size_t>(3 * matches, min_matches);
}

}  // namespace

void RoadModelOptions::validate() const {
  require_range("road_model", "max_disparity_share", max_disparity_share, 0.05, 0.9);
  require_range("road_model", "max_road_tilt_deg", max_road_tilt_deg, 5.0, 80.0);
  require_range("road_model", "min_inlier_share", min_inlier_share, 0.0, 1.0);
  require_range("road_model", "verify_tolerance_px", verify_tolerance_px, Above{0.0}, 100.0);
}

RoadModelEstimate estimate_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options, int threads) {
  const int factor = coarse_factor(left.width());
  const double max_disparity = options.max_disparity_share * left.width();
  const ScratchVector<DisparityPoint> matches = match_coarsely(left, right, factor, max_disparity, threads);
  if (look_swapped(left, right, factor, max_disparity, matches.size(), threads)) {
    fail("left and right look swapped: the matches lie at negative disparities");
  }
  RoadModelEstimate estimate;
  estimate.matches = static_cast<int>(matches.size());
  if (estimate.matches < min_matches) {
    estimate.reason = format_message("only ", matches.size(), " reliable correspondences in the whole image");
    return estimate;
  }
  auto disparities = scratch_vector<double>();
  disparities.reserve(matches.size());
  for (const DisparityPoint& p : matches) disparities.push_back(p.d);
  estimate.max_disparity_px = lower_quantile(disparities, 0.99);

  const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
  const auto coarse = search_road(matches, 0.8 * factor, left.height(), limit);
  if (!coarse) {
    estimate.reason = format_message("none of ", matches.size(), " correspondences speak for a road");
    return estimate;
  }
  // First wide, for the coarse plane is good to a pixel of the shrunk image at best; then close.
  const FinePair fine(left, right);
  Refinement refinement =
      refine_road(fine, *coarse, Origin::this_pair, first_search, limit, options.with_roll, threads);
  if (refinement.evidence.found) {
    refinement = refine_road(fine, refinement.evidence.plane, Origin::this_pair, close_search, limit, options.with_roll,
                             threads);
  }
  judge(refinement.evidence, options.min_inlier_share, limit, estimate);
  measure_range(matches, estimate);
  return estimate;
}

RoadModelEstimate verify_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                    const DisparityPlane& previous, const std::optional<StereoCalibration>& calibration,
                                    const RoadModelOptions& options, int threads) {
  const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
  const FinePair fine(left, right);
  const Refinement around =
      refine_road(fine, previous, Origin::last_frame, first_search_again, limit, options.with_roll, threads);
  const Refinement close = around.evidence.found ? refine_road(fine, around.evidence.plane, Origin::last_frame,
                                                               close_search_again, limit, options.with_roll, threads)
                                                 : Refinement();
  RoadModelEstimate estimate =
      assess_tracked_road(around.evidence, close.evidence, previous, left.width(), left.height(), calibration, options);
  measure_range(around.points, estimate);
  return estimate;
}

}  // namespace roadstereo
