#include <sstream>

#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"
#include "io/source/video_file.hpp"

namespace roadstereo::io {
namespace {

/// Times follow from a constant rate: FFmpeg's times, as OpenCV returns them, are wrong if the codec reorders frames.
class VideoSource final : public FrameSource {
 public:
  VideoSource(const std::string& file, const SourceOptions& options)
      : video_(file),
        layout_(find_layout(file, video_.width(), video_.height(), options.layout)),
        rate_hz_(options.rate_hz > 0 ? options.rate_hz : video_.rate_hz()) {}

  std::optional<SourcePair> next() override {
    if (ended_) return std::nullopt;
    SourcePair pair = numbered_pair(video_.grabbed(), rate_hz_);
    if (!video_.grab()) {
      ended_ = true;
      return early_end(std::move(pair));
    }
    const cv::Mat picture = video_.picture();
    if (picture.empty()) {
      pair.error = "the frame cannot be decoded";
    } else {
      split_views(video_.name(), picture, layout_, pair);
    }
    return pair;
  }

  void skip(std::int64_t pairs) override {
    while (pairs > 0 && video_.grab()) --pairs;
  }

  std::optional<std::int64_t> size() const override { return video_.stated_pictures(); }

  std::string description() const override {
    std::ostringstream text;
    text << "video, ";
    if (const auto pairs = size()) text << *pairs << " pairs of ";
    text << video_.width() << "×" << video_.height()
         << (layout_ == StereoLayout::side_by_side ? " side by side" : " one above the other");
    return text.str();
  }

 private:
  std::optional<SourcePair> early_end(SourcePair pair) const {
    const std::int64_t missing = video_.missing_pictures();
    if (missing == 0) return std::nullopt;
    pair.error = "the video ends " + std::to_string(missing) + " frames before its stated length of " +
                 std::to_string(video_.grabbed() + missing) + "; it is damaged or truncated";
    return pair;
  }

  VideoFile video_;
  StereoLayout layout_;
  double rate_hz_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const std::string& file, const SourceOptions& options) {
  return std::make_unique<VideoSource>(file, options);
}

}  // namespace roadstereo::io
