#include "mapping/tile_store.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <system_error>
#include <type_traits>

#include "core/own_files.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {

static_assert(std::is_trivially_copyable_v<MapCell>);

namespace {

/// Whether a file has the name of a tile: column_row.generation.
bool is_tile(const std::filesystem::path& file) {
  static const std::regex name("-?[0-9]+_-?[0-9]+\\.[0-9]+");
  return std::regex_match(file.filename().string(), name);
}

}  // namespace

TileStore::TileStore(const std::filesystem::path& folder, int tile_cells, int max_tiles, const Saved& saved)
    : folder_(std::filesystem::absolute(folder)),
      cells_per_tile_(static_cast<std::size_t>(tile_cells) * static_cast<std::size_t>(tile_cells)),
      max_tiles_(static_cast<std::size_t>(max_tiles)),
      known_(saved) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) fail<SystemError>("cannot write to folder ", folder_.string(), ": ", error.message());
  std::set<std::filesystem::path> needed;
  for (const auto& [key, generation] : saved) {
    generation_ = std::max(generation_, generation + 1);
    needed.insert(file(key, generation));
    const std::uintmax_t bytes = cells_per_tile_ * sizeof(MapCell),
                         found = std::filesystem::file_size(file(key, generation), error);
    if (error) fail(file(key, generation).string(), ": this tile is missing");
    if (found != bytes) fail(file(key, generation).string(), ": this tile has ", found, " bytes, but needs ", bytes);
  }
  for (std::filesystem::path& tile : own_files(folder_, "map", "tiles", is_tile)) {
    if (needed.find(tile) == needed.end()) superseded_.push_back(std::move(tile));
  }
  commit();
}

TileStore::~TileStore() {
  if (keep_) return;
  std::error_code ignored;
  for (const auto& [key, generation] : known_) {
    if (generation > 0) std::filesystem::remove(file(key, generation), ignored);
  }
  commit();
  std::filesystem::remove(folder_, ignored);  // unless somebody has put something there
}

std::filesystem::path TileStore::file(const Key& key, int generation) const {
  return folder_ / (std::to_string(key.first) + "_" + std::to_string(key.second) + "." + std::to_string(generation));
}

void TileStore::write_file(Tile& tile) {
  const std::filesystem::path path = file(tile.key, generation_);
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(tile.cells.data()),
               static_cast<std::streamsize>(tile.cells.size() * sizeof(MapCell)));
  stream.close();
  if (!stream) {
    const int cause = errno;
    std::error_code ignored;
    std::filesystem::remove(path, ignored);  // half a tile
    fail<SystemError>(path.string(), ": cannot be written: ", std::generic_category().message(cause));
  }
  int& generation = known_[tile.key];
  if (generation > 0 && generation < generation_) superseded_.push_back(file(tile.key, generation));
  generation = generation_;
  tile.changed = false;
}

void TileStore::evict_oldest() {
  Tile& tile = recent_.back();
  if (tile.changed) write_file(tile);
  in_memory_.erase(tile.key);
  recent_.pop_back();
}

const TileStore::Saved& TileStore::save() {
  for (Tile& tile : recent_) {
    if (tile.changed) write_file(tile);
  }
  ++generation_;
  return known_;
}

void TileStore::commit() {
  std::error_code ignored;
  for (const std::filesystem::path& path : superseded_) std::filesystem::remove(path, ignored);
  superseded_.clear();
}

TileStore::Tile& TileStore::fetch(const Key& key) {
  const auto found = in_memory_.find(key);
  if (found != in_memory_.end()) {
    recent_.splice(recent_.begin(), recent_, found->second);
    return recent_.front();
  }
  while (recent_.size() >= max_tiles_) evict_oldest();
  Tile tile{key, Cells(cells_per_tile_), false};
  const int generation = known_[key];
  if (generation > 0) {
    const std::filesystem::path path = file(key, generation);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(tile.cells.data()),
                static_cast<std::streamsize>(tile.cells.size() * sizeof(MapCell)));
    if (!stream) fail<SystemError>(path.string(), ": cannot be read");
  }
  recent_.push_front(std::move(tile));
  in_memory_[key] = recent_.begin();
  return recent_.front();
}

TileStore::Cells& TileStore::write(const Key& key) {
  Tile& tile = fetch(key);
  tile.changed = true;
  return tile.cells;
}

const TileStore::Cells* TileStore::read(const Key& key) {
  if (known_.find(key) == known_.end()) return nullptr;
  return &fetch(key).cells;
}

}  // namespace roadstereo
