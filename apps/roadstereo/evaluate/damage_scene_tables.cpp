#include <algorithm>
#include <cmath>

#include "evaluate/damage_scenes.hpp"
#include "evaluate/scene_folders.hpp"
#include "finite_values.hpp"

namespace roadstereo::cli {
namespace {

bool is_resolvable(const SceneDamage& damage) {
  constexpr double min_std_errors = 3;
  constexpr std::size_t min_pixels = 64;
  return damage.pixels >= min_pixels && damage.depth_px > min_std_errors * damage.std_error_px;
}

bool is_comparable(const SceneDamage& damage) {
  return damage.found && damage.found->metrics && damage.fully_visible && damage.is_single &&
         !damage.found->cut_by_border && damage.truth.kind != "crack";
}

/// A rut is as deep in the picture as beyond it.
bool is_comparable_rut(const SceneDamage& damage) {
  return damage.found && damage.found->metrics && damage.is_single && damage.truth.kind == "rut";
}

/// Quantity of a damage, measured and true.
struct Quantity {
  const char* name;
  bool (*is_comparable)(const SceneDamage&);
  Measurement (*measured)(const DamageMetrics&);
  double (*truth)(const synth::DamageTruth&);
};

constexpr Quantity quantities[] = {
    {"maximum depth", is_comparable, [](const DamageMetrics& m) { return m.max_depth_m; },
     [](const synth::DamageTruth& t) { return t.depth_m; }},
    {"mean depth", is_comparable, [](const DamageMetrics& m) { return m.mean_depth_m; },
     [](const synth::DamageTruth& t) { return t.mean_depth_m; }},
    {"area", is_comparable, [](const DamageMetrics& m) { return m.area_m2; },
     [](const synth::DamageTruth& t) { return t.area_m2; }},
    {"volume", is_comparable, [](const DamageMetrics& m) { return m.volume_m3; },
     [](const synth::DamageTruth& t) { return t.volume_m3; }},
    {"depth of ruts", is_comparable_rut, [](const DamageMetrics& m) { return m.max_depth_m; },
     [](const synth::DamageTruth& t) { return t.depth_m; }},
};

std::vector<Cell> quantity_row(const Quantity& quantity, const SceneResults& results) {
  constexpr double min_depth_m = 0.020;
  constexpr double max_error_m = 0.002;
  constexpr double percent = 100;
  double count = 0;
  double within = 0;
  std::vector<double> errors;
  double precise = 0;
  double precise_errors = 0;
  for (const SceneDamage& damage : results.damages) {
    if (!quantity.is_comparable(damage)) continue;
    const DamageMetrics& metrics = *damage.found->metrics;
    const Measurement measured = quantity.measured(metrics);
    const double truth = quantity.truth(damage.truth);
    const double relative = measured.value / truth - 1;
    ++count;
    within += std::abs(measured.value - truth) <= 2 * measured.std_error ? 1 : 0;
    errors.push_back(relative);
    if (damage.truth.depth_m < min_depth_m || metrics.max_depth_m.std_error > max_error_m) continue;
    ++precise;
    precise_errors += std::abs(relative);
  }
  return {Cell(results.method),
          Cell(quantity.name),
          Cell(count, 0),
          Cell(percent * within / count, 1),
          Cell(percent * median(errors), 1),
          Cell(precise, 0),
          Cell(percent * precise_errors / precise, 1)};
}

void add_detection_rows(const SceneResults& results, Table& table) {
  double all = 0;
  double all_found = 0;
  for (const char* kind : scene_kinds) {
    double in_view = 0;
    double found = 0;
    double deep = 0;
    double deep_found = 0;
    for (const SceneDamage& damage : results.damages) {
      if (damage.truth.kind != kind) continue;
      ++in_view;
      found += damage.found ? 1 : 0;
      if (!is_resolvable(damage)) continue;
      ++deep;
      deep_found += damage.found ? 1 : 0;
    }
    if (in_view == 0) continue;
    table.rows.push_back({Cell(results.method), Cell(kind), Cell(in_view, 0), Cell(found, 0), Cell(deep, 0),
                          Cell(deep_found, 0), Cell(deep > 0 ? deep_found / deep : std::nan(""), 3)});
    if (std::string(kind) == "crack") continue;
    all += deep;
    all_found += deep_found;
  }
  table.rows.push_back({Cell(results.method), Cell("without cracks"), Cell(std::nan(""), 0), Cell(std::nan(""), 0),
                        Cell(all, 0), Cell(all_found, 0), Cell(all_found / all, 3)});
}

}  // namespace

Table detection_table(const std::vector<SceneResults>& results) {
  Table table{"Damage found",
              {{"method", "method"},
               {"kind", "kind"},
               {"in view", "in_view"},
               {"found", "found"},
               {"> 3 std. errors", "deeper_than_3_std_errors"},
               {"found", "found_of_those"},
               {"recall", "recall"}},
              {}};
  for (const SceneResults& of_method : results) add_detection_rows(of_method, table);
  return table;
}

Table measurement_table(const std::vector<SceneResults>& results) {
  Table table{"Measured against the truth: found potholes and bumps that are fully visible and do not merge",
              {{"method", "method"},
               {"quantity", "quantity"},
               {"count", "count"},
               {"within 2 std. errors %", "within_2_std_errors_percent"},
               {"median error %", "median_error_percent"},
               {"precise", "precise"},
               {"mean |error| %", "mean_abs_error_percent"}},
              {}};
  for (const SceneResults& of_method : results) {
    for (const Quantity& quantity : quantities) {
      const auto& damages = of_method.damages;
      if (std::any_of(damages.begin(), damages.end(), quantity.is_comparable)) {
        table.rows.push_back(quantity_row(quantity, of_method));
      }
    }
  }
  return table;
}

}  // namespace roadstereo::cli
