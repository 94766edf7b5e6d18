#include <chrono>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "io/source/gstreamer_check.hpp"
#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::string with_sink(const std::string& pipeline) {
  if (pipeline.find("appsink") != std::string::npos) return pipeline;
  return pipeline + " ! videoconvert ! appsink drop=true max-buffers=2 sync=false";
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A pipeline that ends, ends: OpenCV does not tell the end of a file from a camera that is gone. `next` returns
/// nothing, and the caller, who knows what the pipeline is, reopens it or does not. A pair's time is when it arrived.
class GStreamerSource final : public FrameSource {
 public:
  GStreamerSource(const std::string& pipeline, const SourceOptions& options)
      : source_("the pipeline \"" + pipeline + "\""), wanted_layout_(options.layout) {
    if (!cv::videoio_registry::hasBackend(cv::CAP_GSTREAMER)) {
      fail(source_, " cannot be opened: this OpenCV was built without GStreamer");
    }
    check_pipeline(source_, with_sink(pipeline));
    if (!capture_.open(with_sink(pipeline), cv::CAP_GSTREAMER)) {
      fail(source_, " cannot be opened: its elements do not fit each other, or there is no camera; ",
           "OPENCV_LOG_LEVEL=WARNING shows what GStreamer says");
    }
  }

  std::optional<SourcePair> next() override {
    if (!capture_.grab()) return std::nullopt;
    SourcePair pair = numbered_pair(index_++, 0);
    pair.time_s = now_s();
    cv::Mat picture;
    if (!capture_.retrieve(picture) || picture.empty()) {
      pair.refused = "the picture is of a kind that OpenCV does not take from GStreamer";
    } else {
      const StereoLayout layout = find_layout(source_, picture.cols, picture.rows, wanted_layout_);
      split_views(source_, picture, layout, pair);
    }
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0 && capture_.grab(); --pairs) ++index_;
  }

  std::optional<std::int64_t> size() const override { return std::nullopt; }
  bool live() const override { return true; }
  std::string description() const override { return "GStreamer pipeline"; }

 private:
  std::string source_;
  StereoLayout wanted_layout_;
  cv::VideoCapture capture_;
  std::int64_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_gstreamer(const std::string& pipeline, const SourceOptions& options) {
  return std::make_unique<GStreamerSource>(pipeline, options);
}

}  // namespace roadstereo::io
