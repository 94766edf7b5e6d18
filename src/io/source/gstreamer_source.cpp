#include "io/source/gstreamer_pipeline.hpp"
#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"

namespace roadstereo::io {
namespace {

/// A pipeline that plays a file ends; one whose camera is unplugged fails.
class GStreamerSource final : public FrameSource {
 public:
  GStreamerSource(const std::string& pipeline, const SourceOptions& options)
      : pipeline_(pipeline), wanted_layout_(options.layout), rate_hz_(pipeline_.live() ? 0 : options.rate_hz) {}

  std::optional<SourcePair> next() override {
    const std::optional<PipelinePicture> picture = pipeline_.pull();
    if (!picture) return std::nullopt;
    SourcePair pair = numbered_pair(index_++, rate_hz_);
    if (rate_hz_ == 0) pair.time_s = picture->time_s;
    if (picture->samples.empty()) {
      pair.error = "the output of the pipeline is not an image";
      return pair;
    }
    const cv::Mat& samples = picture->samples;
    split_views(pipeline_.name(), samples, find_layout(pipeline_.name(), samples.cols, samples.rows, wanted_layout_),
                pair);
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0 && pipeline_.pull(); --pairs) ++index_;
  }

  std::optional<std::int64_t> size() const override { return std::nullopt; }
  bool live() const override { return pipeline_.live(); }
  std::string description() const override {
    return pipeline_.live() ? "live GStreamer pipeline" : "GStreamer pipeline";
  }

 private:
  GStreamerPipeline pipeline_;
  StereoLayout wanted_layout_;
  double rate_hz_;  ///< 0: the times of the pipeline, as a camera has them
  std::int64_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_gstreamer(const std::string& pipeline, const SourceOptions& options) {
  return std::make_unique<GStreamerSource>(pipeline, options);
}

}  // namespace roadstereo::io
