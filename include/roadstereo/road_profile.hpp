#pragma once

#include <array>
#include <span>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/road_map.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

struct LaneOptions {
  double lane_width_m = 3.0;    ///< of transverse profiles, centred on the path, 0.5 … 20
  double wheel_path_m = 0.75;   ///< distance of the wheel paths from the path, 0 … 5
  double station_m = 0.5;       ///< distance of transverse profiles, 0.1 … 100
  double average_m = 0.3;       ///< length of road that a transverse profile is averaged over, 0.01 … 10
  double strip_m = 0.1;         ///< width of a longitudinal profile, 0.01 … 2
  double straightedge_m = 2.0;  ///< length of the straightedge, 0.5 … 10
  double section_m = 20;        ///< length of a section with one roughness index, 11.5 … 1000
  double max_gap_m = 0.25;      ///< longest gap of a profile that is interpolated, 0 … 5

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Returns the largest gap, metres, between a profile and a straightedge that rests on it: the depth below the upper
/// hull of every window of that length. NaN heights are missing values. 0 with fewer than three heights.
double straightedge_gap(std::span<const double> heights_m, double spacing_m, double straightedge_m);

/// Returns the mean gap of a flat profile whose heights have independent errors with a standard deviation of 1, by
/// simulation; in the unit of that deviation.
double straightedge_noise_gap(std::size_t heights, double spacing_m, double straightedge_m);

/// Heights across the lane, from left to right.
struct TransverseProfile {
  double station_m = 0;          ///< along the path
  std::array<double, 2> at_m{};  ///< of the path, in the map
  double heading_rad = 0;        ///< of the path, from the map's x axis
  double width_m = 0;            ///< that is measured
  Measurement rut_depth_m;       ///< largest gap below the straightedge
  double rut_noise_floor_m = 0;  ///< gap that noise alone makes
  bool rut_resolvable = false;   ///< whether the rut is deeper than twice the floor
  Measurement cross_slope;       ///< to the right, positive where the right is lower
};

/// Heights along the lane and their roughness.
struct RoughnessSection {
  double offset_m = 0;  ///< from the path, to the right
  double start_m = 0;   ///< along the path
  double length_m = 0;
  double index_m_km = 0;  ///< International Roughness Index
  double noise_floor_m_km = 0;
  bool resolvable = false;  ///< whether the floor is at most 0.3 of the index
};

struct LongitudinalPoint {
  double offset_m = 0;  ///< from the path, to the right
  double station_m = 0;
  std::array<double, 2> at_m{};
  double height_m = 0;  ///< NaN: gap
  double sigma_m = 0;
};

/// Profiles of a lane.
struct LaneProfiles {
  std::vector<TransverseProfile> transverse;
  std::vector<LongitudinalPoint> longitudinal;  ///< of both wheel paths and the path, one after another
  double spacing_m = 0;                         ///< of the longitudinal profiles
  std::vector<RoughnessSection> sections;
};

/// Splits a path, metres, into parts that lead forward. Points behind the end of a part are left out until the path
/// leads beyond it again; more than 5 m from it they begin a new part, as after a turn. Points closer than 2 cm to the
/// last one are left out.
std::vector<std::vector<std::array<double, 2>>> forward_paths(std::span<const std::array<double, 2>> path);

/// Measures profiles along a path, metres in the map. Heights of a profile are means over a strip; their standard
/// errors count the cells of one support window of matching as one sample. Only the first of its forward_paths()
/// counts. Throws Error for options out of range.
LaneProfiles measure_lane(const RoadMap& map, std::span<const std::array<double, 2>> path, const LaneOptions& options);

}  // namespace roadstereo
#pragma GCC visibility pop
