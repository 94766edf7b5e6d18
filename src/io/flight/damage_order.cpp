#include <algorithm>
#include <iterator>
#include <tuple>

#include "io/damage_colours.hpp"
#include "roadstereo/io/flight_inventory.hpp"

namespace roadstereo::io {
namespace {

/// Severity as a number; the expected class where none has more than half of the probability. What has no classes, such
/// as a bump, ranks as a depression of its depth.
double severity_rank(const Damage& damage) {
  static const SeverityScheme scheme = astm_d6433();
  const Severity severity = severity_of(damage);
  const auto rank = [](Severity of) { return static_cast<double>(of); };
  if (severity == Severity::unknown && damage.metrics) {
    const DamageMetrics& metrics = *damage.metrics;
    return rank(scheme.find(Distress::depression)->severity(metrics.max_depth_m.value, metrics.diameter_m));
  }
  if (severity != Severity::uncertain || !damage.metrics) return rank(severity);
  const SeverityProbabilities& of = damage.metrics->severity_probabilities;
  return of.minor * rank(Severity::minor) + of.low * rank(Severity::low) + of.medium * rank(Severity::medium) +
         of.high * rank(Severity::high);
}

}  // namespace

bool is_worse(const RoadDamage& one, const RoadDamage& other) {
  const auto rank = [](const RoadDamage& damage) {
    return std::tuple(-severity_rank(damage.best), -damage.best.max_depth().value, damage.id);
  };
  return rank(one) < rank(other);
}

std::vector<RoadDamage> worst_first(const std::vector<RoadDamage>& damages, bool candidates) {
  std::vector<RoadDamage> sorted;
  std::copy_if(damages.begin(), damages.end(), std::back_inserter(sorted),
               [candidates](const RoadDamage& damage) { return damage.candidate == candidates; });
  std::sort(sorted.begin(), sorted.end(), is_worse);
  return sorted;
}

}  // namespace roadstereo::io
