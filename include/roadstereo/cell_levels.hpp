#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Grey levels of one view of a recording, averaged over square cells: mean and variance of each cell over the frames
/// that count. There are at least 160 cells across, or one per column in narrower images. A frame counts when enough of
/// the picture has changed since the last frame that counted, since a vehicle at a standstill gives no information
/// about what never moves.
class CellLevels {
 public:
  /// `moving_share`: share of the cells, 0 … 1, that must have changed by more than two of 255 grey levels for a frame
  /// to count.
  explicit CellLevels(double moving_share) : moving_share_(moving_share) {}

  /// Adds the next frame, in 1/16 grey level. Returns whether it counts. A frame of another size starts over. Allocates
  /// memory only for the first frame and after a change of size.
  bool add(ImageView<const std::int16_t> grey);

  int frames() const { return frames_; }    ///< that counted
  int cell_px() const { return cell_px_; }  ///< side of a cell; the remainder at the right and lower border is ignored
  const Image<float>& mean() const { return mean_; }          ///< of each cell, 1/16 grey level, over about 100 frames
  const Image<float>& variance() const { return variance_; }  ///< likewise, in the square of that unit

 private:
  void begin(int width, int height);
  void average_cells(ImageView<const std::int16_t> grey);
  bool has_moved() const;
  void add_levels();

  double moving_share_;
  int cell_px_ = 1, width_ = 0, height_ = 0;
  int frames_ = 0;
  Image<float> cells_;  ///< mean levels of the cells of the frame
  Image<float> last_;   ///< of the last frame that counted
  Image<float> mean_, variance_;
  std::vector<int> sums_;  ///< over the rows of a cell
};

}  // namespace roadstereo
#pragma GCC visibility pop
