#include "map/map_results.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/degrees.hpp"
#include "io/csv.hpp"
#include "json_text.hpp"
#include "map/day_layers.hpp"
#include "map/map_values.hpp"
#include "map/rut_profiles.hpp"
#include "roadstereo/map_changes.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string damages_csv(const BuiltMap& built, const MapResults& results) {
  std::string text =
      "id,kind,x_m,y_m,max_depth_m,max_depth_stderr_m,mean_depth_m,mean_depth_stderr_m,area_m2,area_stderr_m2,"
      "volume_m3,volume_stderr_m3,length_m,width_m,angle_deg,distress,severity,confidence,sightings,passes,views,"
      "found_in_map,day\r\n";
  io::CsvLine line;
  for (std::size_t k = 0; k < results.damages.size(); ++k) {
    const RoadDamageRecord& damage = results.damages[k];
    const std::array<double, 2> at = in_crs(built, damage.best.at_m);
    const DamageMetrics& metrics = *damage.best.damage.metrics;
    line.add(damage.id).add(name_of(damage.best.damage.kind)).add(at[0], 3).add(at[1], 3);
    line.add(damage.max_depth_m, 6).add(damage.mean_depth_m, 6).add(damage.area_m2, 6).add(damage.volume_m3, 6);
    line.add(metrics.length_m, 4).add(metrics.width_m, 4).add(to_degrees(damage.best.length_angle_rad), 1);
    line.add(name_of(metrics.distress)).add(name_of(damage.severity)).add(damage.confidence, 3);
    line.add(damage.sightings).add(damage.passes).add(damage.views).add(damage.found_in_map ? 1 : 0);
    text += line.add(built.days[results.damage_days[k]].name).end();
  }
  return text;
}

std::string sighting_row(const BuiltMap& built, const DamageSighting& sighting) {
  const Damage& damage = sighting.found.damage;
  const DamageMetrics& metrics = *damage.metrics;
  const std::array<double, 2> at = in_crs(built, sighting.found.at_m);
  io::CsvLine line;
  line.add(sighting.pass).add(sighting.frame).add(name_of(damage.kind)).add(at[0], 3).add(at[1], 3);
  line.add(metrics.max_depth_m, 6).add(metrics.mean_depth_m, 6).add(metrics.area_m2, 6);
  return line.add(damage.confidence, 3).add(damage.cut_by_border ? 1 : 0).end();
}

std::string sightings_csv(const BuiltMap& built) {
  std::string text =
      "recording,frame,kind,x_m,y_m,max_depth_m,max_depth_stderr_m,mean_depth_m,mean_depth_stderr_m,area_m2,"
      "area_stderr_m2,confidence,cut_by_border\r\n";
  for (const DayMap& day : built.days) {
    for (const DamageSighting& sighting : day.sightings) text += sighting_row(built, sighting);
  }
  return text;
}

std::string transverse_csv(const BuiltMap& built, const MapResults& results) {
  const std::vector<LaneProfiles>& lanes = results.lanes;
  std::string text =
      "path,station_m,x_m,y_m,width_m,rut_depth_m,rut_depth_stderr_m,rut_noise_floor_m,rut_resolvable,cross_slope,"
      "cross_slope_stderr,in_damage\r\n";
  io::CsvLine line;
  for (std::size_t path = 0; path < lanes.size(); ++path) {
    for (const TransverseProfile& profile : lanes[path].transverse) {
      const std::array<double, 2> at = in_crs(built, profile.at_m);
      line.add(path).add(profile.station_m, 3).add(at[0], 3).add(at[1], 3).add(profile.width_m, 2);
      line.add(profile.rut_depth_m, 5).add(profile.rut_noise_floor_m, 5).add(profile.rut_resolvable ? 1 : 0);
      text += line.add(profile.cross_slope, 5).add(crosses_damage(profile, results.damages) ? 1 : 0).end();
    }
  }
  return text;
}

std::string longitudinal_csv(const BuiltMap& built, const std::vector<LaneProfiles>& lanes) {
  std::string text = "path,offset_m,station_m,x_m,y_m,height_m,height_stderr_m\r\n";
  io::CsvLine line;
  for (std::size_t path = 0; path < lanes.size(); ++path) {
    for (const LongitudinalPoint& point : lanes[path].longitudinal) {
      const std::array<double, 2> at = in_crs(built, point.at_m);
      line.add(path).add(point.offset_m, 3).add(point.station_m, 3).add(at[0], 3).add(at[1], 3);
      text += line.add(built.origin_m[2] + point.height_m, 5).add(point.sigma_m, 5).end();
    }
  }
  return text;
}

std::string roughness_csv(const std::vector<LaneProfiles>& lanes) {
  std::string text = "path,offset_m,start_m,length_m,index_m_km,noise_floor_m_km,resolvable\r\n";
  io::CsvLine line;
  for (std::size_t path = 0; path < lanes.size(); ++path) {
    for (const RoughnessSection& section : lanes[path].sections) {
      line.add(path).add(section.offset_m, 3).add(section.start_m, 2).add(section.length_m, 2);
      text += line.add(section.index_m_km, 3).add(section.noise_floor_m_km, 3).add(section.resolvable ? 1 : 0).end();
    }
  }
  return text;
}

Json damage_json(const BuiltMap& built, const RoadDamageRecord& damage) {
  const std::array<double, 2> at = in_crs(built, damage.best.at_m);
  return {{"id", damage.id},
          {"kind", name_of(damage.best.damage.kind)},
          {"x_m", json_number(at[0])},
          {"y_m", json_number(at[1])},
          {"max_depth_m", measurement_json(damage.max_depth_m)},
          {"mean_depth_m", measurement_json(damage.mean_depth_m)},
          {"area_m2", measurement_json(damage.area_m2)},
          {"volume_m3", measurement_json(damage.volume_m3)},
          {"distress", name_of(damage.best.damage.metrics->distress)},
          {"severity", name_of(damage.severity)},
          {"confidence", json_number(damage.confidence)},
          {"sightings", damage.sightings},
          {"recordings", damage.passes},
          {"views", damage.views},
          {"found_in_map", damage.found_in_map}};
}

std::string roughness_text(const std::vector<LaneProfiles>& lanes) {
  std::string text;
  for (const LaneProfiles& lane : lanes) {
    for (const RoughnessSection& section : lane.sections) {
      text += fmt::format("  roughness {:+.2f} m beside the path, {:.0f}–{:.0f} m: ", section.offset_m, section.start_m,
                          section.start_m + section.length_m);
      text += section.resolvable
                  ? fmt::format("{:.2f} m/km (noise floor {:.2f})\n", section.index_m_km, section.noise_floor_m_km)
                  : fmt::format("not resolvable with this rig, noise floor {:.2f} m/km\n", section.noise_floor_m_km);
    }
  }
  return text.empty() ? "  roughness no profile is 11.5 m long\n" : text;
}

/// Takes every damage as the newest day that lists it has it, unless a later one shows that it is gone; ids from 1,
/// deepest first.
void add_newest(const BuiltMap& built, const std::vector<std::vector<RoadDamageRecord>>& of_days, MapResults& results) {
  std::vector<std::pair<std::size_t, const RoadDamageRecord*>> newest;
  for (std::size_t day = 0; day < of_days.size(); ++day) {
    for (const RoadDamageRecord& record : of_days[day]) {
      bool superseded = false;
      for (std::size_t later = day + 1; later < built.days.size(); ++later) {
        superseded |= is_superseded(record, built.days[day].map, of_days[later], built.days[later].map);
      }
      if (!superseded) newest.emplace_back(day, &record);
    }
  }
  std::stable_sort(newest.begin(), newest.end(), [](const auto& a, const auto& b) {
    return a.second->max_depth_m.value > b.second->max_depth_m.value;
  });
  for (const auto& [day, record] : newest) {
    results.damage_days.push_back(day);
    results.damages.push_back(*record);
    results.damages.back().id = static_cast<int>(results.damages.size());
  }
}

}  // namespace

MapResults measure_map(const MapPlan& plan, const BuiltMap& built) {
  MapResults results;
  const DamageOptions& damage = plan.passes.front().options.damage;
  DamageOptions options = damage;
  options.min_confidence = 0;
  std::vector<std::vector<RoadDamageRecord>> of_days;
  for (const DayMap& day : built.days) {
    of_days.push_back(join_damage(day.sightings, find_map_damage(day.map, options, day.paths), day.map, damage));
    for (const auto& path : day.paths) results.lanes.push_back(measure_lane(day.map, path, {}));
  }
  results.changes = changes_between_days(built, of_days);
  add_newest(built, of_days, results);
  return results;
}

void add_map_tables(const BuiltMap& built, const MapResults& results, io::OutputFolder& folder) {
  folder.add("damages.csv", damages_csv(built, results));
  folder.add("sightings.csv", sightings_csv(built));
  folder.add("transverse.csv", transverse_csv(built, results));
  folder.add("longitudinal.csv", longitudinal_csv(built, results.lanes));
  folder.add("roughness.csv", roughness_csv(results.lanes));
  if (built.days.size() > 1) {
    folder.add("changes.csv", changes_csv(built, results.changes));
  } else {
    folder.remove("changes.csv");
  }
}

std::string map_json(const MapPlan& plan, const BuiltMap& built, const MapResults& results) {
  const MapBox bounds = bounds_of(built);
  const double cell_m = built.days.back().map.options().cell_m;
  Json document = {{"version", version},
                   {"crs", plan.crs},
                   {"frames", built.frames},
                   {"mapped", built.mapped},
                   {"cell_m", json_number(cell_m)},
                   {"west_m", json_number(built.origin_m[0] + bounds.i0 * cell_m)},
                   {"south_m", json_number(built.origin_m[1] + bounds.j0 * cell_m)},
                   {"width_m", json_number(bounds.columns * cell_m)},
                   {"length_m", json_number(bounds.rows * cell_m)},
                   {"frames_per_independent_view", json_number(built.days.back().map.view_factor())}};
  document["reasons"] = built.reasons;
  document["damages"] = Json::array();
  for (std::size_t k = 0; k < results.damages.size(); ++k) {
    document["damages"].push_back(damage_json(built, results.damages[k]));
    document["damages"].back()["day"] = built.days[results.damage_days[k]].name;
  }
  document["days"] = Json::array();
  for (const DayMap& day : built.days) document["days"].push_back(day.name);
  document["changes"] = changes_json(built, results.changes);
  return json_text(document);
}

std::string map_text(const MapPlan& plan, const BuiltMap& built, const MapResults& results) {
  const MapBox bounds = bounds_of(built);
  const double cell_m = built.days.back().map.options().cell_m;
  std::string text = fmt::format("roadstereo {}: map of {} recording{}\n", version, plan.passes.size(),
                                 plan.passes.size() == 1 ? "" : "s");
  text += fmt::format("  frames    {} with a pose, {} mapped\n", built.frames, built.mapped);
  text += fmt::format("  map       {:.1f} × {:.1f} m, cells of {:g} mm\n", bounds.columns * cell_m,
                      bounds.rows * cell_m, 1000 * cell_m);
  std::size_t sightings = 0;
  for (const DayMap& day : built.days) sightings += day.sightings.size();
  text += fmt::format("  damage    {} damages from {} sightings\n", results.damages.size(), sightings);
  constexpr double mm = 1000;
  for (const RoadDamageRecord& damage : results.damages) {
    const std::array<double, 2> at = in_crs(built, damage.best.at_m);
    text += fmt::format(
        "    {:>3} {:<10} at {:.2f}, {:.2f} m: {:.1f} ± {:.1f} mm, {:.3f} ± {:.3f} m², {} sightings, {:.2f}\n",
        damage.id, name_of(damage.best.damage.kind), at[0], at[1], mm * damage.max_depth_m.value,
        mm * damage.max_depth_m.std_error, damage.area_m2.value, damage.area_m2.std_error, damage.sightings,
        damage.confidence);
  }
  text += changes_text(built, results.changes);
  text += rut_text(results.lanes, results.damages) + roughness_text(results.lanes);
  for (const std::string& reason : built.reasons) text += fmt::format("  no result {}\n", reason);
  return text + fmt::format("  output    {}\n", plan.output.string());
}

}  // namespace roadstereo::cli
