#include "io/frame_mat.hpp"

#include <cstring>
#include <opencv2/imgproc.hpp>

namespace roadstereo::io {

cv::Mat mat_over(const FrameView& frame) {
  const int depth = frame.sample == SampleType::u16 ? CV_16U : CV_8U;
  return {frame.height, frame.width, CV_MAKETYPE(depth, channel_count(frame.order)), const_cast<void*>(frame.data),
          static_cast<std::size_t>(frame.stride_bytes)};
}

cv::Mat mat_over(ImageView<const float> map) {
  if (map.empty()) return {};
  const auto stride_bytes = static_cast<std::size_t>(map.stride()) * sizeof(float);
  return {map.height(), map.width(), CV_32FC1, const_cast<float*>(map.row(0)), stride_bytes};
}

Frame frame_from(const cv::Mat& mat, ChannelOrder order) {
  Frame frame;
  frame.width = mat.cols;
  frame.height = mat.rows;
  frame.sample = mat.depth() == CV_16U ? SampleType::u16 : SampleType::u8;
  frame.order = order;
  const std::size_t row_bytes = static_cast<std::size_t>(mat.cols) * mat.elemSize();
  frame.bytes.resize(row_bytes * static_cast<std::size_t>(mat.rows));
  for (int v = 0; v < mat.rows; ++v) {
    std::memcpy(frame.bytes.data() + row_bytes * static_cast<std::size_t>(v), mat.ptr(v), row_bytes);
  }
  return frame;
}

cv::Mat to_bgr(const FrameView& frame, double white_level) {
  constexpr double largest = 65535;
  const double white = white_level > 0 ? white_level : largest;
  cv::Mat narrow;
  mat_over(frame).convertTo(narrow, CV_8U, frame.sample == SampleType::u16 ? 255 / white : 1.0);
  cv::Mat bgr;
  switch (frame.order) {
    case ChannelOrder::grey:
      cv::cvtColor(narrow, bgr, cv::COLOR_GRAY2BGR);
      break;
    case ChannelOrder::rgb:
      cv::cvtColor(narrow, bgr, cv::COLOR_RGB2BGR);
      break;
    case ChannelOrder::bgra:
      cv::cvtColor(narrow, bgr, cv::COLOR_BGRA2BGR);
      break;
    case ChannelOrder::rgba:
      cv::cvtColor(narrow, bgr, cv::COLOR_RGBA2BGR);
      break;
    case ChannelOrder::bgr:
      bgr = narrow;
      break;
  }
  return bgr;
}

}  // namespace roadstereo::io
