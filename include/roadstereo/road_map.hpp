#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/rigid_transform.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Largest absolute value of the column or row of a cell: about 5000 km at 1 cm.
inline constexpr int max_map_cell = 1 << 29;

/// Rectangle of cells of a map. Cell (i, j) covers i … i + 1 times j … j + 1 cell sizes along x and y.
struct MapBox {
  int i0 = 0, j0 = 0;  ///< first column and row
  int columns = 0, rows = 0;

  bool empty() const { return columns <= 0 || rows <= 0; }
};

/// Cells of a part of a map as images, north up: pixel (u, v) is cell (i0 + u, j0 + rows − 1 − v).
struct MapRaster {
  MapBox box;
  Image<float> height;                        ///< metres above z = 0; NaN: no measurement
  Image<float> sigma;                         ///< standard error of `height`, metres; NaN likewise
  Image<std::array<std::uint8_t, 3>> colour;  ///< red, green, blue; black where `views` is 0
  Image<std::uint16_t> views;                 ///< frames that agree on the height
};

struct RoadMapOptions {
  double cell_m = 0.01;      ///< side of a cell, 0.0005 … 10
  int tile_cells = 128;      ///< side of a tile, cells, 16 … 1024
  int max_tiles = 192;       ///< in memory, 4 … 1048576; the others are on disk
  double max_above_m = 0.4;  ///< points higher above the frame's road are vehicles or walls, 0 … 100
  double max_below_m = 0.4;  ///< points deeper below it are no road, 0 … 100
  double max_footprint_cells =
      10;                  ///< pixels that cover more cells of road along the line of sight are left out, 1 … 1000
  double gate_sigmas = 4;  ///< heights that differ by more standard errors belong to another surface, 1 … 100
  /// Share of the variance of a height that all frames have in common, 0 … 1, and that therefore does not shrink with
  /// their number: the support window smooths alike in every frame. Measured on rendered roads (docs/mapping.md).
  double common_share = 0.1;
  int threads = 0;  ///< 0: all cores

  /// Throws Error naming the first option out of range.
  void validate() const;
};

/// Data of one frame that is added to a map. Views are W×H.
struct MapFrame {
  ImageView<const float> disparity;  ///< ℓ, pixels; NaN invalid
  ImageView<const float> sigma;      ///< standard error of ℓ, pixels
  FrameView image;                   ///< left image
  double white_level = 0;            ///< sample value of white, as in to_grey
  DisparityPlane road;               ///< plane of the road in ℓ
  StereoCalibration calibration;
  RigidTransform camera_to_map{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< rotation and translation; z up
};

/// State from which a map is continued, together with the tiles in its folder.
struct SavedMap {
  std::vector<std::array<int, 3>> tiles;  ///< column, row, generation of its file
  std::array<double, 3> sums{};           ///< of the errors of heights
};

/// 2.5-D map of a road: height, its standard error and colour in square cells, z up. Frames are fused cell by cell with
/// inverse variances. The standard errors are scaled by the spread of the heights and allow for the correlation between
/// successive frames; the map measures both. A cell keeps two surfaces, the one on which more frames agree and a rival,
/// so that moving objects do not remain in the map. Tiles of cells are kept on disk, the least recently used first:
/// memory is bounded.
///
/// The height of a cell in a frame is found by fixed-point iteration: the point of the surface on the line of sight
/// through the cell's centre, until the line meets the surface in the cell. Cells that the camera does not see do not
/// converge and get no height. The result does not depend on the number of threads. Not thread-safe, not even for
/// reading, which loads tiles; distinct maps are independent.
class RoadMap {
 public:
  /// Keeps its tiles in `folder`, which it creates, and removes them at the end. Tiles that an earlier map has left
  /// there are removed at once. Throws Error for options out of range, if the folder holds anything else, and if it
  /// cannot be written to.
  RoadMap(const std::filesystem::path& folder, const RoadMapOptions& options);
  /// Continues a map from `saved` and the tiles that it names. Throws Error if a tile is missing.
  RoadMap(const std::filesystem::path& folder, const RoadMapOptions& options, const SavedMap& saved);
  ~RoadMap();
  RoadMap(RoadMap&&) noexcept;
  RoadMap& operator=(RoadMap&&) noexcept;

  /// Fuses a frame. Returns the number of cells that it measures. Throws Error for an image or standard errors of
  /// another size than the disparities, for a calibration that its `validate` refuses, for a transformation that is not
  /// rigid, for one that leads too far from the origin (`max_map_cell`) or inclines the road by more than 70°,
  /// SystemError if a tile cannot be written.
  std::size_t add(const MapFrame& frame);

  /// Writes all tiles to the folder and returns the state from which the map can be continued. The files of the
  /// previous save are kept until `commit`, which is to be called once the returned state is stored. Throws SystemError
  /// on a full disk.
  SavedMap save();
  void commit();
  /// Makes the destructor leave the tiles in the folder.
  void keep();

  /// Returns the smallest box with all tiles; empty without any.
  MapBox bounds() const;
  /// Returns the boxes of the tiles.
  std::vector<MapBox> tile_boxes() const;

  /// Reads cells; those outside the map are empty. Throws Error for a box of negative size, with more than 2²⁸ cells,
  /// or beyond `max_map_cell`.
  MapRaster read(const MapBox& box) const;

  const RoadMapOptions& options() const;
  /// Returns how many successive frames count as one independent measurement of a cell, at least 1: (1 + r)/(1 − r) of
  /// the correlation r of the errors of successive frames, which the map measures.
  double view_factor() const;
  /// Returns the number of tiles, in memory and on disk.
  std::size_t tiles() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns a cell size for a camera over a road and images of width×height pixels, metres: the geometric mean of the
/// ground sampling distances in the nearest quarter of the road in view, rounded down to 1, 2 or 5 times a power of
/// ten; one that a map can have. Throws Error when no pixel of the images sees the road.
double suggested_cell_m(const DisparityPlane& road, const StereoCalibration& calibration, int width, int height);

/// Returns the transformation from a camera to axes on its road: origin at the foot of the camera, x to its right, y
/// ahead, z up (`road_axes`).
RigidTransform camera_to_road(const DisparityPlane& road, const StereoCalibration& calibration);

}  // namespace roadstereo
#pragma GCC visibility pop
