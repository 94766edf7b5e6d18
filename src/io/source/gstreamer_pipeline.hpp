#pragma once

#include <gst/app/gstappsink.h>

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace roadstereo::io {

/// An image of a pipeline.
struct PipelinePicture {
  cv::Mat samples;    ///< BGR or grey, 8 bits
  double time_s = 0;  ///< capture time since 1970 if live, else that of the recording, from 0; NaN unknown
};

/// A GStreamer pipeline that ends in an appsink. Used instead of OpenCV's capture, which hangs if an element is missing
/// and does not report GStreamer's errors.
class GStreamerPipeline {
 public:
  /// Opens and starts the pipeline; appends " ! videoconvert ! appsink max-buffers=2 sync=false" if it has no appsink.
  /// A live pipeline drops images that are not read in time. Throws Error with GStreamer's message if the text is not a
  /// pipeline, or if it fails or delivers nothing within ten seconds.
  explicit GStreamerPipeline(const std::string& text);

  /// Returns the next image, or nullopt at the end. Throws Error if the pipeline has failed, or delivers nothing for
  /// ten seconds.
  std::optional<PipelinePicture> pull();

  /// Whether the source is a camera or another one that does not wait.
  bool live() const { return live_; }
  /// Start of error messages: the pipeline "…".
  const std::string& name() const { return name_; }

 private:
  struct Stop {
    void operator()(GstElement* pipeline) const;
  };
  struct Unref {
    void operator()(void* object) const;
  };

  void parse(const std::string& text);
  void start(bool drop_when_live);
  void throw_failure() const;
  double taken_at(const GstBuffer* buffer) const;

  std::string name_;
  std::unique_ptr<GstElement, Stop> pipeline_;
  std::unique_ptr<GstAppSink, Unref> sink_;
  bool live_ = false;
};

}  // namespace roadstereo::io
