// Figures of the paper, drawn from our data.
#pragma once

#include <vector>

#include "evaluate/kitti_frames.hpp"
#include "evaluate/methods.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Figure of results: left images of rendered roads, disparities and transformed disparities of `paper`.
Frame draw_results(const MethodSettings& methods);

/// Figure of motion blur: blurred left images and the disparities of `paper`.
Frame draw_motion_blur(const MethodSettings& methods);

/// Figure of the roll angle: left image, disparities of a rolled camera, and the same rotated by the estimated roll.
Frame draw_roll(const MethodSettings& methods);

/// Figure of the transformed KITTI truth: left image with the road in magenta, truth, transformed truth of the road.
/// At most four frames.
Frame draw_transformed_kitti(const std::vector<KittiFiles>& frames, const MethodSettings& methods);

}  // namespace roadstereo::cli
