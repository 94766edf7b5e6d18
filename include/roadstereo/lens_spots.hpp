#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "roadstereo/cell_levels.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Spots of a view whose grey levels stay the same while the image around them changes: dirt on the lens and dead
/// pixels. NaN: not known yet, or there is no such spot.
struct LensSpots {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double dirt = unknown;  ///< number of connected places
  double dead_pixels =
      unknown;                  ///< number of pixels that are brighter, or darker, than their neighbours in every frame
  double dead_share = unknown;  ///< of all pixels
  double largest_u = unknown;   ///< centre of the largest place of dirt, else the first dead pixel; pixels
  double largest_v = unknown;
};

/// Watches one view of a recording for dirt on its lens and for dead pixels. A frame counts when more than half of the
/// image has changed since the last frame that counted, so that frames at a standstill are ignored.
class LensWatch {
 public:
  /// Adds the next frame, in 1/16 grey level. A frame of another size starts over. Allocates memory only for the first
  /// frame and after a change of size.
  void add(ImageView<const std::int16_t> grey);

  /// Spots after the last multiple of 20 frames that counted; all NaN before the 20th.
  const LensSpots& spots() const { return spots_; }

 private:
  /// One bit per pixel, set for those that are brighter, or darker, than their neighbours.
  using Extremes = Image<std::uint64_t>;

  void begin(int width, int height);
  void add_extremes(ImageView<const std::int16_t> grey);
  bool stands_out(int x, int y, int reach) const;
  void find_steady_cells();
  void count_dirt();
  bool is_moving(int u, int v) const;
  void count_dead_pixels();

  static constexpr double moving_share = 0.5;  ///< of the image, from which on a frame counts

  CellLevels levels_{moving_share};
  int width_ = 0, height_ = 0;
  Image<float> deviation_;      ///< of every cell over the frames
  Image<std::uint8_t> steady_;  ///< cells of places: how many cells off they stand out; 0: other cells
  Extremes brighter_, darker_;  ///< in every frame since the last count
  std::vector<int> pending_;    ///< cells of a place whose neighbours are to be looked at
  LensSpots spots_;
};

/// Spots of both lenses.
struct PairSpots {
  LensSpots left, right;
};

/// Watches both views. An empty view is ignored.
class PairWatch {
 public:
  PairSpots add(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right) {
    if (left.width() > 0) left_.add(left);
    if (right.width() > 0) right_.add(right);
    return {left_.spots(), right_.spots()};
  }

 private:
  LensWatch left_, right_;
};

}  // namespace roadstereo
#pragma GCC visibility pop
