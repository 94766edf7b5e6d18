#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/io/flight_journal.hpp"
#include "roadstereo/map_damage.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::cli {

/// What one frame adds to a map besides its tiles.
struct MappedFrame {
  int pass = 0;  ///< recording, from 0
  std::int64_t index = 0;
  std::size_t day = 0;    ///< index of its name
  bool new_path = false;  ///< begins a piece
  std::array<double, 2> camera_m{};
  std::vector<MapDamage> found;
};

/// Where the making of a map stands.
struct MapState {
  int pass = 0;                    ///< recording that is being added
  std::int64_t next_frame = 0;     ///< of that recording
  std::optional<std::size_t> day;  ///< of that recording
  int piece = -1;                  ///< of its trajectory, of the last mapped frame
  double height_m = 0;             ///< of the camera in that frame; 0: none was mapped
  RigidTransform view{};           ///< its camera_to_world
  double white_level = 0;
  std::optional<PipelineState> pipeline;  ///< absent before its first valid pair
  std::int64_t frames = 0, mapped = 0;
  std::vector<std::string> reasons, day_names;
  std::vector<std::int64_t> more_of_reason;  ///< of the same kind as each of `reasons`, with other numbers
  std::int64_t further_reasons = 0;          ///< of other kinds
  double cell_m = 0;
  std::array<double, 3> origin_m{};
  RigidTransform world_to_map{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::map<std::size_t, SavedMap> days;  ///< tiles of each day
};

/// Journal of a map in the folder of its tiles: one line per mapped frame, and a checkpoint, which is replaced as a
/// whole. What is newer than the checkpoint is ignored, so that a map continued from it is the same, bit for bit.
class MapJournal {
 public:
  /// Continues the map in the folder if `resume` is set and there is a checkpoint, else begins anew. Throws Error
  /// naming the first entry of `made_with` that differs.
  MapJournal(std::filesystem::path folder, const io::Provenance& made_with, bool resume);

  /// Removes the folder if there is no checkpoint.
  ~MapJournal();
  MapJournal(const MapJournal&) = delete;
  MapJournal& operator=(const MapJournal&) = delete;

  /// Returns the checkpoint after `visit` has seen the frames before it; nullopt for a new map.
  std::optional<MapState> restore(const std::function<void(MappedFrame&)>& visit);

  void append(const MappedFrame& frame);
  /// Records a state whose tiles are saved. Throws SystemError on a full disk.
  void checkpoint(const MapState& state);

 private:
  std::filesystem::path frames_file() const { return folder_ / "frames.jsonl"; }
  std::filesystem::path checkpoint_file() const { return folder_ / "checkpoint.json"; }

  std::filesystem::path folder_;
  io::Provenance made_with_;
  bool resumed_ = false;
  std::ofstream frames_;
};

}  // namespace roadstereo::cli
