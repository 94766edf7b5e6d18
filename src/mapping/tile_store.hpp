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
/// own, which are removed at the end. A file belongs to a generation: after a save, tiles are written to new files, so
/// that those of the save stay as they are until the next one is committed.
class TileStore {
 public:
  using Key = std::pair<int, int>;  ///< column and row of the tile
  using Cells = std::vector<MapCell>;

  /// Generation of the file of each saved tile.
  using Saved = std::map<Key, int>;

  /// Begins an empty store, or one with the tiles of a save; files of later generations are removed.
  /// Throws Error if the folder holds anything but tiles.
  TileStore(const std::filesystem::path& folder, int tile_cells, int max_tiles, const Saved& saved = {});
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// Returns a tile for writing; creates it. Valid until the next call.
  Cells& write(const Key& key);
  /// Returns a tile, or null if there is none. Valid until the next call.
  const Cells* read(const Key& key);

  /// Writes all changed tiles, and returns the generations of all.
  const Saved& save();
  /// Removes the files that the last save does not need; call it when that is recorded.
  void commit();
  /// Leaves the files at the end.
  void keep() { keep_ = true; }

  /// Returns the generation of the file of each tile, 0 without one.
  const Saved& keys() const { return known_; }

 private:
  struct Tile {
    Key key;
    Cells cells;
    bool changed = false;
  };
  Tile& fetch(const Key& key);
  void evict_oldest();
  void write_file(Tile& tile);
  std::filesystem::path file(const Key& key, int generation) const;

  std::filesystem::path folder_;
  std::size_t cells_per_tile_;
  std::size_t max_tiles_;
  std::list<Tile> recent_;  ///< the most recently used first
  std::map<Key, std::list<Tile>::iterator> in_memory_;
  Saved known_;
  std::vector<std::filesystem::path> superseded_;  ///< files of earlier generations
  int generation_ = 1;
  bool keep_ = false;
};

}  // namespace roadstereo
