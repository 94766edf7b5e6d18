#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Grey levels of one view of a recording in square cells, at least 160 across: mean and variance of each over the
/// frames that count. A frame counts when enough of the picture has changed since the last one that did: what never
/// moves because the vehicle stands still tells nothing.
class CellLevels {
 public:
  /// `moving_share`: of the cells that must have changed by more than two grey levels of 255, 0 … 1.
  explicit CellLevels(double moving_share) : moving_share_(moving_share) {}

  /// Adds the next frame. Returns whether it counts. Allocates only for the first one, or when the size changes, which
  /// begins anew.
  bool add(ImageView<const std::int16_t> grey);

  int frames() const { return frames_; }    ///< that counted
  int cell_px() const { return cell_px_; }  ///< side of a cell; what is left at the right and lower border is in none
  const Image<float>& mean() const { return mean_; }          ///< of each cell over the last frames, about 100
  const Image<float>& variance() const { return variance_; }  ///< the same

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
