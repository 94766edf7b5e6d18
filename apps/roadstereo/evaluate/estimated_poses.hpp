#pragma once

#include <functional>
#include <vector>

#include "roadstereo/pipeline.hpp"
#include "roadstereo/pose_graph.hpp"
#include "roadstereo/road_map.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// Poses that odometry, loops and positions find for rendered frames, of which `scene_of` has the scene. Positions are
/// those of the camera in the axes of the road with noise of 0.1 m per axis, ten a second like the frames. Adds the
/// loops to `loops`. Throws Error if the positions do not place every frame, or without Ceres.
std::vector<RigidTransform> estimated_poses(int frames, const std::function<synth::Scene(int)>& scene_of,
                                            const PipelineOptions& options, std::vector<LoopLink>& loops);

}  // namespace roadstereo::cli
