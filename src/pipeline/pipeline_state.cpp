#include <limits>

#include "core/image_limits.hpp"
#include "core/require_range.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {

void PipelineState::validate() const {
  constexpr double max_disparity_px = max_image_side, full_turn_rad = 6.3;
  if (road) {
    for (const int u : {0, width}) {
      for (const int v : {0, height}) {
        require_range("road", "disparity", road->model.disparity(u, v), -max_disparity_px, max_disparity_px);
      }
    }
    require_range("road", "inlier_share", road->inlier_share, 0.0, 1.0);
    require_range("road", "correlation", road->correlation, -1.0, 1.0);
  }
  require_range("state", "roll_rad", roll_rad, -full_turn_rad, full_turn_rad);
  require_range("state", "frames_since_rows", frames_since_rows, 0, std::numeric_limits<int>::max());
  require_range("state", "blur_px2", blur_px2, -BlurDifference::max_px2, BlurDifference::max_px2);
  require_range("state", "frames_since_blur", frames_since_blur, 0, std::numeric_limits<int>::max());
  require_range("misalignment", "largest_px", misalignment.largest_px(width, height), 0.0, Misalignment::max_px);
}

}  // namespace roadstereo
