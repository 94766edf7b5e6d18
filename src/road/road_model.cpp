#include "roadstereo/road_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/sentence.hpp"
#include "core/shrink.hpp"
#include "road/coarse_match.hpp"
#include "road/guided_match.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int coarse_width = 120;   ///< the coarse search shrinks the image to between this and twice this
constexpr int fewest_matches = 40;  ///< below this nothing is known

constexpr double least_share_again = 0.5;  ///< that a carried-over model explains; to look anew costs only time

/// How far and in how many places a search around a supposed plane looks. Each first brings the plane near, then
/// measures it where the residuals are small, for a parabola is the more exact the nearer the peak is to a pixel.
struct FineSearch {
  int range_px;
  int places;
};
constexpr FineSearch first_search{7, 1000};  ///< the coarse plane is good to a pixel of the shrunk image at best
constexpr FineSearch close_search{4, 2500};
constexpr FineSearch close_search_again{2, 1500};
constexpr FineSearch first_search_again{4, 500};  ///< around the last frame's plane

/// Power of two that brings the image near the width of the coarse search.
int coarse_factor(int width) {
  int factor = 1;
  while (width / (2 * factor) >= coarse_width) factor *= 2;
  return factor;
}

/// Tells roads from walls: the sideways tilt of the plane. Without a calibration a usual lens stands in; it decides
/// nothing but what cannot be a road.
class TiltLimit {
 public:
  TiltLimit(int width, int height, const std::optional<StereoCalibration>& calibration, double max_tilt_deg)
      : focal_(calibration ? calibration->focal_px : 0.8 * width),
        cx_(calibration ? calibration->cx_px : width / 2.0),
        cy_(calibration ? calibration->cy_px : height / 2.0),
        offset_(calibration ? calibration->disparity_offset_px : 0),
        largest_sine_(std::sin(max_tilt_deg * std::numbers::pi / 180)) {}

  bool can_be_road(const RoadModel& plane) const {
    const double depth = (plane.disparity(cx_, cy_) + offset_) / focal_;
    const double length = std::hypot(plane.a1, plane.a2, depth);
    // A road lies below the camera and is not seen from beneath.
    return length > 0 && std::abs(plane.a2) <= largest_sine_ * length && plane.a1 >= -largest_sine_ * length;
  }

 private:
  double focal_, cx_, cy_, offset_, largest_sine_;
};

/// How much a match speaks for a plane. The road is what fills the lower part of the picture, and nothing but damage
/// lies below it: a match beyond the plane speaks against it, one in front of it (a vehicle, a verge) hardly.
double vote(const DisparityPoint& point, const RoadModel& plane, double tolerance_px, int height) {
  const double expected = plane.disparity(point.u, point.v);
  if (expected <= 0) return 0;  // above the horizon
  const double relative = (point.d - expected) / tolerance_px;
  const double lower = point.v / height;
  const double weight = 0.2 + lower * lower;
  if (std::abs(relative) < 1) return weight * (1 - relative * relative);
  return relative < 0 ? -0.7 * weight : -0.1 * weight;
}

std::optional<RoadModel> search_road(std::span<const DisparityPoint> matches, double tolerance_px, int height,
                                     const TiltLimit& limit) {
  const auto votes = [&](std::span<const DisparityPoint> points, const RoadModel& plane) {
    double sum = 0;
    for (const DisparityPoint& p : points) sum += vote(p, plane, tolerance_px, height);
    return sum;
  };
  return search_plane(matches, votes, [&](const RoadModel& plane) { return limit.can_be_road(plane); });
}

/// The same plane in the coordinates of the image shrunk by `factor`.
RoadModel shrink_model(const RoadModel& plane, int factor) {
  const double centre = unshrink(0, factor);
  return {plane.disparity(centre, centre) / factor, plane.a1, plane.a2};
}

ScratchVector<DisparityPoint> unshrink_points(ScratchVector<DisparityPoint> points, int factor) {
  for (DisparityPoint& p : points) p = {unshrink(p.u, factor), unshrink(p.v, factor), p.d * factor};
  return points;
}

double percentile(std::span<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Where the correspondences near the road lie: far enough from it to show damage, bumps and a road that is not flat,
/// not so far that vehicles and houses count.
void measure_range(std::span<const DisparityPoint> matches, RoadModelEstimate& estimate) {
  auto residuals = scratch_vector<double>();
  for (const DisparityPoint& p : matches) {
    const double expected = estimate.model.disparity(p.u, p.v);
    const double residual = p.d - expected;
    if (expected > 0 && std::abs(residual) < 4 + 0.12 * expected) residuals.push_back(residual);
  }
  if (residuals.size() < static_cast<std::size_t>(fewest_matches)) return;
  estimate.lowest_px = percentile(residuals, 0.01);
  estimate.highest_px = percentile(residuals, 0.99);
}

/// What the fine search around a plane and a robust fit leave.
struct Refinement {
  bool found = false;
  RobustPlane fit;
  ScratchVector<DisparityPoint> points = scratch_vector<DisparityPoint>();  ///< full-size coordinates
  int tried = 0;
  int inliers = 0;
  double rows_covered = 0;  ///< share of the image height between the 5th and the 95th percentile of the inliers' rows
};

/// Where the plane that a refinement starts from comes from.
enum class Origin { this_pair, last_frame };

/// The pair as the fine search sees it: at full size, or a large one shrunk.
class FinePair {
 public:
  FinePair(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right)
      : factor_(std::max(1, coarse_factor(left.width()) / 8)) {
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
    shrink(image, factor_, small);
    return small;
  }

  int factor_;
  ScratchVector<std::int16_t> pixels_ = scratch_vector<std::int16_t>();
  ImageView<const std::int16_t> left_, right_;
};

Refinement refine_road(const FinePair& pair, const RoadModel& plane, Origin origin, const FineSearch& search,
                       const TiltLimit& limit, bool with_roll, int threads) {
  constexpr int iterations = 50;
  constexpr double tolerance = 1.0;    // of the vote, pixels of the shrunk image
  constexpr double start_scale = 0.5;  // of the fit: a kerb must not pull it, a road that is not flat must stay in
  const int factor = pair.factor();
  const int height = pair.left().height() * factor;
  GuidedMatches found =
      match_near_plane(pair.left(), pair.right(), shrink_model(plane, factor), search.range_px, search.places, threads);
  Refinement result;
  result.tried = found.tried;
  result.points = unshrink_points(std::move(found.points), factor);
  if (result.points.size() < static_cast<std::size_t>(fewest_matches)) return result;
  // The supposed plane may lie between a road and its pavement: vote anew with the sharper points.
  const auto start = origin == Origin::last_frame ? std::optional(plane)
                                                  : search_road(result.points, tolerance * factor, height, limit);
  if (!start) return result;
  auto fit = fit_robust_plane(result.points, *start, start_scale * factor, with_roll, iterations);
  if (!fit) return result;
  result.fit = std::move(*fit);
  auto rows = scratch_vector<double>();
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (result.fit.weights[i] > 0) rows.push_back(result.points[i].v);
  }
  result.inliers = static_cast<int>(rows.size());
  result.found = result.inliers >= fewest_matches;
  if (result.found) {
    result.rows_covered = (percentile(rows, 0.95) - percentile(rows, 0.05)) / height;
  }
  return result;
}

/// Share of the textured places of the road that the model explains.
double inlier_share(const Refinement& refinement) {
  return refinement.tried > 0 ? static_cast<double>(refinement.inliers) / refinement.tried : 0;
}

/// Fills in the estimate from the last refinement and says whether, and if not why not, it can be trusted.
void judge(const Refinement& refinement, double least_share, const TiltLimit& limit, RoadModelEstimate& estimate) {
  constexpr double least_rows_covered = 0.1;
  estimate.model = refinement.fit.plane;
  estimate.inliers = refinement.inliers;
  estimate.residual_px = refinement.fit.scale_px;
  const double share = inlier_share(refinement);
  if (!refinement.found) {
    estimate.reason = sentence("only ", refinement.points.size(), " correspondences lie near the supposed road");
  } else if (share < least_share) {
    estimate.reason = sentence("the road explains ", 100 * share, " % of the textured places where it should be seen, ",
                               "less than ", 100 * least_share, " %");
  } else if (refinement.rows_covered < least_rows_covered) {
    estimate.reason = sentence("the road was found in ", 100 * refinement.rows_covered, " % of the rows only");
  } else if (!limit.can_be_road(estimate.model)) {
    estimate.reason = "the plane found is tilted like a wall";
  } else {
    estimate.reliable = true;
  }
}

/// How far a plane has moved since the last frame: the largest change of its disparity in a corner of the image that
/// sees the road both times.
double largest_move(const RoadModel& now, const RoadModel& before, int width, int height) {
  double largest = 0;
  for (const double v : {0.0, height - 1.0}) {
    for (const double u : {0.0, width - 1.0}) {
      const double d = now.disparity(u, v), last = before.disparity(u, v);
      if (d > 0 && last > 0) largest = std::max(largest, std::abs(d - last));
    }
  }
  return largest;
}

/// A road that has moved further than this from one frame to the next has jumped: then nothing says that the search
/// around the last frame's plane has seen all of it. In a smooth flight it moves a tenth as far.
double largest_step_px(int width) {
  constexpr double share_of_width = 1.0 / 640, least_px = 0.25;
  return std::max(least_px, share_of_width * width);
}

/// Whether exchanging the images explains them far better than the order they came in. Only asked when few pixels of
/// the shrunk image matched.
bool look_swapped(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int factor,
                  double max_disparity_px, std::size_t matches, int threads) {
  constexpr std::size_t usual_share = 5;  // a fifth of the pixels
  const std::size_t pixels = left.pixels() / static_cast<std::size_t>(factor * factor);
  if (matches > pixels / usual_share) return false;
  const auto swapped = match_coarsely(right, left, factor, max_disparity_px, threads);
  return swapped.size() > std::max<std::size_t>(3 * matches, fewest_matches);
}

}  // namespace

void RoadModelOptions::validate() const {
  const auto require = [](bool good, const char* name, double value, const char* rule) {
    if (!good) fail("road_model.", name, " is ", value, "; it must be ", rule);
  };
  require(max_disparity_share >= 0.05 && max_disparity_share <= 0.9, "max_disparity_share", max_disparity_share,
          "between 0.05 and 0.9");
  require(max_road_tilt_deg >= 5 && max_road_tilt_deg <= 80, "max_road_tilt_deg", max_road_tilt_deg,
          "between 5 and 80 degrees");
  require(min_inlier_share >= 0 && min_inlier_share <= 1, "min_inlier_share", min_inlier_share, "between 0 and 1");
  require(verify_tolerance_px > 0 && verify_tolerance_px <= 100, "verify_tolerance_px", verify_tolerance_px,
          "above 0 and at most 100 pixels");
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
  if (estimate.matches < fewest_matches) {
    estimate.reason = sentence("only ", matches.size(), " reliable correspondences in the whole image");
    return estimate;
  }
  auto disparities = scratch_vector<double>();
  disparities.reserve(matches.size());
  for (const DisparityPoint& p : matches) disparities.push_back(p.d);
  estimate.largest_disparity_px = percentile(disparities, 0.99);

  const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
  const auto coarse = search_road(matches, 0.8 * factor, left.height(), limit);
  if (!coarse) {
    estimate.reason = sentence("none of ", matches.size(), " correspondences speak for a road");
    return estimate;
  }
  // First wide, for the coarse plane is good to a pixel of the shrunk image at best; then close.
  const FinePair fine(left, right);
  Refinement refinement =
      refine_road(fine, *coarse, Origin::this_pair, first_search, limit, options.with_roll, threads);
  if (refinement.found) {
    refinement =
        refine_road(fine, refinement.fit.plane, Origin::this_pair, close_search, limit, options.with_roll, threads);
  }
  judge(refinement, options.min_inlier_share, limit, estimate);
  measure_range(matches, estimate);
  return estimate;
}

RoadModelEstimate verify_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                    const RoadModel& previous, const std::optional<StereoCalibration>& calibration,
                                    const RoadModelOptions& options, int threads) {
  const TiltLimit limit(left.width(), left.height(), calibration, options.max_road_tilt_deg);
  const FinePair fine(left, right);
  const Refinement around =
      refine_road(fine, previous, Origin::last_frame, first_search_again, limit, options.with_roll, threads);
  const Refinement refinement = around.found ? refine_road(fine, around.fit.plane, Origin::last_frame,
                                                           close_search_again, limit, options.with_roll, threads)
                                             : Refinement();
  RoadModelEstimate estimate;
  estimate.carried_over = true;
  estimate.matches = static_cast<int>(around.points.size());
  judge(refinement, std::max(options.min_inlier_share, least_share_again), limit, estimate);
  if (estimate.reliable && estimate.residual_px > options.verify_tolerance_px) {
    estimate.reliable = false;
    estimate.reason = sentence("the last frame's road leaves ", estimate.residual_px, " px on this one");
  }
  const double moved = largest_move(estimate.model, previous, left.width(), left.height());
  if (estimate.reliable && moved > largest_step_px(left.width())) {
    estimate.reliable = false;
    estimate.reason = sentence("the road has moved by ", moved, " px since the last frame");
  }
  measure_range(around.points, estimate);
  return estimate;
}

}  // namespace roadstereo
