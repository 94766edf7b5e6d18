#pragma once

#include <gst/app/gstappsink.h>

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace roadstereo::io {

/// A picture out of a pipeline.
struct PipelinePicture {
  cv::Mat samples;    ///< BGR or grey, 8 bits
  double time_s = 0;  ///< since 1970: when it was taken, of a live pipeline; else when it came
};

/// A GStreamer pipeline that ends in an appsink. OpenCV's own waits for ever for one of which an element is missing,
/// and keeps for itself what GStreamer says.
class GStreamerPipeline {
 public:
  /// Opens and starts it; adds " ! videoconvert ! appsink max-buffers=2 sync=false" when it has no appsink, which drops
  /// pictures that nobody takes when the pipeline is live. Throws Error with what GStreamer says when it is no
  /// pipeline, fails, or gives nothing within ten seconds.
  explicit GStreamerPipeline(const std::string& text);

  /// The next picture; nothing when the pipeline has ended. Throws Error when it has failed, or gives nothing for ten
  /// seconds.
  std::optional<PipelinePicture> pull();

  /// A camera, or another source that does not wait.
  bool live() const { return live_; }
  /// The text that opens messages: the pipeline "…".
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
