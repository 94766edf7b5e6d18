#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "roadstereo/io/flight_frame.hpp"
#include "roadstereo/pipeline.hpp"
#include "roadstereo/static_mask.hpp"

namespace roadstereo::cli {

/// Name of the file with the mask in the output folder of a recording.
inline constexpr const char* static_mask_file = "static_mask.png";

/// Masks what never moves in a recording, from the pair on that shows it.
class AutoMask {
 public:
  /// `on` false: masks nothing.
  explicit AutoMask(bool on) : on_(on) {}

  /// Goes on with what an earlier run has found.
  void restore(const io::StaticMaskRecord& record, Image<std::uint8_t> mask);

  /// Looks at a pair that an earlier run has matched and that showed nothing yet.
  void look(const FrameView& left, const FrameView& right, double white_level);

  /// Looks at the pair that `pipeline` is about to match, number `frame` of the recording, and sets the mask for it.
  /// Returns whether this pair was the one that showed what never moves. Throws Error for a pair that cannot be
  /// converted to grey.
  bool apply(std::int64_t frame, const FrameView& left, const FrameView& right, Pipeline& pipeline);

  const Image<std::uint8_t>& mask() const { return mask_; }
  const io::StaticMaskRecord& record() const { return record_; }

 private:
  bool add(const FrameView& left, const FrameView& right, double white_level, const std::optional<DisparityPlane>& road,
           double at_infinity_px);

  bool on_;
  StaticMask watch_;
  double white_level_ = 0;  ///< of the last pair
  GreyImage left_, right_;
  Image<std::uint8_t> mask_;
  io::StaticMaskRecord record_;
};

/// Returns what never moves and what becomes of it, in words.
std::string static_mask_text(const io::StaticMaskRecord& record);

/// Returns the same as JSON: share, first frame, whether it is ignored. Null where nothing is still, or too few frames
/// have moved to tell.
nlohmann::ordered_json static_mask_json(const io::StaticMaskRecord& record);

/// Returns the warning of the frame that showed it.
inline std::string static_mask_warning(const io::StaticMaskRecord& record) {
  return "static-mask: " + static_mask_text(record);
}

}  // namespace roadstereo::cli
