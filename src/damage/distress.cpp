#include "damage/distress.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

#include "core/degrees.hpp"
#include "damage/ruts.hpp"

namespace roadstereo {
namespace {

constexpr double max_gentle_slope = 0.2;  // rise over run: depressions of D6433 are flatter, walls of potholes steeper
constexpr double min_elongation = 3;      // of ruts and cracks
constexpr double min_pothole_m = 0.1;     // diameter, ASTM D6433: narrower long damages are cracks
constexpr double min_step_m = 0.025;      // ASTM D6433, lane/shoulder drop-off
constexpr double min_kerb_m = 0.75;       // ASTM D6433, potholes count by number up to that: what the side cuts of one
constexpr double min_object_slope = 1;    // stones and branches have sides of 45° and more, bumps and heaves have not
constexpr double max_object_m = 1.5;      // twice 0.75 m: no pothole is as long, no object on the road as wide
constexpr double max_oblique_rad = std::numbers::pi / 6;  // from the direction of the road

double elongation(const DamageMetrics& metrics) {
  return metrics.width_m > 0 ? metrics.length_m / metrics.width_m : 1;
}

bool is_along_road(const DamageMetrics& metrics, double mount_yaw_deg) {
  const double road_rad = std::numbers::pi / 2 + to_radians(mount_yaw_deg);  // from the x axis towards y
  return std::abs(std::remainder(metrics.angle_rad - road_rad, std::numbers::pi)) <= max_oblique_rad;
}

bool is_kerb_step(const DamageMetrics& metrics, double mount_yaw_deg, bool at_side) {
  return at_side && metrics.max_depth_m.value >= min_step_m && metrics.length_m >= min_kerb_m &&
         elongation(metrics) >= min_elongation && is_along_road(metrics, mount_yaw_deg);
}

/// Whether two standard errors of a value do not include 0.
bool is_known(const Measurement& value) {
  return value.std_error <= 0.5 * value.value;
}

/// Depth that the severity is decided by.
Measurement graded_depth(const DamageMetrics& metrics) {
  constexpr double section_of_parabola = 1.5;  // maximum over mean depth of a rut's cross-section
  if (metrics.distress != Distress::rut) return metrics.max_depth_m;
  return {std::min(metrics.max_depth_m.value, section_of_parabola * metrics.mean_depth_m.value),
          section_of_parabola * metrics.mean_depth_m.std_error};
}

/// Probabilities of a damage that is at least so deep: half at that depth, half beyond all limits, so that a class has
/// the majority only if it has it at both.
SeverityProbabilities probabilities_from(double depth_m, const SeverityTable& table, const Measurement& diameter_m) {
  constexpr double deepest = std::numeric_limits<double>::infinity();
  const SeverityProbabilities least = severity_probabilities(table, {depth_m, 0}, diameter_m);
  const SeverityProbabilities most = severity_probabilities(table, {deepest, 0}, diameter_m);
  return {0.5 * (least.minor + most.minor), 0.5 * (least.low + most.low), 0.5 * (least.medium + most.medium),
          0.5 * (least.high + most.high)};
}

}  // namespace

const char* name_of(DamageKind kind) {
  return kind == DamageKind::depression ? "depression" : "protrusion";
}

Distress classify_distress(const Damage& damage, const DamageMetrics& metrics, double mount_yaw_deg,
                           double possible_slope, bool at_side) {
  const bool gentle = possible_slope < max_gentle_slope;
  if (!gentle && is_kerb_step(metrics, mount_yaw_deg, at_side)) return Distress::kerb_step;
  if (damage.kind == DamageKind::protrusion) {
    const bool object = possible_slope > min_object_slope && metrics.diameter_m <= max_object_m;
    return object ? Distress::debris : Distress::bump;
  }
  const bool long_one = elongation(metrics) >= min_elongation;
  const bool in_rut = damage.evidence.rut_significance >= 0.5 * min_rut_sigmas && metrics.length_m > max_object_m;
  const bool along = (long_one || in_rut) && is_along_road(metrics, mount_yaw_deg);
  if (gentle) return along ? Distress::rut : Distress::depression;
  if (long_one && metrics.area_m2.value < min_pothole_m * metrics.length_m) return Distress::crack;
  return along && metrics.length_m > max_object_m ? Distress::rut : Distress::pothole;
}

std::string distress_reason(const DamageMetrics& metrics) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "wall 1 in " << 1 / metrics.wall_slope << " or steeper";
  if (elongation(metrics) >= min_elongation) {
    text << ", " << elongation(metrics) << " times as long as wide";
  }
  return text.str();
}

void grade(const SeverityScheme& scheme, const GradedDepth& depth, DamageMetrics& metrics) {
  const SeverityTable* const table = scheme.find(metrics.distress);
  metrics.severity_probabilities = {};
  metrics.severity = Severity::unknown;
  metrics.unit = table == nullptr ? DistressUnit::count : table->unit;
  metrics.quantity =
      table == nullptr ? 1 : table->quantity(metrics.area_m2.value, metrics.length_m, metrics.diameter_m);
  const double area_error = metrics.area_m2.std_error / metrics.area_m2.value;
  if (table != nullptr && !table->classes.empty()) {
    const Measurement diameter_m{metrics.diameter_m, 0.5 * metrics.diameter_m * area_error};
    metrics.severity_probabilities = depth.at_least
                                         ? probabilities_from(graded_depth(metrics).value, *table, diameter_m)
                                         : severity_probabilities(*table, graded_depth(metrics), diameter_m);
    metrics.severity = likely_severity(metrics.severity_probabilities);
    if (!is_known(metrics.area_m2)) metrics.severity = Severity::uncertain;
  }
  if (!depth.resolvable) metrics.severity = Severity::unresolvable;
}

std::string severity_text(const DamageMetrics& metrics) {
  if (metrics.severity == Severity::unknown) return "not graded";
  if (metrics.severity != Severity::uncertain) return name_of(metrics.severity);
  return is_known(metrics.area_m2) ? likely_severity_range(metrics.severity_probabilities) : "not graded";
}

}  // namespace roadstereo
