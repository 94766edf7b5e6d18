#include "io/damage_columns.hpp"

#include <cmath>

#include "core/degrees.hpp"
#include "io/damage_colours.hpp"

namespace roadstereo::io {
namespace {

DamageValue number(double value) {
  if (!std::isfinite(value)) return std::monostate{};
  return value;
}

DamageValue count(std::size_t value) {
  return static_cast<std::int64_t>(value);
}

template <auto Member>
DamageValue metric(const Damage& damage) {
  if (!damage.metrics) return std::monostate{};
  return number((*damage.metrics).*Member);
}

template <auto Member>
DamageValue metric_value(const Damage& damage) {
  if (!damage.metrics) return std::monostate{};
  return number(((*damage.metrics).*Member).value);
}

template <auto Member>
DamageValue metric_error(const Damage& damage) {
  if (!damage.metrics) return std::monostate{};
  return number(((*damage.metrics).*Member).std_error);
}

template <auto Member, std::size_t Index>
DamageValue metric_part(const Damage& damage) {
  if (!damage.metrics) return std::monostate{};
  return number(((*damage.metrics).*Member)[Index]);
}

template <auto Member>
DamageValue probability(const Damage& damage) {
  if (!damage.metrics) return std::monostate{};
  return number(damage.metrics->severity_probabilities.*Member);
}

template <auto Member>
DamageValue evidence(const Damage& damage) {
  return number(damage.evidence.*Member);
}

template <auto Member, std::size_t Index>
DamageValue pixel(const Damage& damage) {
  return static_cast<std::int64_t>((damage.*Member)[Index]);
}

struct AddCell {
  CsvLine& line;
  void operator()(std::monostate) const { line.add_nothing(); }
  template <class Value>
  void operator()(const Value& value) const {
    line.add(value);
  }
};

std::vector<DamageColumn> identity_columns() {
  return {{"id", [](const Damage& d) -> DamageValue { return std::int64_t{d.id}; }},
          {"kind", [](const Damage& d) -> DamageValue { return std::string(name_of(d.kind)); }},
          {"distress", [](const Damage& d) -> DamageValue { return std::string(name_of(distress_of(d))); }},
          {"severity", [](const Damage& d) -> DamageValue { return std::string(name_of(severity_of(d))); }},
          {"confidence", [](const Damage& d) { return number(d.confidence); }}};
}

std::vector<DamageColumn> metric_columns() {
  using M = DamageMetrics;
  return {{"area_m2", metric_value<&M::area_m2>},
          {"area_m2_stderr", metric_error<&M::area_m2>},
          {"max_depth_m", metric_value<&M::max_depth_m>},
          {"max_depth_m_stderr", metric_error<&M::max_depth_m>},
          {"mean_depth_m", metric_value<&M::mean_depth_m>},
          {"mean_depth_m_stderr", metric_error<&M::mean_depth_m>},
          {"volume_m3", metric_value<&M::volume_m3>},
          {"volume_m3_stderr", metric_error<&M::volume_m3>},
          {"length_m", metric<&M::length_m>},
          {"width_m", metric<&M::width_m>},
          {"angle_deg",
           [](const Damage& d) -> DamageValue {
             if (!d.metrics) return std::monostate{};
             return number(to_degrees(d.metrics->angle_rad));
           }},
          {"diameter_m", metric<&M::diameter_m>},
          {"wall_slope", metric<&M::wall_slope>},
          {"quantity", metric<&M::quantity>},
          {"unit",
           [](const Damage& d) -> DamageValue {
             if (!d.metrics) return std::monostate{};
             return std::string(name_of(d.metrics->unit));
           }},
          {"centroid_x_m", metric_part<&M::centroid_m, 0>},
          {"centroid_y_m", metric_part<&M::centroid_m, 1>},
          {"centroid_z_m", metric_part<&M::centroid_m, 2>},
          {"road_x_m", metric_part<&M::road_centroid_m, 0>},
          {"road_y_m", metric_part<&M::road_centroid_m, 1>},
          {"distance_m", metric<&M::distance_m>},
          {"resolvable_depth_m", metric<&M::resolvable_depth_m>},
          {"severity_range",
           [](const Damage& d) -> DamageValue {
             if (!d.metrics) return std::monostate{};
             return severity_text(*d.metrics);
           }},
          {"p_minor", probability<&SeverityProbabilities::minor>},
          {"p_low", probability<&SeverityProbabilities::low>},
          {"p_medium", probability<&SeverityProbabilities::medium>},
          {"p_high", probability<&SeverityProbabilities::high>}};
}

std::vector<DamageColumn> pixel_columns() {
  return {{"pixels", [](const Damage& d) { return count(d.pixels); }},
          {"measured_share", [](const Damage& d) { return number(d.measured_share); }},
          {"centroid_u_px", [](const Damage& d) { return number(d.centroid_px[0]); }},
          {"centroid_v_px", [](const Damage& d) { return number(d.centroid_px[1]); }},
          {"box_u0_px", pixel<&Damage::box_px, 0>},
          {"box_v0_px", pixel<&Damage::box_px, 1>},
          {"box_u1_px", pixel<&Damage::box_px, 2>},
          {"box_v1_px", pixel<&Damage::box_px, 3>},
          {"deepest_u_px", pixel<&Damage::deepest_px, 0>},
          {"deepest_v_px", pixel<&Damage::deepest_px, 1>},
          {"max_depth_px", [](const Damage& d) { return number(d.max_depth_px.value); }},
          {"max_depth_px_stderr", [](const Damage& d) { return number(d.max_depth_px.std_error); }},
          {"mean_depth_px", [](const Damage& d) { return number(d.mean_depth_px); }},
          {"contrast_sigmas", evidence<&DamageEvidence::contrast_sigmas>},
          {"significance", evidence<&DamageEvidence::significance>},
          {"steepness", evidence<&DamageEvidence::steepness>},
          {"road_share", evidence<&DamageEvidence::road_share>},
          {"border_share", evidence<&DamageEvidence::border_share>},
          {"unseen_share", evidence<&DamageEvidence::unseen_share>},
          {"surface_significance", evidence<&DamageEvidence::surface_significance>},
          {"range_vote", evidence<&DamageEvidence::range_vote>},
          {"specular_excess", evidence<&DamageEvidence::specular_excess>},
          {"texture_share", evidence<&DamageEvidence::texture_share>},
          {"pixel_significance", evidence<&DamageEvidence::pixel_significance>},
          {"likely_wall_slope", evidence<&DamageEvidence::likely_wall_slope>},
          {"extent", evidence<&DamageEvidence::extent>},
          {"rut_significance", evidence<&DamageEvidence::rut_significance>},
          {"clutter", evidence<&DamageEvidence::clutter>},
          {"depth_significance", evidence<&DamageEvidence::depth_significance>},
          {"cut_by_border", [](const Damage& d) -> DamageValue { return d.cut_by_border; }},
          {"ends_search", [](const Damage& d) -> DamageValue { return d.ends_search; }}};
}

}  // namespace

const std::vector<DamageColumn>& damage_columns() {
  static const std::vector<DamageColumn> columns = [] {
    std::vector<DamageColumn> all = identity_columns();
    for (const auto& part : {metric_columns(), pixel_columns()}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return columns;
}

void add_damage_names(CsvLine& line) {
  for (const DamageColumn& column : damage_columns()) line.add(column.name);
}

void add_damage_cells(const Damage& damage, CsvLine& line) {
  for (const DamageColumn& column : damage_columns()) std::visit(AddCell{line}, column.value(damage));
}

}  // namespace roadstereo::io
