#include "core/require_range.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

void TrackOptions::validate() const {
  require_range("track", "max_gap_s", max_gap_s, 0.001, 3600.0);
  require_range("track", "min_heading_distance_m", min_heading_distance_m, 0.01, 1000.0);
  require_range("track", "heading_window_s", heading_window_s, 0.001, 3600.0);
  require_range("track", "mount_yaw_deg", mount_yaw_deg, -360.0, 360.0);
}

}  // namespace roadstereo::io
