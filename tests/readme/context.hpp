#pragma once

#include <roadstereo/device.hpp>
#include <roadstereo/roadstereo.hpp>

// What the snippets of README take for granted: the user's calibration, pair and stream. Nothing is linked.
extern const roadstereo::StereoCalibration calibration;
extern const roadstereo::FrameView left, right, left_on_device, right_on_device;
extern CUstream_st* your_stream;
extern roadstereo::Pipeline pipeline;
