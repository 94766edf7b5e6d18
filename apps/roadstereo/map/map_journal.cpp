#include "map/map_journal.hpp"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Damages have the form of a flight's journal, which is read back bit for bit.
Json frame_json(const MappedFrame& frame) {
  io::FlightFrame damages;
  Json places = Json::array();
  for (const MapDamage& found : frame.found) {
    damages.damages.push_back(found.damage);
    places.push_back({found.at_m, found.length_angle_rad, found.footprint});
  }
  return {{"pass", frame.pass},
          {"index", frame.index},
          {"day", frame.day},
          {"new_path", frame.new_path},
          {"camera_m", frame.camera_m},
          {"places", places},
          {"frame", io::flight_frame_json(damages)}};
}

MappedFrame read_frame(const std::string& line) {
  const Json json = Json::parse(line);
  MappedFrame frame;
  frame.pass = json.at("pass").get<int>();
  frame.index = json.at("index").get<std::int64_t>();
  frame.day = json.at("day").get<std::size_t>();
  frame.new_path = json.at("new_path").get<bool>();
  frame.camera_m = json.at("camera_m").get<std::array<double, 2>>();
  io::FlightFrame damages = io::read_flight_frame(json.at("frame").get<std::string>());
  for (std::size_t k = 0; k < damages.damages.size(); ++k) {
    const Json& place = json.at("places").at(k);
    frame.found.push_back({std::move(damages.damages[k]), place.at(0).get<std::array<double, 2>>(),
                           place.at(1).get<double>(), place.at(2).get<MapCells>()});
  }
  return frame;
}

Json state_json(const MapState& state) {
  io::FlightFrame pipeline;
  if (state.pipeline) pipeline.pipeline_state = *state.pipeline;
  pipeline.white_level = state.white_level;
  Json days = Json::array();
  for (const auto& [day, saved] : state.days) days.push_back({day, saved.tiles, saved.sums});
  return {{"pass", state.pass},
          {"next_frame", state.next_frame},
          {"day", state.day ? Json(*state.day) : Json(nullptr)},
          {"piece", state.piece},
          {"height_m", state.height_m},
          {"view", state.view},
          {"has_pipeline", state.pipeline.has_value()},
          {"pipeline", io::flight_frame_json(pipeline)},
          {"frames", state.frames},
          {"mapped", state.mapped},
          {"reasons", state.reasons},
          {"more_of_reason", state.more_of_reason},
          {"further_reasons", state.further_reasons},
          {"day_names", state.day_names},
          {"cell_m", state.cell_m},
          {"origin_m", state.origin_m},
          {"world_to_map", state.world_to_map},
          {"days", days}};
}

MapState read_state(const Json& json) {
  const io::FlightFrame pipeline = io::read_flight_frame(json.at("pipeline").get<std::string>());
  MapState state;
  state.pass = json.at("pass").get<int>();
  state.next_frame = json.at("next_frame").get<std::int64_t>();
  if (!json.at("day").is_null()) state.day = json.at("day").get<std::size_t>();
  state.piece = json.at("piece").get<int>();
  state.height_m = json.at("height_m").get<double>();
  state.view = json.at("view").get<RigidTransform>();
  if (json.at("has_pipeline").get<bool>()) state.pipeline = pipeline.pipeline_state;
  state.white_level = pipeline.white_level;
  state.frames = json.at("frames").get<std::int64_t>();
  state.mapped = json.at("mapped").get<std::int64_t>();
  state.reasons = json.at("reasons").get<std::vector<std::string>>();
  state.more_of_reason = json.value("more_of_reason", std::vector<std::int64_t>());
  state.more_of_reason.resize(state.reasons.size());  // an earlier version had each reason once
  state.further_reasons = json.value("further_reasons", std::int64_t{0});
  state.day_names = json.at("day_names").get<std::vector<std::string>>();
  state.cell_m = json.at("cell_m").get<double>();
  state.origin_m = json.at("origin_m").get<std::array<double, 3>>();
  state.world_to_map = json.at("world_to_map").get<RigidTransform>();
  for (const Json& day : json.at("days")) {
    state.days[day.at(0).get<std::size_t>()] = {day.at(1).get<std::vector<std::array<int, 3>>>(),
                                                day.at(2).get<std::array<double, 3>>()};
  }
  return state;
}

Json read_json(const fs::path& file) {
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) fail(file.string(), ": this is no checkpoint of a map; start again without --resume");
  return json;
}

}  // namespace

MapJournal::MapJournal(fs::path folder, const io::Provenance& made_with, bool resume) : folder_(std::move(folder)) {
  for (const auto& [name, value] : made_with) made_with_.emplace_back(name, io::valid_utf8(value));
  std::error_code error;
  resumed_ = resume && fs::exists(checkpoint_file(), error);
  if (resumed_) {
    const Json checkpoint = read_json(checkpoint_file());
    const Json begun_with = checkpoint.value("made_with", Json());
    for (const auto& [name, value] : made_with_) {
      const auto known = begun_with.find(name);
      const std::string before = known != begun_with.end() && known->is_string() ? known->get<std::string>() : "";
      if (before == value) continue;
      fail(folder_.parent_path().string(), ": this map was started with ", name, " \"", before, "\", not \"", value,
           "\"; use the same, or start again without --resume");
    }
  } else {
    fs::remove_all(folder_, error);
  }
  fs::create_directories(folder_, error);
  if (error) fail<SystemError>("cannot write to folder ", folder_.string(), ": ", error.message());
}

MapJournal::~MapJournal() {
  std::error_code ignored;
  if (!fs::exists(checkpoint_file(), ignored)) fs::remove_all(folder_, ignored);
}

std::optional<MapState> MapJournal::restore(const std::function<void(MappedFrame&)>& visit) {
  std::optional<MapState> state;
  if (resumed_) {
    try {
      const Json json = read_json(checkpoint_file());
      fs::resize_file(frames_file(), json.at("journal_bytes").get<std::uintmax_t>());
      std::ifstream stream(frames_file());
      for (std::string line; std::getline(stream, line);) {
        MappedFrame frame = read_frame(line);
        visit(frame);
      }
      if (stream.bad()) fail<SystemError>(frames_file().string(), " cannot be read");
      state = read_state(json.at("state"));
    } catch (const Json::exception& error) {
      fail(folder_.string(), ": the journal of this map is broken; start again without --resume: ", error.what());
    } catch (const fs::filesystem_error& error) {
      fail(folder_.string(), ": the journal of this map is broken; start again without --resume: ", error.what());
    }
  }
  frames_.open(frames_file(), std::ios::binary | std::ios::app);
  return state;
}

void MapJournal::append(const MappedFrame& frame) {
  frames_ << frame_json(frame).dump() << '\n';
}

void MapJournal::checkpoint(const MapState& state) {
  frames_.flush();
  if (!frames_) {
    fail<SystemError>(frames_file().string(), ": cannot be written: ", std::generic_category().message(errno));
  }
  Json made_with = Json::object();
  for (const auto& [name, value] : made_with_) made_with[name] = value;
  const fs::path fresh = folder_ / "checkpoint.new";
  std::ofstream stream(fresh, std::ios::binary);
  stream << Json{{"made_with", made_with},
                 {"journal_bytes", fs::file_size(frames_file())},
                 {"state", state_json(state)}}
                .dump();
  stream.close();
  if (!stream) fail<SystemError>(fresh.string(), ": cannot be written: ", std::generic_category().message(errno));
  fs::rename(fresh, checkpoint_file());
}

}  // namespace roadstereo::cli
