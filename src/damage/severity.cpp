#include <array>
#include <cmath>

#include "roadstereo/damage.hpp"

namespace roadstereo {

const char* name_of(DamageKind kind) {
  return kind == DamageKind::depression ? "depression" : "protrusion";
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::unresolvable:
      return "unresolvable";
    case Severity::uncertain:
      return "uncertain";
    case Severity::minor:
      return "minor";
    case Severity::low:
      return "low";
    case Severity::medium:
      return "medium";
    case Severity::high:
      return "high";
    case Severity::unknown:
      break;
  }
  return "unknown";
}

namespace {

using enum Severity;
constexpr std::array<double, 3> depths_m{0.013, 0.025, 0.050}, diameters_m{0.1, 0.2, 0.45};
constexpr std::array<std::array<Severity, 4>, 4> table{{{minor, minor, minor, minor},
                                                        {minor, low, low, medium},
                                                        {minor, low, medium, high},
                                                        {minor, medium, medium, high}}};

/// Probabilities of the four intervals between three limits, for a normal distribution.
std::array<double, 4> interval_probabilities(const Measurement& measured, const std::array<double, 3>& limits) {
  std::array<double, 4> probabilities{};
  double below = 0;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    const double distance = limits[k] - measured.value;
    const double next = measured.std_error > 0 ? 0.5 * std::erfc(-distance / (std::sqrt(2.0) * measured.std_error))
                                               : (distance > 0 ? 1.0 : 0.0);
    probabilities[k] = next - below;
    below = next;
  }
  probabilities.back() = 1 - below;
  return probabilities;
}

}  // namespace

Severity astm_severity(double depth_m, double diameter_m) {
  if (!(depth_m >= depths_m[0]) || !(diameter_m >= diameters_m[0])) return minor;
  const std::size_t row = depth_m > depths_m[2] ? 3 : depth_m > depths_m[1] ? 2 : 1;
  const std::size_t column = diameter_m > diameters_m[2] ? 3 : diameter_m > diameters_m[1] ? 2 : 1;
  return table[row][column];
}

SeverityProbabilities severity_probabilities(const Measurement& depth_m, const Measurement& diameter_m) {
  const std::array<double, 4> rows = interval_probabilities(depth_m, depths_m);
  const std::array<double, 4> columns = interval_probabilities(diameter_m, diameters_m);
  SeverityProbabilities result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const double probability = rows[i] * columns[j];
      switch (table[i][j]) {
        case low:
          result.low += probability;
          break;
        case medium:
          result.medium += probability;
          break;
        case high:
          result.high += probability;
          break;
        default:
          result.minor += probability;
      }
    }
  }
  return result;
}

Severity likely_severity(const SeverityProbabilities& probabilities) {
  constexpr double majority = 0.5;
  if (probabilities.minor > majority) return minor;
  if (probabilities.low > majority) return low;
  if (probabilities.medium > majority) return medium;
  if (probabilities.high > majority) return high;
  return uncertain;
}

}  // namespace roadstereo
