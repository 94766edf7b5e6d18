#include "roadstereo/severity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "roadstereo/error.hpp"

namespace roadstereo {

const char* name_of(Distress distress) {
  switch (distress) {
    case Distress::pothole:
      return "pothole";
    case Distress::depression:
      return "depression";
    case Distress::rut:
      return "rut";
    case Distress::crack:
      return "crack";
    case Distress::bump:
      return "bump";
    case Distress::debris:
      return "debris";
    case Distress::kerb_step:
      return "kerb step";
    case Distress::unknown:
      break;
  }
  return "unknown";
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

const char* name_of(DistressUnit unit) {
  switch (unit) {
    case DistressUnit::square_metre:
      return "m2";
    case DistressUnit::metre:
      return "m";
    case DistressUnit::count:
      break;
  }
  return "count";
}

namespace {

constexpr std::array<Severity, 4> graded{Severity::minor, Severity::low, Severity::medium, Severity::high};
/// Probabilities of the intervals between ascending limits, for a normal distribution; the first is below all limits.
std::vector<double> interval_probabilities(const Measurement& measured, const std::vector<double>& limits) {
  std::vector<double> probabilities;
  double below = 0;
  for (const double limit : limits) {
    const double distance = limit - measured.value;
    const double next = measured.std_error > 0 ? 0.5 * std::erfc(-distance / (std::sqrt(2.0) * measured.std_error))
                                               : (distance > 0 ? 1.0 : 0.0);
    probabilities.push_back(next - below);
    below = next;
  }
  probabilities.push_back(1 - below);
  return probabilities;
}

/// Number of limits that the value has passed. The first limit belongs to the interval above it, the others to that
/// below: "13–25, over 25 mm".
std::size_t interval(double value, const std::vector<double>& limits) {
  if (limits.empty() || !(value >= limits.front())) return 0;
  return 1 + static_cast<std::size_t>(
                 std::count_if(limits.begin() + 1, limits.end(), [value](double limit) { return value > limit; }));
}

void require_ascending(const std::string& where, const char* name, const std::vector<double>& limits) {
  double last = 0;
  for (const double limit : limits) {
    if (!(limit > last) || !std::isfinite(limit)) {
      fail(where, ": ", name, " has ", limit, " after ", last, "; the limits must be positive and ascend");
    }
    last = limit;
  }
}

void validate_table(const std::string& where, const SeverityTable& table) {
  require_ascending(where, "depth", table.depths_m);
  require_ascending(where, "diameter", table.diameters_m);
  if (table.classes.size() != table.depths_m.size()) {
    fail(where, ": there are ", table.classes.size(), " rows of severities; there must be one for each of the ",
         table.depths_m.size(), " depths");
  }
  const std::size_t columns = std::max<std::size_t>(1, table.diameters_m.size());
  for (const std::vector<Severity>& row : table.classes) {
    if (row.size() != columns) {
      fail(where, ": a row has ", row.size(), " severities; it must have ", columns, ", one for each diameter");
    }
    for (const Severity severity : row) {
      if (std::find(graded.begin() + 1, graded.end(), severity) != graded.end()) continue;
      fail(where, ": '", name_of(severity), "' is no class of a table; the classes are low, medium and high");
    }
  }
  if (!(table.max_counted_m > 0) || !(table.area_of_one_m2 > 0)) {
    fail(where, ": the counted diameter is ", table.max_counted_m, " m and the area of one ", table.area_of_one_m2,
         " m²; they must be greater than 0");
  }
}

}  // namespace

Severity SeverityTable::severity(double depth_m, double diameter_m) const {
  if (classes.empty()) return Severity::unknown;
  const std::size_t row = interval(depth_m, depths_m);
  const std::size_t column = diameters_m.empty() ? 1 : interval(diameter_m, diameters_m);
  return row == 0 || column == 0 ? Severity::minor : classes[row - 1][column - 1];
}

double SeverityTable::quantity(double area_m2, double length_m, double diameter_m) const {
  if (unit == DistressUnit::square_metre) return area_m2;
  if (unit == DistressUnit::metre) return length_m;
  return diameter_m > max_counted_m ? area_m2 / area_of_one_m2 : 1;
}

const SeverityTable* SeverityScheme::find(Distress distress) const {
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [&](const SeverityTable& table) { return table.distress == distress; });
  return found == tables.end() ? nullptr : &*found;
}

void SeverityScheme::validate() const {
  for (const SeverityTable& table : tables) {
    const std::string where = "severity scheme " + name + ", " + name_of(table.distress);
    validate_table(where, table);
    if (find(table.distress) != &table) fail(where, ": there are two tables");
  }
}

SeverityScheme astm_d6433() {
  using enum Severity;
  const std::vector<std::vector<Severity>> by_depth{{low}, {medium}, {high}};
  SeverityScheme scheme{"ASTM D6433", {}};
  scheme.tables.push_back({Distress::pothole,
                           DistressUnit::count,
                           {0.013, 0.025, 0.050},
                           {0.1, 0.2, 0.45},
                           {{low, low, medium}, {low, medium, high}, {medium, medium, high}},
                           0.75});
  scheme.tables.push_back({Distress::rut, DistressUnit::square_metre, {0.006, 0.013, 0.025}, {}, by_depth});
  scheme.tables.push_back({Distress::depression, DistressUnit::square_metre, {0.013, 0.025, 0.050}, {}, by_depth});
  scheme.tables.push_back({Distress::kerb_step, DistressUnit::metre, {0.025, 0.050, 0.100}, {}, by_depth});
  scheme.tables.push_back({Distress::bump, DistressUnit::metre, {}, {}, {}});
  scheme.tables.push_back({Distress::crack, DistressUnit::metre, {}, {}, {}});
  return scheme;
}

SeverityProbabilities severity_probabilities(const SeverityTable& table, const Measurement& depth_m,
                                             const Measurement& diameter_m) {
  if (table.classes.empty()) return {};
  const std::vector<double> rows = interval_probabilities(depth_m, table.depths_m);
  std::vector<double> columns{0, 1};
  if (!table.diameters_m.empty()) columns = interval_probabilities(diameter_m, table.diameters_m);
  SeverityProbabilities result;
  result.minor = rows[0] + (1 - rows[0]) * columns[0];
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (std::size_t j = 1; j < columns.size(); ++j) {
      const double probability = rows[i] * columns[j];
      const Severity severity = table.classes[i - 1][j - 1];
      if (severity == Severity::low) result.low += probability;
      if (severity == Severity::medium) result.medium += probability;
      if (severity == Severity::high) result.high += probability;
    }
  }
  return result;
}

namespace {

constexpr double majority = 0.5;

std::array<double, 4> in_order(const SeverityProbabilities& probabilities) {
  return {probabilities.minor, probabilities.low, probabilities.medium, probabilities.high};
}

}  // namespace

Severity likely_severity(const SeverityProbabilities& probabilities) {
  const std::array<double, 4> classes = in_order(probabilities);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] > majority) return graded[i];
  }
  return Severity::uncertain;
}

std::string likely_severity_range(const SeverityProbabilities& probabilities) {
  const std::array<double, 4> classes = in_order(probabilities);
  for (std::size_t width = 1; width <= classes.size(); ++width) {
    std::size_t best = 0;
    double most = 0;
    for (std::size_t first = 0; first + width <= classes.size(); ++first) {
      double sum = 0;
      for (std::size_t i = first; i < first + width; ++i) sum += classes[i];
      if (sum > most) best = first;
      most = std::max(most, sum);
    }
    if (most <= majority) continue;
    const std::string lowest = name_of(graded[best]);
    return width == 1 ? lowest : lowest + "–" + name_of(graded[best + width - 1]);
  }
  return name_of(Severity::unknown);
}

}  // namespace roadstereo
