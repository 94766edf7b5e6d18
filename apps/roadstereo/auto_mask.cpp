#include "auto_mask.hpp"

#include <fmt/core.h>

#include <utility>

#include "json_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

void AutoMask::restore(const io::StaticMaskRecord& record, Image<std::uint8_t> mask) {
  record_ = record;
  mask_ = std::move(mask);
}

bool AutoMask::add(const FrameView& left, const FrameView& right, double white_level,
                   const std::optional<DisparityPlane>& road, double at_infinity_px) {
  if (!on_ || record_.judged) return false;
  if (white_level != white_level_) watch_ = StaticMask();  // all levels have changed
  white_level_ = white_level;
  to_grey(left, white_level, left_);
  to_grey(right, white_level, right_);
  const bool same_size = left.width == right.width && left.height == right.height;
  return same_size && watch_.add(left_, right_, road, at_infinity_px);
}

void AutoMask::look(const FrameView& left, const FrameView& right, double white_level) {
  try {
    add(left, right, white_level, std::nullopt, 0);
  } catch (const Error&) {  // the earlier run could not match it either
  }
}

bool AutoMask::apply(std::int64_t frame, const FrameView& left, const FrameView& right, Pipeline& pipeline) {
  const std::optional<TrackedRoad>& road = pipeline.carried().road;
  const bool takes_masks = pipeline.engine_name() != "cuda";
  const std::optional<StereoCalibration>& calibration = pipeline.calibration();
  const bool judges = add(left, right, pipeline.options().white_level, road ? std::optional(road->model) : std::nullopt,
                          calibration ? -calibration->disparity_offset_px : 0);
  if (judges) {
    mask_ = watch_.mask();
    record_ = {true, frame, watch_.share(), takes_masks && !mask_.empty()};
  }
  if (record_.applied) {
    const bool fits = mask_.width() == left.width && mask_.height() == left.height;
    pipeline.set_mask(fits ? mask_.view() : ImageView<std::uint8_t>());
  }
  return judges && !mask_.empty();
}

std::string static_mask_text(const io::StaticMaskRecord& record) {
  const std::string found = fmt::format("{:.3g} % of the picture never moves (bonnet?) and ", 100 * record.share);
  if (record.applied) return found + fmt::format("is ignored from frame {} on", record.frame);
  return found + "is not ignored: the engine cuda takes no mask; use another one, such as cpu";
}

nlohmann::ordered_json static_mask_json(const io::StaticMaskRecord& record) {
  if (record.share == 0) return nullptr;
  return {{"share", json_number(record.share)}, {"from_frame", record.frame}, {"applied", record.applied}};
}

}  // namespace roadstereo::cli
