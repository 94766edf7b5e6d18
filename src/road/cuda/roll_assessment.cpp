#include "road/cuda/roll_assessment.hpp"

#include "road/roll_assessment.hpp"

namespace roadstereo::cuda {

RollEstimate finish_road_fit(const RoadFitStatistics& statistics, int width, int height, const RollOptions& options) {
  require_enough(statistics.points);
  if (statistics.has_plane == 0) fail_on_one_line();
  RollEstimate geometry;
  geometry.pixels = static_cast<std::size_t>(statistics.points);
  geometry.plane = statistics.plane;
  geometry.iterations = statistics.fit.found != 0 ? statistics.fit.iterations : 0;
  geometry.roll_rad = roll_of_plane(geometry.plane);
  assess_roll(statistics.moments, width, height, options, geometry);
  return geometry;
}

RollEstimate finish_solved(const SolvedMap& solved, const RoadFitStatistics& measured, int width, int height,
                           const RollOptions& options) {
  RollEstimate geometry = take_solved(solved.roll, solved.sums.n);
  assess_roll(measured.moments, width, height, options, geometry);
  return geometry;
}

}  // namespace roadstereo::cuda
