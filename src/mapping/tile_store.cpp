#include "mapping/tile_store.hpp"

#include <fstream>
#include <string>
#include <system_error>
#include <type_traits>

#include "roadstereo/error.hpp"

namespace roadstereo {

static_assert(std::is_trivially_copyable_v<MapCell>);

TileStore::TileStore(std::filesystem::path folder, int tile_cells, int max_tiles)
    : folder_(std::move(folder)),
      cells_per_tile_(static_cast<std::size_t>(tile_cells) * static_cast<std::size_t>(tile_cells)),
      max_tiles_(static_cast<std::size_t>(max_tiles)) {
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
  std::filesystem::create_directories(folder_, error);
  if (error) fail<SystemError>("cannot write to folder ", folder_.string(), ": ", error.message());
}

TileStore::~TileStore() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path TileStore::file(const Key& key) const {
  return folder_ / (std::to_string(key.first) + "_" + std::to_string(key.second));
}

void TileStore::evict_oldest() {
  const Tile& tile = recent_.back();
  if (tile.changed) {
    const std::filesystem::path path = file(tile.key);
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(tile.cells.data()),
                 static_cast<std::streamsize>(tile.cells.size() * sizeof(MapCell)));
    stream.close();
    if (!stream) fail<SystemError>(path.string(), ": cannot be written");
  }
  known_[tile.key] = false;
  in_memory_.erase(tile.key);
  recent_.pop_back();
}

TileStore::Tile& TileStore::fetch(const Key& key) {
  const auto found = in_memory_.find(key);
  if (found != in_memory_.end()) {
    recent_.splice(recent_.begin(), recent_, found->second);
    return recent_.front();
  }
  while (recent_.size() >= max_tiles_) evict_oldest();
  Tile tile{key, Cells(cells_per_tile_), false};
  const auto known = known_.find(key);
  if (known != known_.end()) {
    std::ifstream stream(file(key), std::ios::binary);
    stream.read(reinterpret_cast<char*>(tile.cells.data()),
                static_cast<std::streamsize>(tile.cells.size() * sizeof(MapCell)));
    if (!stream) fail<SystemError>(file(key).string(), ": cannot be read");
  }
  recent_.push_front(std::move(tile));
  in_memory_[key] = recent_.begin();
  known_[key] = true;
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
