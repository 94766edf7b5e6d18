#pragma once

#include <opencv2/core.hpp>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// Draws the outline of a damage in its colour on a dark line, `line` pixels wide. The canvas shows the image from
/// `origin` on, enlarged by `scale`.
void draw_outline(cv::Mat& canvas, const DamageMap& map, const Damage& damage, int line, cv::Point origin = {},
                  double scale = 1);

}  // namespace roadstereo::io
