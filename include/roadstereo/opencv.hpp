#pragma once

// Conversions between cv::Mat and the views of roadstereo without copying, and a cv::StereoMatcher around the pipeline.
// Header only; the program links OpenCV (core and calib3d), roadstereo does not.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/check.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "roadstereo/error.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/pipeline.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::opencv {

/// Returns a view of a matrix of 8 or 16 bits with 1 (grey), 3 (BGR) or 4 (BGRA) channels, which may be a part of a
/// larger one. The matrix must outlive the view. Throws Error naming the type of any other matrix.
inline FrameView frame_view(const cv::Mat& image) {
  if (image.empty()) fail("the image is empty");
  const bool wide = image.depth() == CV_16U;
  const int channels = image.channels();
  if (image.dims != 2 || (image.depth() != CV_8U && !wide) || (channels != 1 && channels != 3 && channels != 4)) {
    fail("the image is a matrix of type ", cv::typeToString(image.type()), " with ", image.dims,
         " dimensions; it must be of type CV_8U or CV_16U with 1, 3 (BGR) or 4 (BGRA) channels and have 2 dimensions");
  }
  const ChannelOrder order = channels == 1   ? ChannelOrder::grey
                             : channels == 3 ? ChannelOrder::bgr
                                             : ChannelOrder::bgra;
  return {image.data,
          image.cols,
          image.rows,
          static_cast<std::ptrdiff_t>(image.step[0]),
          wide ? SampleType::u16 : SampleType::u8,
          order};
}

/// Returns a matrix header over a map, without a copy: CV_32FC1, CV_16SC1, CV_16UC1 or CV_8UC1, depending on the type
/// of its values. The map must outlive the matrix. Do not write to a matrix of a const map.
template <class T>
cv::Mat mat_view(ImageView<T> map) {
  using Value = std::remove_const_t<T>;
  if (map.empty()) return {};
  return {map.height(), map.width(), cv::traits::Type<Value>::value, const_cast<Value*>(map.data()),
          static_cast<std::size_t>(map.stride()) * sizeof(Value)};
}
template <class T>
cv::Mat mat_view(Image<T>& map) {
  return mat_view(map.view());
}
template <class T>
cv::Mat mat_view(const Image<T>& map) {
  return mat_view(map.view());
}
template <class T>
cv::Mat mat_view(const Image<T>&& map) = delete;

/// The pipeline as a cv::StereoMatcher. The search range is derived from the images, the road is tracked from pair to
/// pair. Takes rectified 8- or 16-bit images with 1, 3 or 4 channels. Errors are roadstereo::Error.
class StereoMatcher final : public cv::StereoMatcher {
 public:
  /// Makes a matcher with a preset, "default", "fast" or "paper". A calibration, if given, must be that of the images.
  static cv::Ptr<StereoMatcher> create(const std::string& preset_name = "default",
                                       const std::optional<StereoCalibration>& calibration = std::nullopt) {
    return create(preset(preset_name), calibration);
  }
  /// The same with these options.
  static cv::Ptr<StereoMatcher> create(const PipelineOptions& options,
                                       const std::optional<StereoCalibration>& calibration = std::nullopt) {
    return cv::makePtr<StereoMatcher>(options, calibration);
  }

  /// As `create`.
  StereoMatcher(const PipelineOptions& options, const std::optional<StereoCalibration>& calibration)
      : calibration_(calibration), pipeline_(options, calibration) {}

  /// Computes left-image disparities: CV_16SC1, pixels times 16; (minDisparity − 1)·16 is invalid. Throws Error as
  /// `Pipeline::process`.
  void compute(cv::InputArray left, cv::InputArray right, cv::OutputArray disparity) override {
    const cv::Mat left_image = left.getMat(), right_image = right.getMat();
    try {
      pipeline_.process(frame_view(left_image), frame_view(right_image), result_);
    } catch (...) {
      result_ = {};  // not that of an earlier pair
      throw;
    }
    disparity.create(left_image.size(), CV_16SC1);
    cv::Mat fixed = disparity.getMat();
    for (int v = 0; v < fixed.rows; ++v) {
      auto* out = fixed.ptr<std::int16_t>(v);
      for (int u = 0; u < fixed.cols; ++u) out[u] = fixed_point(result_.disparity(u, v));
    }
    if (speckle_window_size_ > 0) {
      cv::filterSpeckles(fixed, invalid(), speckle_window_size_, speckle_range_ * DISP_SCALE);
    }
  }

  /// Returns the whole result of the last pair: float disparities, standard errors, roll, road, transformed map.
  const FrameResult& result() const { return result_; }
  /// Returns the damage of the last pair. Throws Error if there is none, or its last `compute` failed, and as
  /// `Pipeline::find_damage`.
  DamageMap find_damage() const {
    const PipelineOptions& options = pipeline_.options();
    return roadstereo::find_damage(result_, calibration_, options.damage, options.threads);
  }

  /// Smaller disparities are invalid, pixels, −2047 … 2047; 0 by default. The setter throws Error for other values.
  int getMinDisparity() const override { return min_disparity_; }
  void setMinDisparity(int minDisparity) override {
    require(minDisparity, -max_disparity, max_disparity, "minDisparity");
    min_disparity_ = minDisparity;
  }

  /// Disparities of at least minDisparity + numDisparities are invalid, pixels, 0 … 4094; 0, the default, is no limit.
  /// The setter throws Error for other values.
  int getNumDisparities() const override { return num_disparities_; }
  void setNumDisparities(int numDisparities) override {
    require(numDisparities, 0, 2 * max_disparity, "numDisparities");
    num_disparities_ = numDisparities;
  }

  /// The width of the correlation block, pixels: 2·block_radius + 1, odd, 3 … 21; block_aspect gives its height. A new
  /// value ends the tracking of the road. The setter throws Error for other values.
  int getBlockSize() const override { return 2 * pipeline_.options().matcher.block_radius + 1; }
  void setBlockSize(int blockSize) override {
    if (blockSize % 2 == 0) fail("blockSize is ", blockSize, "; it must be odd");
    PipelineOptions options = pipeline_.options();
    options.matcher.block_radius = blockSize / 2;
    pipeline_ = Pipeline(options, calibration_);
  }

  /// Connected components of at most this many pixels are invalid (cv::filterSpeckles); 0, the default, keeps all.
  int getSpeckleWindowSize() const override { return speckle_window_size_; }
  void setSpeckleWindowSize(int speckleWindowSize) override { speckle_window_size_ = speckleWindowSize; }

  /// Largest difference of neighbours in one connected component, pixels; 1 by default.
  int getSpeckleRange() const override { return speckle_range_; }
  void setSpeckleRange(int speckleRange) override { speckle_range_ = speckleRange; }

  /// The largest difference of the left-right check in whole pixels, at least 1; 0 or less: no check. A new value ends
  /// the tracking of the road.
  int getDisp12MaxDiff() const override {
    const MatcherOptions& matcher = pipeline_.options().matcher;
    return matcher.left_right_check ? std::max(1, static_cast<int>(std::lround(matcher.lr_max_diff_px))) : -1;
  }
  void setDisp12MaxDiff(int disp12MaxDiff) override {
    PipelineOptions options = pipeline_.options();
    options.matcher.left_right_check = disp12MaxDiff > 0;
    if (disp12MaxDiff > 0) options.matcher.lr_max_diff_px = disp12MaxDiff;
    pipeline_ = Pipeline(options, calibration_);
  }

 private:
  static constexpr int largest = std::numeric_limits<std::int16_t>::max();
  static constexpr int max_disparity = largest / DISP_SCALE;

  static void require(int value, int min, int max, const char* name) {
    if (value < min || value > max) fail(name, " is ", value, "; it must be between ", min, " and ", max);
  }

  int invalid() const { return (min_disparity_ - 1) * DISP_SCALE; }

  std::int16_t fixed_point(float disparity_px) const {
    const float scaled = std::round(disparity_px * float{DISP_SCALE});
    const int first = min_disparity_ * DISP_SCALE;
    const int last = num_disparities_ > 0 ? first + num_disparities_ * DISP_SCALE - 1 : largest;
    const bool inside = scaled >= static_cast<float>(first) && scaled <= static_cast<float>(std::min(last, largest));
    return static_cast<std::int16_t>(inside ? static_cast<int>(scaled) : invalid());
  }

  std::optional<StereoCalibration> calibration_;
  Pipeline pipeline_;
  FrameResult result_;
  int min_disparity_ = 0;
  int num_disparities_ = 0;
  int speckle_window_size_ = 0;
  int speckle_range_ = 1;
};

}  // namespace roadstereo::opencv
#pragma GCC visibility pop
