#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"
#include "roadstereo/io/track.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

class CutExtent;
class PlaceIndex;

/// One damage of the road, seen in one or several frames of a flight: the record behind every table, GIS layer and
/// report.
struct RoadDamage {
  std::int64_t id = 0;                           ///< unique in the flight, from 1, in the order of the first sighting
  bool candidate = false;                        ///< listed apart and not counted (FlightInventory)
  std::int64_t sightings = 0;                    ///< number of frames that show it
  std::int64_t first_frame = 0, last_frame = 0;  ///< indices of the frames that show it
  std::int64_t frame = 0;  ///< index of the best frame: not cut by the border and then of the smallest error; if the
                           ///< border cuts it in all frames, of those that show at least half as much as any
  std::string frame_name;
  double time_s = FlightFrame::unknown;
  Damage best;  ///< the measurement in that frame; area, volume, length, diameter and quantity of one that the border
                ///< cuts in all frames (`cut_by_border`) are extended to what these show together, where their poses
                ///< are known, and are the least that it has
  std::optional<GeoPosition> position;             ///< of its centroid
  std::vector<std::array<double, 2>> outline_deg;  ///< (longitude, latitude), counterclockwise, not closed
  double station_m = FlightFrame::unknown;         ///< along the track, of the damage itself, when first passed
  double ahead_m = 0;   ///< distance of its centroid from the camera along the travel, in the best frame
  std::string picture;  ///< file in the folder of the results; empty: none
};

/// Returns whether a damage is a rut. A rut runs through the images and gives no information about their motion.
bool is_rut(const Damage& damage);

/// Returns whether one of two damages is a rut and the other a small part of its box, such as a pothole in it.
bool is_part_of_rut(const Damage& one, const Damage& other);

/// Returns whether `one` is more severe than `other`, or as severe and deeper.
bool is_worse(const RoadDamage& one, const RoadDamage& other);

/// Returns the damages that are candidates, or those that are not, worst first.
std::vector<RoadDamage> worst_first(const std::vector<RoadDamage>& damages, bool candidates);

/// Tracks damages over the frames of a flight. Where the poses of the frames are known, sightings are one damage if
/// their outlines overlap on the road, however long ago it was seen. Elsewhere, sightings in successive frames are one
/// damage if their boxes overlap after the image motion is compensated; this restarts at a frame whose road was not
/// tracked although the frame before had one, since the image has then jumped, and frames too far apart to overlap give
/// one damage per sighting. A rut that runs through the pictures is one damage; a pothole in it is another.
/// A region counts as damage of the road if it is a damage in at least one frame and the two views with the highest
/// confidence agree: the mean of their log-odds is at least that of the minimum confidence. Otherwise noise in one of
/// many frames would suffice. A view is what successive frames show while the camera stands, by their poses; its
/// log-odds are the mean of those of its frames, those without a pose included. Without any pose every frame is one. A
/// region that only one view shows is decided by that view.
class FlightInventory {
 public:
  /// `min_confidence`: DamageOptions::min_confidence, 0 … 1.
  explicit FlightInventory(double min_confidence = DamageOptions{}.min_confidence);
  ~FlightInventory();
  FlightInventory(FlightInventory&&) noexcept;
  FlightInventory& operator=(FlightInventory&&) noexcept;

  /// Adds the next frame of the flight. Returns the id of the road damage of each of its damages, then of its
  /// candidates.
  std::vector<std::int64_t> add(const FlightFrame& frame);

  /// All damages of the road, candidates included, in the order of their first sighting.
  const std::vector<RoadDamage>& damages() const { return damages_; }

 private:
  /// Outline of a damage in the axes of the first camera of a piece, metres.
  struct Place {
    int piece = 0;
    std::vector<std::array<double, 3>> outline_m;
    std::array<double, 3> centre_m{};
    double radius_m = 0;  ///< of the outline around the centre
  };
  /// A sighting of a damage.
  struct Sighting {
    std::int64_t id = 0;
    std::int64_t sequence = 0;  ///< number of the frame in the flight
    Damage damage;
    std::optional<Place> place;
  };
  using Ids = std::vector<std::int64_t>;
  static std::optional<Place> place_of(const Damage& damage, const std::optional<FlightPose>& pose);
  std::int64_t seen_here(const Sighting& now, const FlightPose& pose, const Ids& taken) const;
  std::int64_t seen_in_picture(const Sighting& now, const Ids& taken) const;
  void remember(std::vector<Sighting> sightings);

  bool is_recent(const Sighting& last) const;

  /// Log-odds of the confidences of the views that show a damage, and whether it is a damage in one of their frames.
  struct Agreement {
    std::vector<double> best{};  ///< the largest of earlier views, at most two, the larger one first
    std::int64_t view = 0;       ///< last one
    double sum = 0, frames = 0;  ///< of its frames
    bool is_damage = false;
  };
  bool has_moved(const FlightFrame& frame) const;
  void add_confidence(double confidence, Agreement& views) const;
  bool agree(const Agreement& views, std::int64_t sightings) const;

  /// What the next frames need of a damage.
  struct Known {
    Sighting last;
    std::optional<Place> best_place;  ///< in the best frame
    Agreement views;
    Damage measured;                    ///< in the best frame
    double largest_cut = 0;             ///< area of the largest sighting that the border cuts, m², or pixels
    std::unique_ptr<CutExtent> extent;  ///< while the border cuts it in all frames
  };

  double min_confidence_;
  std::vector<RoadDamage> damages_;
  std::vector<Known> known_;             ///< of each of them
  Ids recent_;                           ///< of those that one of the last frames shows, in ascending order
  std::unique_ptr<PlaceIndex> places_;   ///< of all sightings with a place
  std::array<double, 2> motion_px_{};    ///< image motion from frame to frame
  bool motion_known_ = false;            ///< whether damages of the last frame determined it
  bool had_road_ = false;                ///< whether the last frame had a road
  std::int64_t sequence_ = 0;            ///< of the last frame, from 1
  std::int64_t view_ = 0;                ///< number of the last view, from 1
  std::optional<FlightPose> view_from_;  ///< its first pose
  std::int64_t uncut_from_ = 1;          ///< since when the image has not jumped
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
