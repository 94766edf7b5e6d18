#pragma once

#include <opencv2/core.hpp>
#include <roadstereo/device.hpp>
#include <roadstereo/roadstereo.hpp>

// What the snippets of README take for granted: the user's calibration, images and stream. Nothing is linked.
extern const roadstereo::StereoCalibration calibration;
extern const cv::Mat left_image, right_image;
extern const roadstereo::FrameView left_on_device, right_on_device;
extern CUstream_st* your_stream;
extern roadstereo::Pipeline pipeline;
