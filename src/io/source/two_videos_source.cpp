#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"
#include "io/source/video_file.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

void check_sizes(const VideoFile& left, const VideoFile& right) {
  if (left.width() == right.width() && left.height() == right.height()) return;
  fail(right.name(), ": the video has ", right.width(), "×", right.height(), " pixels, but ", left.name(), " has ",
       left.width(), "×", left.height());
}

/// Pairing by frame number requires equal rates.
void check_rates(const VideoFile& left, const VideoFile& right) {
  constexpr double tolerance = 1e-4;  // containers round rates
  if (std::abs(left.rate_hz() - right.rate_hz()) <= tolerance * left.rate_hz()) return;
  fail(right.name(), ": the video has ", right.rate_hz(), " frames per second, but ", left.name(), " has ",
       left.rate_hz(), "; if both cameras were triggered together, set the rate with --rate");
}

class TwoVideosSource final : public FrameSource {
 public:
  TwoVideosSource(const std::string& left, const std::string& right, const SourceOptions& options)
      : left_(left), right_(right), rate_hz_(options.rate_hz > 0 ? options.rate_hz : left_.rate_hz()) {
    check_sizes(left_, right_);
    if (options.rate_hz == 0) check_rates(left_, right_);
  }

  std::optional<SourcePair> next() override {
    if (ended_) return std::nullopt;
    SourcePair pair = numbered_pair(index_, rate_hz_);
    const bool has_left = left_.grab();
    const bool has_right = right_.grab();
    if (!has_left && !has_right) {
      ended_ = true;
      return early_end(std::move(pair));
    }
    ++index_;
    if (has_left && has_right) {
      read_views(pair);
    } else {
      pair.error = (has_left ? right_ : left_).name() + " has ended after " +
                   std::to_string(std::min(left_.grabbed(), right_.grabbed())) + " frames";
    }
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0; --pairs, ++index_) {
      const bool has_left = left_.grab();
      const bool has_right = right_.grab();
      if (!has_left && !has_right) return;
    }
  }

  std::optional<std::int64_t> size() const override {
    if (!left_.stated_pictures() || !right_.stated_pictures()) return std::nullopt;
    return std::max(*left_.stated_pictures(), *right_.stated_pictures());
  }

  std::string description() const override {
    std::ostringstream text;
    text << "two videos, ";
    if (const auto pairs = size()) text << *pairs << " pairs of ";
    text << left_.width() << "×" << left_.height();
    return text.str();
  }

 private:
  void read_views(SourcePair& pair) {
    const cv::Mat left = left_.picture();
    const cv::Mat right = right_.picture();
    if (left.empty() || right.empty()) {
      pair.error = "the frame of " + (left.empty() ? left_ : right_).name() + " cannot be decoded";
      return;
    }
    pair.left = picture_frame(left_.name(), left);
    pair.right = picture_frame(right_.name(), right);
  }

  std::optional<SourcePair> early_end(SourcePair pair) const {
    const VideoFile& worse = left_.missing_pictures() >= right_.missing_pictures() ? left_ : right_;
    const std::int64_t missing = worse.missing_pictures();
    if (missing == 0) return std::nullopt;
    pair.error = worse.name() + " ends " + std::to_string(missing) + " frames before its stated length of " +
                 std::to_string(worse.grabbed() + missing) + "; it is damaged or truncated";
    return pair;
  }

  VideoFile left_;
  VideoFile right_;
  double rate_hz_;
  std::int64_t index_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> open_two_videos(const std::string& left, const std::string& right,
                                             const SourceOptions& options) {
  return std::make_unique<TwoVideosSource>(left, right, options);
}

}  // namespace roadstereo::io
