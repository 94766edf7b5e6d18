#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/degrees.hpp"
#include "core/format_message.hpp"
#include "roadstereo/health.hpp"

namespace roadstereo {
namespace {

/// A quarter of the period of the finest texture, 2 px: there the disparity of diagonal texture is off by as much.
constexpr double max_row_error_px = 0.5;
/// Half of that period: rows that are a pixel apart show other texture.
constexpr double max_trusted_row_error_px = 1.0;

/// What a sine of half the amplitude of `max_row_error_px` shows: a camera that vibrates moves along rows and columns.
constexpr double min_wave_px = 0.5 * max_row_error_px;

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

/// "0.08 % larger, turned clockwise by 1.17° and 4.58 px higher", of the right view; without what rounds to nothing.
std::string rows_text(const PairHealth& h) {
  constexpr double unit = 0.01;
  std::vector<std::string> parts;
  const auto add = [&](const char* before, double value, const char* up, const char* down) {
    const double size = rounded(std::abs(value), unit);
    if (size > 0) parts.push_back(format_message(before, size, value > 0 ? up : down));
  };
  add("", 100 * h.row_scale, " % larger", " % smaller");
  const char* const sense = h.row_turn_rad > 0 ? "turned clockwise by " : "turned counterclockwise by ";
  add(sense, to_degrees(h.row_turn_rad), "°", "°");
  add("", h.row_offset_px, " px lower", " px higher");
  if (parts.empty()) return "";
  std::string text = ": the right view is " + parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) text += (i + 1 < parts.size() ? ", " : " and ") + parts[i];
  return text;
}

class Findings {
 public:
  /// Adds a finding if the value, unless NaN, exceeds the limit.
  template <class... Parts>
  void add_above(const char* id, double value, double limit, const char* unit, bool spoils_depth,
                 const Parts&... text) {
    if (value > limit) list_.push_back({id, value, limit, unit, format_message(text...), spoils_depth});
  }
  std::vector<HealthFinding> take() { return std::move(list_); }

 private:
  std::vector<HealthFinding> list_;
};

void add_rectification(const PairHealth& h, Findings& findings) {
  const bool spoils_rows = h.row_error_px > max_trusted_row_error_px;
  findings.add_above("row-error", h.row_error_px, max_row_error_px, "px", spoils_rows,
                     "the rows of the pair differ by up to ", rounded(h.row_error_px, 0.01), " px (limit ",
                     max_row_error_px, " px)", rows_text(h), "; rectify the pair, with a new calibration of the rig");
  constexpr double max_scatter_px = RowAlignment::max_fit_sigma_px;
  findings.add_above("row-scatter", h.row_scatter_px, max_scatter_px, "px", true, "the rows of the pair scatter by ",
                     rounded(h.row_scatter_px, 0.01), " px around those of a rigid rig (limit ", max_scatter_px,
                     " px), and neighbours agree: the cameras do not expose at the same moment, or the rig bends; "
                     "synchronise the cameras");
  findings.add_above("distortion", h.bowl_px, h.noise_px, "px", h.bowl_px > h.threshold_sigma * h.noise_px,
                     "residual lens distortion (k = ", rounded(h.distortion_right, 1e-4), " in the right view, ",
                     rounded(h.distortion_both, 1e-4), " in both): it bends the road by up to ",
                     rounded(h.bowl_px, 0.001), " px (limit ", rounded(h.noise_px, 0.001),
                     " px, the noise of the road); rectify the pair, with a new calibration of the rig");
}

void add_road(const PairHealth& h, Findings& findings) {
  const double limit = std::max(min_wave_px, h.noise_px * std::numbers::sqrt2 / 2);
  findings.add_above("wave", h.wave_px, limit, "px", false,
                     "more than half of the road's noise is common to whole rows (", rounded(h.wave_px, 0.001),
                     " px of ", rounded(h.noise_px, 0.001),
                     " px): one camera vibrates while its shutter rolls, or the road undulates; damp the mount");
  constexpr double max_beyond_px = 1;
  findings.add_above("infinity", -h.infinity_px, max_beyond_px, "px", true, "disparities above the horizon are ",
                     rounded(-h.infinity_px, 0.01), " px below that of infinity (limit ", max_beyond_px,
                     " px): the offset of the disparities is wrong, or the cameras do not expose at the same moment");
}

void add_pictures(const PairHealth& h, Findings& findings) {
  constexpr double max_gain = 2;       // one stop
  constexpr double max_clipped = 0.1;  // a tenth of the pixels lost adds 5 % to a standard error
  const double gain = std::max(h.gain, 1 / h.gain);
  findings.add_above("gain", gain, max_gain, "", false, "the right view is ", rounded(h.gain, 0.01),
                     " times as bright as the left one (limit ", max_gain, "); couple the exposures");
  const double clipped = std::fmax(h.clipped_left, h.clipped_right);
  findings.add_above("clipped", clipped, max_clipped, "", false, rounded(100 * h.clipped_left, 1), " % (left) and ",
                     rounded(100 * h.clipped_right, 1), " % (right) of the road's pixels are black or white (limit ",
                     100 * max_clipped, " %); change the exposure");
  constexpr double max_blur_px = 3;  // the radius of a block
  constexpr double max_blur_ratio = 1.5;
  const double blur = std::fmax(h.blur_left_px, h.blur_right_px);  // of the other view if one is unknown
  constexpr double sharp_px = 0.5;  // what pixels and their interpolation blur; less says nothing of a lens
  const double left_px = std::max(h.blur_left_px, sharp_px), right_px = std::max(h.blur_right_px, sharp_px);
  const double ratio = std::max(left_px / right_px, right_px / left_px);
  findings.add_above("blur", blur, max_blur_px, "px", false, "the pictures are blurred by ",
                     rounded(h.blur_left_px, 0.1), " px (left) and ", rounded(h.blur_right_px, 0.1),
                     " px (right; limit ", max_blur_px, " px); focus, or expose for a shorter time");
  findings.add_above("blur-ratio", ratio, max_blur_ratio, "", false, "one view is ", rounded(ratio, 0.1),
                     " times as blurred as the other (", rounded(h.blur_left_px, 0.1), " px left, ",
                     rounded(h.blur_right_px, 0.1), " px right; limit ", max_blur_ratio, "); focus, clean the lens");
  constexpr double max_noise = 0.25;  // a third of the texture: blocks that match correlate by three quarters at best
  const double stripes = std::isnan(h.stripe_share) ? 0 : h.stripe_share, noise = h.noise_share + stripes;
  const char* const advice = stripes > h.noise_share ? "subtract a dark frame, add light, or expose with less gain"
                                                     : "add light, or expose for longer with less gain";
  findings.add_above("noise", noise, max_noise, "", false, rounded(100 * noise, 1),
                     " % of the variance of the road's grey levels are noise, ", rounded(100 * stripes, 1),
                     " % that of whole columns or rows (limit ", rounded(100 * max_noise, 1),
                     " %): damage may be missed; ", advice);
  constexpr double max_blocks = 0.1;
  constexpr double max_trusted_blocks = 1;  // the grid of the blocks is as strong as the texture: it is matched
  const double blocks = std::fmax(h.blocks_left, h.blocks_right);
  findings.add_above("compression", blocks, max_blocks, "", blocks > max_trusted_blocks,
                     "steps between blocks of 8×8 pixels are ", rounded(100 * blocks, 1),
                     " % higher than others (limit ", 100 * max_blocks,
                     " %): the pictures are compressed too much; use PNG, or JPEG of quality 95");
}

void add_spots(const LensSpots& spots, const char* id, const char* view, Findings& findings) {
  constexpr double max_dead_share = 2e-4;  // one of a hundred blocks of 7×7 pixels has a dead one
  const double dead = spots.dead_share > max_dead_share ? spots.dead_pixels : 0;
  findings.add_above(id, spots.dirt + dead, 0, "", false, spots.dirt + dead, " places of the ", view,
                     " picture never change while the rest moves (", spots.dirt, " of dirt, ", dead,
                     " dead pixels; the largest is around pixel ", std::round(spots.largest_u), ", ",
                     std::round(spots.largest_v), "; limit 0); clean the lens, mask what stays");
}

}  // namespace

std::vector<HealthFinding> PairHealth::findings() const {
  Findings findings;
  add_rectification(*this, findings);
  add_road(*this, findings);
  add_pictures(*this, findings);
  add_spots(spots.left, "left-spots", "left", findings);
  add_spots(spots.right, "right-spots", "right", findings);
  return findings.take();
}

bool PairHealth::depth_is_trusted() const {
  const std::vector<HealthFinding> list = findings();
  return std::none_of(list.begin(), list.end(), [](const HealthFinding& finding) { return finding.spoils_depth; });
}

}  // namespace roadstereo
