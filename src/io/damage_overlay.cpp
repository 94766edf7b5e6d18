#include "roadstereo/io/damage_overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "io/damage_outline.hpp"
#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

const cv::Scalar dark{20, 20, 20};

std::string label_of(const Damage& damage) {
  const bool metric = damage.metrics.has_value();
  const double depth = metric ? damage.metrics->max_depth_m.value * 1000 : damage.max_depth_px.value;
  const std::string sign = damage.kind == DamageKind::protrusion ? "+" : "";
  return std::to_string(damage.id) + ": " + sign +
         number_text(std::abs(depth), metric ? 0 : (std::abs(depth) < 1 ? 2 : 1)) + (metric ? " mm" : " px");
}

cv::Rect box_of(const Damage& damage) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  return {cv::Point(u0, v0), cv::Point(u1 + 1, v1 + 1)};
}

/// Places labels next to boxes without overlap.
class LabelPlacer {
 public:
  LabelPlacer(cv::Size picture, int gap) : picture_(picture), gap_(gap) {}

  cv::Rect take(const cv::Rect& box, cv::Size label) {
    cv::Rect best;
    int min_covered = std::numeric_limits<int>::max();
    for (const cv::Rect& position : candidates(box, label)) {
      const int covered = overlap(position);
      if (covered < min_covered) best = position;
      min_covered = std::min(min_covered, covered);
    }
    taken_.push_back(best);
    return best;
  }

 private:
  /// Candidates: above, below, right, left, centre; then further up and down.
  std::vector<cv::Rect> candidates(const cv::Rect& box, cv::Size label) const {
    const int x = box.x + (box.width - label.width) / 2, y = box.y + (box.height - label.height) / 2;
    const int above = box.y - gap_ - label.height, below = box.br().y + gap_;
    std::vector<cv::Point> corners{
        {x, above}, {x, below}, {box.br().x + gap_, y}, {box.x - gap_ - label.width, y}, {x, y}};
    constexpr int further = 4;
    for (int i = 1; i <= further; ++i) {
      corners.emplace_back(x, above - i * (label.height + gap_));
      corners.emplace_back(x, below + i * (label.height + gap_));
    }
    std::vector<cv::Rect> positions;
    positions.reserve(corners.size());
    for (const cv::Point& corner : corners) positions.push_back(inside({corner, label}));
    return positions;
  }

  cv::Rect inside(cv::Rect position) const {
    position.x = std::clamp(position.x, gap_, std::max(gap_, picture_.width - position.width - gap_));
    position.y = std::clamp(position.y, gap_, std::max(gap_, picture_.height - position.height - gap_));
    return position;
  }

  int overlap(const cv::Rect& position) const {
    int area = 0;
    for (const cv::Rect& other : taken_) area += (position & other).area();
    return area;
  }

  cv::Size picture_;
  int gap_;
  std::vector<cv::Rect> taken_;
};

}  // namespace

Frame damage_overlay(const FrameView& picture, double white_level, const DamageMap& map) {
  if (picture.width != map.ids.width() || picture.height != map.ids.height()) {
    fail("the image has ", picture.width, "×", picture.height, " pixels, but the damage map has ", map.ids.width(), "×",
         map.ids.height());
  }
  cv::Mat canvas = to_bgr(picture, white_level);
  const int letters = text_height_for(std::min(canvas.rows, canvas.cols));
  const int line = std::max(1, cvRound(letters / 7.0));
  for (const Damage& damage : map.damages) draw_outline(canvas, map, damage, line);
  LabelPlacer positions(canvas.size(), line + 2);
  const cv::Scalar white{255, 255, 255};
  for (const Damage& damage : map.damages) {
    const std::string text = label_of(damage);
    const int width = text_width(text, letters);
    const cv::Rect position = positions.take(box_of(damage), {width + 2 * line, letters + letters / 2});
    put_haloed_text(canvas, text, {position.x + line, position.y + letters + letters / 4}, letters, white, dark);
  }
  return frame_from(canvas, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
