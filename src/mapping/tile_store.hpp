#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <map>
#include <utility>
#include <vector>

#include "mapping/map_cell.hpp"

namespace roadstereo {

/// Cache of tiles, least recently used: at most `max_tiles` are in memory, the others are files in a folder of their
/// own, which is removed at the end.
class TileStore {
 public:
  using Key = std::pair<int, int>;  ///< column and row of the tile
  using Cells = std::vector<MapCell>;

  TileStore(std::filesystem::path folder, int tile_cells, int max_tiles);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// Returns a tile for writing; creates it. Valid until the next call.
  Cells& write(const Key& key);
  /// Returns a tile, or null if there is none. Valid until the next call.
  const Cells* read(const Key& key);

  /// Returns whether each known tile is in memory, by its key.
  const std::map<Key, bool>& keys() const { return known_; }

 private:
  struct Tile {
    Key key;
    Cells cells;
    bool changed = false;
  };
  Tile& fetch(const Key& key);
  void evict_oldest();
  std::filesystem::path file(const Key& key) const;

  std::filesystem::path folder_;
  std::size_t cells_per_tile_;
  std::size_t max_tiles_;
  std::list<Tile> recent_;  ///< the most recently used first
  std::map<Key, std::list<Tile>::iterator> in_memory_;
  std::map<Key, bool> known_;
};

}  // namespace roadstereo
