#pragma once

#include <limits>
#include <string>
#include <vector>

#include "roadstereo/measurement.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Kind of damage by its measured shape, in the words of ASTM D6433.
enum class Distress {
  unknown,     ///< no calibration
  pothole,     ///< below the road, with steep walls
  depression,  ///< below the road, with gentle walls
  rut,         ///< a depression that is long and runs along the road
  crack,       ///< below the road, long, narrower than a pothole
  bump,        ///< above the road, with gentle walls: bump or heave
  debris,      ///< above the road, with steep walls
  kerb_step    ///< a step along the road that reaches the side of the image: kerb or edge of the carriageway
};
const char* name_of(Distress distress);

/// Severity of a damage by a table of its distress.
enum class Severity {
  unknown,       ///< no calibration, no table with classes for this distress in the scheme, or the depth cannot be
                 ///< trusted
  unresolvable,  ///< neither the largest nor the mean depth is three standard errors of its noise
  uncertain,     ///< no class has more than half of the probability, the area is uncertain by more than ±50 %, or the
                 ///< depth is a lower bound and a greater one has another class
  minor,         ///< below the table
  low,
  medium,
  high
};
const char* name_of(Severity severity);

/// Unit in which a distress is counted.
enum class DistressUnit { count, square_metre, metre };
/// Return "count", "m2" or "m".
const char* name_of(DistressUnit unit);

/// Probability of each class of severity, 0 … 1; they sum to 1, or are all 0 if there are no classes.
struct SeverityProbabilities {
  double minor = 0, low = 0, medium = 0, high = 0;
};

/// Classes of one distress by depth and mean diameter.
struct SeverityTable {
  Distress distress = Distress::pothole;
  DistressUnit unit = DistressUnit::count;
  std::vector<double> depths_m;     ///< ascending lower limits of the rows; empty: there are no classes
  std::vector<double> diameters_m;  ///< ascending lower limits of the columns; empty: the depth alone decides
  std::vector<std::vector<Severity>> classes;                      ///< low, medium or high by row and column
  double max_counted_m = std::numeric_limits<double>::infinity();  ///< diameter, metres, above which a damage counts by
                                                                   ///< its area
  double area_of_one_m2 = 0.5;                                     ///< area that counts as one damage, m²

  /// Look up a class. Values below the first limits, and NaN, give `minor`; a table without classes `unknown`.
  Severity severity(double depth_m, double diameter_m) const;
  /// Return the amount in `unit`.
  double quantity(double area_m2, double length_m, double diameter_m) const;
};

/// Tables of severities.
struct SeverityScheme {
  std::string name;
  std::vector<SeverityTable> tables;  ///< at most one for each distress

  /// Return the table of a distress; null if there is none.
  const SeverityTable* find(Distress distress) const;
  /// Throws Error naming the first table and limit that is out of order or out of range.
  void validate() const;
};

/// Return the tables of ASTM D6433 for asphalt. Potholes: by depth 13, 25, 50 mm and mean diameter 100, 200, 450 mm,
/// those wider than 750 mm by the area over 0.5 m². Ruts: by mean depth 6, 13, 25 mm, m². Depressions: 13, 25, 50 mm,
/// m². Kerb steps, as lane/shoulder drop-off: 25, 50, 100 mm, m. Bumps (m) are graded by ride quality and wide cracks
/// (m) by a width that the support window hides: both have no classes.
SeverityScheme astm_d6433();

/// Integrate a table over normal distributions of depth and mean diameter.
SeverityProbabilities severity_probabilities(const SeverityTable& table, const Measurement& depth_m,
                                             const Measurement& diameter_m);

/// The class of more than half of the probability; `uncertain` if there is none.
Severity likely_severity(const SeverityProbabilities& probabilities);

/// Return the shortest range of classes that has more than half of the probability, e.g. "medium–high"; "unknown" if
/// all are 0.
std::string likely_severity_range(const SeverityProbabilities& probabilities);

}  // namespace roadstereo
#pragma GCC visibility pop
