// Tables of severities against the printed ones of ASTM D6433, quantities, ranges of classes.

#include <gtest/gtest.h>

#include "damage/distress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/severity.hpp"

namespace roadstereo {
namespace {

const SeverityTable& table_of(Distress distress) {
  static const SeverityScheme scheme = astm_d6433();
  return *scheme.find(distress);
}

/// TM 5-623 and D6433: rutting 6–13, 13–25, > 25 mm; depressions 13–25, 25–50, > 50 mm; drop-off 25–50, 50–100, > 100
/// mm.
TEST(AstmD6433, DepthClasses) {
  struct Case {
    Distress distress;
    double minor, low, medium, high;  // mm inside each class
  };
  for (const Case& one : {Case{Distress::rut, 5.9, 6, 13.1, 25.1}, Case{Distress::depression, 12.9, 25, 26, 51},
                          Case{Distress::kerb_step, 24, 26, 100, 101}}) {
    const SeverityTable& table = table_of(one.distress);
    EXPECT_EQ(table.severity(one.minor / 1000, 1), Severity::minor) << name_of(one.distress);
    EXPECT_EQ(table.severity(one.low / 1000, 1), Severity::low) << name_of(one.distress);
    EXPECT_EQ(table.severity(one.medium / 1000, 1), Severity::medium) << name_of(one.distress);
    EXPECT_EQ(table.severity(one.high / 1000, 1), Severity::high) << name_of(one.distress);
  }
  EXPECT_EQ(table_of(Distress::bump).severity(0.1, 1), Severity::unknown);
}

TEST(AstmD6433, PotholesByDepthAndDiameter) {
  const SeverityTable& potholes = table_of(Distress::pothole);
  EXPECT_EQ(potholes.severity(0.0129, 0.5), Severity::minor);
  EXPECT_EQ(potholes.severity(0.06, 0.099), Severity::minor);
  EXPECT_EQ(potholes.severity(0.02, 0.15), Severity::low);
  EXPECT_EQ(potholes.severity(0.02, 0.3), Severity::low);
  EXPECT_EQ(potholes.severity(0.02, 0.6), Severity::medium);
  EXPECT_EQ(potholes.severity(0.04, 0.15), Severity::low);
  EXPECT_EQ(potholes.severity(0.04, 0.3), Severity::medium);
  EXPECT_EQ(potholes.severity(0.04, 0.6), Severity::high);
  EXPECT_EQ(potholes.severity(0.06, 0.15), Severity::medium);
  EXPECT_EQ(potholes.severity(0.06, 0.3), Severity::medium);
  EXPECT_EQ(potholes.severity(0.06, 0.6), Severity::high);
}

TEST(AstmD6433, WidePotholesCountByArea) {
  const SeverityTable& potholes = table_of(Distress::pothole);
  EXPECT_EQ(potholes.quantity(0.1, 0.4, 0.36), 1);
  EXPECT_EQ(potholes.quantity(0.44, 0.75, 0.75), 1);
  EXPECT_DOUBLE_EQ(potholes.quantity(1.5, 1.4, 1.38), 3);  // 1.5 m² / 0.5 m²
  EXPECT_EQ(potholes.severity(0.025, 1.4), Severity::medium);
  EXPECT_EQ(potholes.severity(0.026, 1.4), Severity::high);
  EXPECT_EQ(table_of(Distress::rut).quantity(1.5, 4, 1.38), 1.5);
  EXPECT_EQ(table_of(Distress::kerb_step).quantity(1.5, 4, 1.38), 4);
}

TEST(SeverityRange, IsShortestWithMajority) {
  EXPECT_EQ(likely_severity_range({0, 0.1, 0.6, 0.3}), "medium");
  EXPECT_EQ(likely_severity_range({0, 0.1, 0.45, 0.45}), "medium–high");
  EXPECT_EQ(likely_severity_range({0.3, 0.3, 0.2, 0.2}), "minor–low");
  EXPECT_EQ(likely_severity_range({0.42, 0.08, 0.1, 0.4}), "minor–medium") << "two neighbours have half, not more";
}

DamageMetrics pothole(double depth_m, double depth_error_m, double area_m2, double area_error_m2) {
  DamageMetrics metrics;
  metrics.distress = Distress::pothole;
  metrics.max_depth_m = {depth_m, depth_error_m};
  metrics.mean_depth_m = {0.5 * depth_m, depth_error_m};
  metrics.area_m2 = {area_m2, area_error_m2};
  metrics.diameter_m = 0.3;
  return metrics;
}

/// 46 mm ± 9 mm, 300 mm wide: Φ((50 − 46) / 9) − Φ((25 − 46) / 9) = 0.671639 − 0.009815 are medium, the rest high.
TEST(Grade, NeedsMajorityAndKnownSize) {
  DamageMetrics metrics = pothole(0.046, 0.009, 0.07, 0.001);
  grade(astm_d6433(), {true}, metrics);
  EXPECT_EQ(metrics.severity, Severity::medium);
  EXPECT_NEAR(metrics.severity_probabilities.medium, 0.671639 - 0.009815 + 0.328361, 1e-3) << ">50 mm is medium, too";
  EXPECT_EQ(severity_text(metrics), "medium");
  metrics = pothole(0.046, 0.009, 0.07, 0.07 * 0.98);
  grade(astm_d6433(), {true}, metrics);
  EXPECT_EQ(metrics.severity, Severity::uncertain) << "an area known to ±98 %";
  EXPECT_EQ(severity_text(metrics), "not graded");
  // Known to ±59 %, but potholes 500 mm wide are high from 25 mm on: Φ((25 − 82) / 48) = 0.1175.
  metrics = pothole(0.082, 0.048, 0.2, 0.001);
  metrics.diameter_m = 0.5;
  grade(astm_d6433(), {true}, metrics);
  EXPECT_NEAR(metrics.severity_probabilities.high, 1 - 0.1175, 1e-3);
  EXPECT_EQ(severity_text(metrics), "high");
  EXPECT_EQ(metrics.unit, DistressUnit::count);
  EXPECT_EQ(metrics.quantity, 1);
  grade(astm_d6433(), {false}, metrics);
  EXPECT_EQ(metrics.severity, Severity::unresolvable);
}

/// Potholes 300 mm wide are low from 13 mm, medium from 25 mm on.
TEST(Grade, LowerBoundHasTheSeverityOfAllThatIsDeeper) {
  DamageMetrics metrics = pothole(0.02, 0.02, 0.07, 0.001);
  grade(astm_d6433(), {true, true}, metrics);
  EXPECT_EQ(metrics.severity, Severity::uncertain) << "low, but medium if it is deeper than 25 mm";
  EXPECT_EQ(severity_text(metrics), "low–medium");
  metrics = pothole(0.1, 0.1, 0.07, 0.001);
  grade(astm_d6433(), {true, true}, metrics);
  EXPECT_EQ(metrics.severity, Severity::medium);
  EXPECT_EQ(severity_text(metrics), "medium");
  metrics.area_m2.std_error = 0.07 * 0.98;
  grade(astm_d6433(), {true, true}, metrics);
  EXPECT_EQ(metrics.severity, Severity::uncertain) << "an area known to ±98 %";
}

TEST(Grade, DistressWithoutClassesIsNotGraded) {
  DamageMetrics bump = pothole(0.04, 0.001, 0.2, 0.01);
  bump.distress = Distress::bump;
  bump.length_m = 0.7;
  grade(astm_d6433(), {true}, bump);
  EXPECT_EQ(bump.severity, Severity::unknown);
  EXPECT_EQ(bump.quantity, 0.7);
  EXPECT_EQ(severity_text(bump), "not graded");
}

/// The mean rut depth, not the maximum: 10 mm of a parabola is a mean of 6.7 mm over its width.
TEST(Grade, RutsByMeanDepth) {
  DamageMetrics rut = pothole(0.016, 0.0001, 0.8, 0.01);
  rut.distress = Distress::rut;
  rut.mean_depth_m = {0.02 / 3, 0.0001};
  grade(astm_d6433(), {true}, rut);
  EXPECT_EQ(rut.severity, Severity::low);
  EXPECT_EQ(rut.quantity, 0.8);
}

TEST(SeverityScheme, RejectsBadTables) {
  SeverityScheme scheme{"own", {{Distress::pothole, DistressUnit::count, {0.04, 0.1}, {}, {{Severity::high}}}}};
  EXPECT_THROW(scheme.validate(), Error) << "two depths, one row";
  scheme.tables[0].classes = {{Severity::low}, {Severity::high}};
  EXPECT_NO_THROW(scheme.validate());
  for (const Severity none : {Severity::minor, Severity::unknown, Severity::unresolvable, Severity::uncertain}) {
    SeverityScheme other = scheme;
    other.tables[0].classes[1] = {none};
    EXPECT_THROW(other.validate(), Error) << name_of(none);
  }
  scheme.tables[0].depths_m = {0.1, 0.04};
  EXPECT_THROW(scheme.validate(), Error);
  scheme.tables[0].depths_m = {0.04, 0.1};
  scheme.tables.push_back(scheme.tables[0]);
  EXPECT_THROW(scheme.validate(), Error) << "two tables of one distress";
}

}  // namespace
}  // namespace roadstereo
