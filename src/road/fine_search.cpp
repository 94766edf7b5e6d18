#include "road/fine_search.hpp"

#include "core/noise_correlation.hpp"
#include "core/order_statistics.hpp"
#include "road/downsampled_plane.hpp"
#include "road/plane_fit.hpp"

namespace roadstereo {

ScratchVector<DisparityPoint> points_to_full_resolution(ScratchVector<DisparityPoint> points, int factor) {
  for (DisparityPoint& p : points) p = {to_full_resolution(p.u, factor), to_full_resolution(p.v, factor), p.d * factor};
  return points;
}

Refinement refine_road(const FinePair& pair, const DisparityPlane& plane, PlaneMatcher match, const FineSearch& search,
                       bool with_roll, int threads) {
  const int factor = pair.factor();
  const int height = pair.left().height() * factor;
  PlaneMatches found = match(pair.left(), pair.right(), downsample_plane(plane, factor), search.range_px, search.places,
                             threads, pair.masked());
  Refinement result;
  PlaneFitStatistics& evidence = result.evidence;
  evidence.tried = found.tried;
  evidence.by_cells = match == match_cells_along_plane;
  if (found.correlations.size() >= static_cast<std::size_t>(min_matches)) {
    evidence.correlation = full_size_correlation(lower_quantile(found.correlations, correlation_p10), factor);
  }
  result.points = points_to_full_resolution(std::move(found.points), factor);
  evidence.points = static_cast<int>(result.points.size());
  if (evidence.points < found.min_points) return result;
  const auto fit = fit_plane_irls(result.points, plane, fine_fit_scale * factor, with_roll, fine_fit_iterations);
  if (!fit) return result;
  evidence.plane = fit->plane;
  evidence.scale_px = fit->scale_px;
  auto rows = scratch_vector<double>();
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (fit->weights[i] > 0) rows.push_back(result.points[i].v);
  }
  evidence.inliers = static_cast<int>(rows.size());
  evidence.found = evidence.inliers >= found.min_points;
  if (evidence.found) {
    evidence.rows_covered = (lower_quantile(rows, row_p95) - lower_quantile(rows, row_p05)) / height;
  }
  return result;
}

DisparityPlane fit_evenly(const FinePair& pair, const DisparityPlane& plane, const TiltLimit& limit, bool with_roll,
                          int threads) {
  const int factor = pair.factor();
  const int places = static_cast<int>(pair.left().pixels() / (std::size_t{even_spacing_px} * even_spacing_px));
  const PlaneMatches found = match_cells_along_plane(pair.left(), pair.right(), downsample_plane(plane, factor),
                                                     even_range_px, places, threads, pair.masked());
  const auto points = points_to_full_resolution(found.points, factor);
  if (points.size() < min_even_points) return plane;
  const auto start = ransac_plane(points, even_tolerance * factor);
  if (!start || !limit.can_be_road(*start)) return plane;
  const auto fit = fit_plane_irls(points, *start, fine_fit_scale * factor, with_roll, fine_fit_iterations);
  return fit && limit.can_be_road(fit->plane) ? fit->plane : plane;
}

}  // namespace roadstereo
