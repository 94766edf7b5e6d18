#include "road/cuda/roll_assessment.hpp"

#include "road/roll_assessment.hpp"
#include "road/roll_energy.hpp"

namespace roadstereo::cuda {

RollEstimate finish_road_fit(const RoadFitStatistics& figures, int width, int height, const RollOptions& options) {
  require_enough(figures.points);
  if (figures.has_plane == 0) fail_on_one_line();
  RollEstimate geometry;
  geometry.pixels = static_cast<std::size_t>(figures.points);
  geometry.plane = {figures.plane.a0, figures.plane.a1, figures.plane.a2};
  geometry.iterations = figures.fit.found != 0 ? figures.fit.iterations : 0;
  geometry.roll_rad = roll_of_plane(geometry.plane);
  assess_roll(figures.moments, width, height, options, geometry);
  return geometry;
}

RollEstimate solve_map(const RawSums& sums, int width, int height, double initial_roll_rad,
                       const RollOptions& options) {
  return solve_from_sums(PlaneSums((width - 1) / 2.0, (height - 1) / 2.0, sums), initial_roll_rad, options);
}

void finish_measured(const RoadFitStatistics& figures, int width, int height, const RollOptions& options,
                     RollEstimate& geometry) {
  assess_roll(figures.moments, width, height, options, geometry);
}

}  // namespace roadstereo::cuda
