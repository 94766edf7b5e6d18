#include "map/build_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "core/order_statistics.hpp"
#include "core/round_length.hpp"
#include "core/same_view.hpp"
#include "flight/rectified_source.hpp"
#include "inspect_flight.hpp"
#include "io/geo/utc_time.hpp"
#include "map/map_journal.hpp"
#include "map/map_provenance.hpp"
#include "progress.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/io/trajectory_file.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo::cli {
namespace {

constexpr double max_raster_cells = 8e9;  ///< about twenty minutes of writing

/// A recording with its poses.
struct Pass {
  std::unique_ptr<RectifiedSource> source;
  std::map<std::int64_t, FramePose> poses;  ///< by frame
};

class MapBuilder {
 public:
  MapBuilder(const MapPlan& plan, const std::filesystem::path& folder, const StopSignals& stop)
      : plan_(plan), folder_(folder), stop_(stop), journal_(folder, provenance(plan), plan.resume) {}

  BuiltMap build() {
    std::vector<Pass> passes;
    std::int64_t frames = 0;
    for (const MapPass& pass : plan_.passes) {
      passes.push_back(open_pass(pass));
      frames += static_cast<std::int64_t>(passes.back().poses.size());
    }
    restore();
    first_pass_ = &passes.front();
    Progress progress(frames, state_.frames, plan_.quiet);
    while (state_.pass < static_cast<int>(passes.size())) {
      add_pass(passes[static_cast<std::size_t>(state_.pass)], progress);
      begin_next_pass();
    }
    save();
    progress.end();
    return result();
  }

 private:
  /// Continues from the checkpoint, if there is one.
  void restore() {
    std::vector<MappedFrame> frames;
    std::optional<MapState> state = journal_.restore([&](MappedFrame& frame) { frames.push_back(std::move(frame)); });
    if (!state) return;
    state_ = std::move(*state);
    const auto is_day = [&](std::size_t day) { return day < state_.day_names.size(); };
    bool fits = state_.pass >= 0 && state_.pass <= static_cast<int>(plan_.passes.size()) && state_.next_frame >= 0 &&
                (!state_.day || is_day(*state_.day));
    for (const auto& entry : state_.days) fits = fits && is_day(entry.first);
    for (const MappedFrame& frame : frames) fits = fits && state_.days.count(frame.day) > 0;
    if (!fits) fail(folder_.string(), ": the journal of this map is broken; start again without --resume");
    map_options_ = map_options(state_.cell_m);
    for (const auto& [day, saved] : state_.days) {
      RoadMap map(folder_of(day), map_options_, saved);
      map.keep();
      days_.emplace(day, DayMap{state_.day_names[day], std::move(map), {}, {}});
    }
    for (MappedFrame& frame : frames) add_record(std::move(frame));
  }

  /// Tiles, journal and checkpoint on disk; a later run continues here.
  void save() {
    for (auto& [day, map] : days_) state_.days[day] = map.map.save();
    journal_.checkpoint(state_);
    for (auto& entry : days_) entry.second.map.commit();
  }

  void begin_next_pass() {
    ++state_.pass;
    state_.next_frame = 0;
    state_.day.reset();
    state_.piece = -1;
    state_.height_m = 0;
    state_.white_level = 0;
    state_.pipeline.reset();
  }

  BuiltMap result() {
    BuiltMap built;
    for (auto& entry : days_) {
      std::vector<std::vector<std::array<double, 2>>> paths;
      for (const auto& path : entry.second.paths) {
        for (auto& part : forward_paths(path)) paths.push_back(std::move(part));
      }
      entry.second.paths = std::move(paths);
      built.days.push_back(std::move(entry.second));
    }
    const bool named =
        std::any_of(plan_.passes.begin(), plan_.passes.end(), [](auto& pass) { return !pass.day.empty(); });
    if (!named) {  // dates
      std::stable_sort(built.days.begin(), built.days.end(), [](auto& a, auto& b) { return a.name < b.name; });
    }
    built.origin_m = state_.origin_m;
    built.frames = state_.frames;
    built.mapped = state_.mapped;
    built.reasons = counted_reasons();
    return built;
  }

  Pass open_pass(const MapPass& from) const {
    Pass pass;
    pass.source =
        std::make_unique<RectifiedSource>(io::open_source(from.source, make_source_options(from.source_settings)),
                                          from.calibration, from.options.threads);
    if (!from.find_white_level) pass.source->ignore_white_level();
    if (pass.source->source().live()) fail(from.source[0], ": a camera has no trajectory; record it first");
    const Trajectory trajectory = io::read_trajectory(from.trajectory);
    for (const FramePose& pose : trajectory.frames) {
      if (pose.frame % plan_.every == 0) pass.poses[pose.frame] = pose;
    }
    return pass;
  }

  void add_pass(Pass& pass, Progress& progress) {
    const MapPass& from = plan_.passes[static_cast<std::size_t>(state_.pass)];
    if (state_.next_frame == 0) tell_missing_poses(pass, from);
    if (state_.white_level > 0) pass.source->set_white_level(state_.white_level);
    std::optional<Pipeline> pipeline;
    std::int64_t next = 0;
    bool has_extent = false;
    for (auto pose = pass.poses.lower_bound(state_.next_frame); pose != pass.poses.end(); ++pose) {
      if (stop_.wait(0)) {
        save();
        throw Interrupted{"interrupted; continue with --resume"};
      }
      if (stands(pose->second)) {
        count_frame(pose->first + 1, progress);
        continue;
      }
      pass.source->source().skip(pose->first - next);
      const std::optional<io::SourcePair> pair = pass.source->next();
      if (!pair) {
        add_reason(fmt::format("{} ends before frame {} of {}", from.source[0], pose->first, from.trajectory));
        break;
      }
      next = pair->index + 1;
      const std::int64_t mapped = state_.mapped;
      add_pair(from, *pass.source, *pair, pose->second, pipeline);
      if (!has_extent && state_.mapped > mapped) {
        require_extent(pass, from);
        has_extent = true;
      }
      count_frame(next, progress);
    }
  }

  /// Whether the camera has stood since the last mapped frame: the same errors again would count as another opinion.
  bool stands(const FramePose& pose) const {
    return pose.piece == state_.piece && is_same_view(state_.view, pose.camera_to_world, state_.height_m);
  }

  void count_frame(std::int64_t next, Progress& progress) {
    constexpr std::int64_t frames_per_save = 16;
    state_.next_frame = next;
    progress.frame_done();
    if (++state_.frames % frames_per_save == 0) save();
  }

  void tell_missing_poses(const Pass& pass, const MapPass& from) {
    const std::optional<std::int64_t> size = pass.source->source().size();
    if (!size) return;
    const std::int64_t end = from.to ? std::min(*from.to + 1, *size) : *size;
    std::int64_t frames = 0, missing = 0;
    for (std::int64_t frame = from.from; frame < end; frame += from.every) {
      if (frame % plan_.every != 0) continue;
      ++frames;
      missing += pass.poses.count(frame) == 0;
    }
    if (missing > 0) add_reason(fmt::format("{} of {} frames have no pose in {}", missing, frames, from.trajectory));
  }

  void add_pair(const MapPass& from, const RectifiedSource& source, const io::SourcePair& pair, const FramePose& pose,
                std::optional<Pipeline>& pipeline) {
    if (!pair.error.empty()) return add_reason(pair.error);
    if (!state_.day) state_.day = day_of(from, pair.time_s);
    if (!pipeline) {
      if (from.options.rig_bias) {
        from.options.rig_bias->require_rig(pair.left.width, pair.left.height, source.calibration());
      }
      pipeline.emplace(begin_pass(from, source));
    }
    if (pair.white_level > 0) pipeline->set_white_level(pair.white_level);
    state_.white_level = pipeline->options().white_level;
    add_frame(pair, pose, *source.calibration(), *pipeline);
    state_.pipeline = pipeline->carried();
  }

  /// Index of the day of a recording whose first good pair has this time.
  std::size_t day_of(const MapPass& pass, double time_s) {
    std::string name = io::valid_utf8(pass.day);
    const auto time = io::utc_time(time_s + pass.time_offset_s);
    if (name.empty() && time) name = fmt::format("{:04}-{:02}-{:02}", time->year, time->month, time->day);
    const auto known = std::find(state_.day_names.begin(), state_.day_names.end(), name);
    const auto index = static_cast<std::size_t>(known - state_.day_names.begin());
    if (known == state_.day_names.end()) state_.day_names.push_back(name);
    return index;
  }

  /// Called after the first valid pair: the size is known.
  Pipeline begin_pass(const MapPass& pass, const RectifiedSource& source) {
    if (!source.calibration()) fail("map needs --calibration");
    PipelineOptions options = pass.options;
    options.damage.min_confidence = 0;  // what one frame doubts may be clear in the map
    Pipeline pipeline(options, source.calibration());
    if (!pass.mask.empty()) pipeline.set_mask(pass.mask);
    if (state_.pipeline) pipeline.restore(*state_.pipeline);
    return pipeline;
  }

  void add_frame(const io::SourcePair& pair, const FramePose& pose, const StereoCalibration& calibration,
                 Pipeline& pipeline) {
    try {
      const FrameResult& result = pipeline.process(pair.left.view(), pair.right.view());
      if (!result.roll_found || !result.road.has_road()) return add_reason("there is no road: " + result.road.reason);
      const DisparityPlane& road = result.geometry.plane;
      if (days_.empty()) set_axes(result, pose, calibration);
      const RigidTransform camera_to_map = compose(state_.world_to_map, pose.camera_to_world);
      pipeline.find_damage(damage_);
      const PipelineOptions& options = pipeline.options();
      withhold_severity(measure_health(result, damage_, calibration, options.damage, options.threads), damage_);
      MappedFrame mapped{state_.pass,
                         pose.frame,
                         *state_.day,
                         pose.piece != state_.piece,
                         {camera_to_map[3], camera_to_map[7]},
                         locate_damage(damage_, road, calibration, camera_to_map)};
      const std::size_t cells = map_of(*state_.day)
                                    .map.add({result.disparity, result.sigma, pair.left.view(),
                                              pipeline.options().white_level, road, calibration, camera_to_map});
      if (cells == 0) {
        return add_reason(
            fmt::format("the road is too far away in some frames: a pixel covers more than {} cells of {} m",
                        map_options_.max_footprint_cells, map_options_.cell_m));
      }
      ++state_.mapped;
      state_.piece = pose.piece;
      state_.height_m = ground_plane(road, calibration).height_m;
      state_.view = pose.camera_to_world;
      journal_.append(mapped);
      add_record(std::move(mapped));
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      add_reason(error.what());
    }
  }

  void add_record(MappedFrame frame) {
    DayMap& day = map_of(frame.day);
    if (frame.new_path || day.paths.empty()) day.paths.emplace_back();
    day.paths.back().push_back(frame.camera_m);
    for (MapDamage& found : frame.found) {
      day.sightings.push_back({frame.pass, static_cast<int>(frame.index), std::move(found)});
    }
  }

  std::filesystem::path folder_of(std::size_t day) const { return folder_ / std::to_string(day); }

  DayMap& map_of(std::size_t day) {
    const auto known = days_.find(day);
    if (known != days_.end()) return known->second;
    RoadMap map(folder_of(day), map_options_);
    map.keep();
    return days_.emplace(day, DayMap{state_.day_names[day], std::move(map), {}, {}}).first->second;
  }

  RoadMapOptions map_options(double cell_m) const {
    RoadMapOptions options;
    options.cell_m = cell_m;
    options.threads = plan_.passes.front().options.threads;
    return options;
  }

  /// The cell, or a larger one up to 5 cm with which rasters of the first recording do not have too many.
  double affordable_cell_m(double suggested_m) {
    constexpr double largest_m = 0.05, margin_m = 20;  // of road around the poses
    std::array<std::vector<double>, 2> at = positions_m(*first_pass_);
    std::array<double, 2> size_m{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (at[axis].empty()) return suggested_m;
      const auto [low, high] = std::minmax_element(at[axis].begin(), at[axis].end());
      size_m[axis] = *high - *low + 2 * margin_m;
    }
    const double least_m = std::sqrt(size_m[0] * size_m[1] / max_raster_cells);
    double cell_m = suggested_m;
    while (cell_m < std::min(least_m, largest_m)) cell_m = round_length(2.5 * cell_m);
    if (cell_m > suggested_m) {
      add_reason(fmt::format("cells of {} m instead of {} m, since the poses lie in a box of {:.0f} × {:.0f} m", cell_m,
                             suggested_m, size_m[0], size_m[1]));
    }
    return cell_m;
  }

  /// x and y of the cameras of a recording in the map.
  std::array<std::vector<double>, 2> positions_m(const Pass& pass) const {
    std::array<std::vector<double>, 2> at;
    for (const auto& [frame, pose] : pass.poses) {
      const RigidTransform camera_to_map = compose(state_.world_to_map, pose.camera_to_world);
      for (std::size_t axis = 0; axis < 2; ++axis) at[axis].push_back(camera_to_map[4 * axis + 3]);
    }
    return at;
  }

  /// Sets cells and axes: those of the road under the first camera, or with --crs those of the trajectory, with an
  /// origin at a whole number of metres.
  void set_axes(const FrameResult& first, const FramePose& pose, const StereoCalibration& calibration) {
    const DisparityPlane& road = first.geometry.plane;
    const int width = first.disparity.width(), height = first.disparity.height();
    if (plan_.crs.empty()) {
      state_.world_to_map = compose(camera_to_road(road, calibration), inverse(pose.camera_to_world));
    } else {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        state_.origin_m[axis] = std::floor(pose.camera_to_world[4 * axis + 3]);
        state_.world_to_map[4 * axis + 3] = -state_.origin_m[axis];
      }
    }
    state_.cell_m =
        plan_.cell_m > 0 ? plan_.cell_m : affordable_cell_m(suggested_cell_m(road, calibration, width, height));
    map_options_ = map_options(state_.cell_m);
  }

  /// Throws Error if the box around the poses of a recording and what is mapped of its day has too many cells for
  /// rasters.
  void require_extent(const Pass& pass, const MapPass& from) const {
    const std::array<std::vector<double>, 2> at = positions_m(pass);
    const MapBox mapped = days_.at(*state_.day).map.bounds();
    const std::array<int, 2> first{mapped.i0, mapped.j0}, count{mapped.columns, mapped.rows};
    std::array<double, 2> size_m{}, middle_m{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::minmax_element(at[axis].begin(), at[axis].end());
      const double first_m = state_.cell_m * first[axis], last_m = first_m + state_.cell_m * count[axis];
      size_m[axis] = std::max(*high, last_m) - std::min(*low, first_m);
      middle_m[axis] = central_median(std::vector(at[axis]));
    }
    const double cells = size_m[0] / state_.cell_m * (size_m[1] / state_.cell_m);
    if (cells <= max_raster_cells) return;
    std::size_t farthest = 0;
    const auto distance_m = [&](std::size_t k) { return std::hypot(at[0][k] - middle_m[0], at[1][k] - middle_m[1]); };
    for (std::size_t k = 1; k < at[0].size(); ++k) {
      if (distance_m(k) > distance_m(farthest)) farthest = k;
    }
    const std::int64_t frame = std::next(pass.poses.begin(), static_cast<std::ptrdiff_t>(farthest))->first;
    fail(from.trajectory, ": its poses and what is mapped lie in a box of ",
         fmt::format("{:.0f} × {:.0f} m, which has {:.2g} cells of {} m (limit {:.0g}); frame {} is {:.0f} m from the "
                     "middle of the others: leave out what is wrong (nan), map parts, or use a larger --cell",
                     size_m[0], size_m[1], cells, state_.cell_m, max_raster_cells, frame, distance_m(farthest)));
  }

  /// Keeps one of each kind, and of the first kinds only: those of frames differ by names and numbers.
  void add_reason(const std::string& given) {
    constexpr std::size_t most = 5;
    const std::string reason = io::valid_utf8(given);
    const auto kind = [](const std::string& text) { return text.substr(0, text.find_first_of("0123456789:")); };
    std::vector<std::string>& reasons = state_.reasons;
    const auto same =
        std::find_if(reasons.begin(), reasons.end(), [&](const std::string& one) { return kind(one) == kind(reason); });
    if (same != reasons.end()) {
      if (*same != reason) ++state_.more_of_reason[static_cast<std::size_t>(same - reasons.begin())];
    } else if (reasons.size() < most) {
      reasons.push_back(reason);
      state_.more_of_reason.push_back(0);
    } else {
      ++state_.further_reasons;
    }
  }

  std::vector<std::string> counted_reasons() const {
    std::vector<std::string> counted = state_.reasons;
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (state_.more_of_reason[i] > 0) counted[i] += fmt::format(", and {} more like it", state_.more_of_reason[i]);
    }
    if (state_.further_reasons > 0) counted.push_back(fmt::format("{} more for other reasons", state_.further_reasons));
    return counted;
  }

  const MapPlan& plan_;
  std::filesystem::path folder_;
  const StopSignals& stop_;
  MapJournal journal_;
  MapState state_;
  std::map<std::size_t, DayMap> days_;  ///< by index of their names, those with a road in a frame
  RoadMapOptions map_options_;
  const Pass* first_pass_ = nullptr;
  DamageMap damage_;
};

}  // namespace

BuiltMap build_map(const MapPlan& plan, const std::filesystem::path& folder, const StopSignals& stop) {
  return MapBuilder(plan, folder, stop).build();
}

}  // namespace roadstereo::cli
