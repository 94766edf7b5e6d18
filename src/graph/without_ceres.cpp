// Replacement for builds without Ceres.

#include "roadstereo/error.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {

bool has_pose_graph() {
  return false;
}

PoseGraphResult optimise_poses(const PoseGraphInput& /*input*/, const PoseGraphOptions& /*options*/) {
  fail("this build has no pose graph; it needs the package libceres-dev, 2.1 or newer, and CMake's ",
       "-DROADSTEREO_CERES=ON");
}

}  // namespace roadstereo
