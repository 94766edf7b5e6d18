#include "roadstereo/static_mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "pipeline/still_cells.hpp"

namespace roadstereo {
namespace {

/// Of the picture that must change for a frame to count: a sky and a bonnet do not.
constexpr double least_moving_share = 0.25;

/// Paints cells into a mask of pixels, grown by a margin.
class CellPainter {
 public:
  CellPainter(int cell_px, int margin_px, Image<std::uint8_t>& mask)
      : cell_px_(cell_px), margin_px_(margin_px), mask_(mask) {}

  double centre(int cell) const { return cell_px_ * (cell + 0.5) - 0.5; }

  /// The cell in column `x` and row `y`, moved by `shift_px` columns.
  void paint(int x, int y, int shift_px) {
    const int first_u = cell_px_ * x + shift_px - margin_px_, last_u = cell_px_ * (x + 1) + shift_px + margin_px_;
    const int first_v = cell_px_ * y - margin_px_, last_v = cell_px_ * (y + 1) + margin_px_;
    for (int v = std::max(0, first_v); v < std::min(mask_.height(), last_v); ++v) {
      for (int u = std::max(0, first_u); u < std::min(mask_.width(), last_u); ++u) mask_(u, v) = 255;
    }
  }

 private:
  int cell_px_, margin_px_;
  Image<std::uint8_t>& mask_;
};

bool is_empty(const Image<std::uint8_t>& mask) {
  for (int v = 0; v < mask.height(); ++v) {
    if (std::any_of(mask.row(v), mask.row(v) + mask.width(), [](std::uint8_t pixel) { return pixel != 0; }))
      return false;
  }
  return true;
}

void paint_left(const Image<std::uint8_t>& still, const std::optional<DisparityPlane>& road, double at_infinity_px,
                CellPainter& painter) {
  for (int y = 0; y < still.height(); ++y) {
    for (int x = 0; x < still.width(); ++x) {
      if (still(x, y) == 0) continue;
      if (!road || road->disparity(painter.centre(x), painter.centre(y)) > at_infinity_px) painter.paint(x, y, 0);
    }
  }
}

/// Where the left camera sees the road that these cells hide from the right one: u − d(u, v) is theirs.
void paint_right(const Image<std::uint8_t>& still, const DisparityPlane& road, double at_infinity_px,
                 CellPainter& painter) {
  for (int y = 0; y < still.height(); ++y) {
    for (int x = 0; x < still.width(); ++x) {
      if (still(x, y) == 0) continue;
      const double disparity = road.disparity(painter.centre(x), painter.centre(y)) / (1 - road.a2);
      if (disparity > at_infinity_px) painter.paint(x, y, static_cast<int>(std::lround(disparity)));
    }
  }
}

}  // namespace

void StaticMaskOptions::validate() const {
  require_range("static_mask", "frames", frames, 10, 100);
  require_range("static_mask", "max_variance_ratio", max_variance_ratio, 0.001, 1.0);
  require_range("static_mask", "margin_px", margin_px, 0, 100);
}

StaticMask::StaticMask(const StaticMaskOptions& options)
    : options_(options), left_(least_moving_share), right_(least_moving_share) {
  options.validate();
}

bool StaticMask::add(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                     const std::optional<DisparityPlane>& road, double at_infinity_px) {
  require_one_size({left.width(), left.height()}, {right.width(), right.height()});
  if (judged_) return false;
  left_.add(left);
  right_.add(right);
  const int frames = std::min(left_.frames(), right_.frames());
  if (frames == 1) has_half_ = false;  // another size begins anew
  // In noise a vehicle that stands seems to move a little: the first half alone must move, too.
  const bool is_half = !has_half_ && frames >= options_.frames / 2;
  if (!is_half && frames < options_.frames) return false;
  const auto still_left = find_still_cells(left_, options_.max_variance_ratio);
  const auto still_right = find_still_cells(right_, options_.max_variance_ratio);
  if (!still_left || !still_right) {  // anew
    left_ = CellLevels(least_moving_share);
    right_ = CellLevels(least_moving_share);
    has_half_ = false;
    return false;
  }
  has_half_ = true;
  if (frames < options_.frames) return false;
  judged_ = true;
  mask_.assign(left.width(), left.height(), 0);
  // A cell at the edge of what is still moves in part.
  CellPainter painter(left_.cell_px(), options_.margin_px + left_.cell_px(), mask_);
  paint_left(*still_left, road, at_infinity_px, painter);
  if (road) paint_right(*still_right, *road, at_infinity_px, painter);
  if (is_empty(mask_)) mask_ = {};
  return true;
}

double StaticMask::share() const {
  std::size_t masked = 0;
  for (int v = 0; v < mask_.height(); ++v) {
    masked += static_cast<std::size_t>(
        std::count_if(mask_.row(v), mask_.row(v) + mask_.width(), [](std::uint8_t pixel) { return pixel != 0; }));
  }
  return mask_.empty() ? 0 : static_cast<double>(masked) / static_cast<double>(mask_.pixels());
}

}  // namespace roadstereo
