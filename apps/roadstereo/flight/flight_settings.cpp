#include "flight/flight_settings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mask_file.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

namespace {

constexpr std::array names = {std::pair{"disparity", FrameFile::disparity},
                              std::pair{"transformed", FrameFile::transformed}, std::pair{"sheet", FrameFile::sheet},
                              std::pair{"cloud", FrameFile::cloud}, std::pair{"overlay", FrameFile::overlay}};

}  // namespace

FrameFile frame_file(const std::string& name) {
  for (const auto& [known, file] : names) {
    if (name == known) return file;
  }
  fail("--write has \"", name,
       "\"; it must be a comma-separated list of disparity, transformed, sheet, cloud, overlay and mcap");
}

PipelineOptions make_options(const FlightSettings& settings) {
  PipelineOptions options = make_options(settings.processing);
  if (settings.height_m) options.road_model.height_m = *settings.height_m;
  if (settings.pitch_deg) options.road_model.pitch_deg = *settings.pitch_deg;
  options.validate();
  // The engine cuda takes no mask.
  if (!settings.mask.empty() && options.engine == "auto") options.engine = "cpu";
  return options;
}

Image<std::uint8_t> read_ignored(const FlightSettings& settings) {
  constexpr int white = 255;
  if (settings.mask.empty()) return {};
  Image<std::uint8_t> mask = read_mask(settings.mask, white);
  const auto has_any = [](const Image<std::uint8_t>& marked) {
    return std::any_of(marked.row(0), marked.row(0) + marked.pixels(), [](std::uint8_t value) { return value != 0; });
  };
  if (!has_any(mask) && has_any(read_mask(settings.mask, 1))) {
    fail(settings.mask,
         ": the mask has no white pixel (255), only darker ones; --mask ignores the pixels that are 255");
  }
  return mask;
}

void require_mask_size(const FlightSettings& settings, const Image<std::uint8_t>& mask, int width, int height) {
  if (mask.empty() || (mask.width() == width && mask.height() == height)) return;
  fail(settings.mask, " has ", mask.width(), "×", mask.height(), " pixels; --mask must have ", width, "×", height,
       " like the rectified frames");
}

void FlightSettings::validate() const {
  if (from < 0) fail("--from is ", from, "; it must be at least 0");
  if (to && *to < from) fail("--to is ", *to, "; it must be at least --from, which is ", from);
  if (!std::isfinite(track.offset_s)) fail("--track-offset is ", track.offset_s, "; it must be a number of seconds");
  constexpr double min_sd_s = 0.001, max_sd_s = 600;
  if (!(track.offset_sd_s >= min_sd_s && track.offset_sd_s <= max_sd_s)) {
    fail("--track-offset-sd is ", track.offset_sd_s, "; it must be between ", min_sd_s, " and ", max_sd_s, " s");
  }
  constexpr double max_yaw_deg = 360;
  if (!(std::abs(track.mount_yaw_deg) <= max_yaw_deg)) {
    fail("--mount-yaw is ", track.mount_yaw_deg, "; it must be between ", -max_yaw_deg, " and ", max_yaw_deg,
         " degrees");
  }
  constexpr std::int64_t max_every = 1'000'000'000;
  if (every < 1 || every > max_every) fail("--every is ", every, "; it must be between 1 and ", max_every);
}

std::vector<std::string> input_files(const FlightSettings& settings) {
  std::vector<std::string> files = settings.source;
  files.insert(files.end(), settings.calibration.begin(), settings.calibration.end());
  files.insert(files.end(), {settings.disparity, settings.mask, settings.track.file, settings.processing.rig_bias,
                             settings.processing.severity});
  return files;
}

FlightPlan resolve(const FlightSettings& settings) {
  settings.validate();
  FlightPlan plan;
  plan.options = make_options(settings);
  if (settings.track.mount_yaw_deg != 0) plan.options.damage.mount_yaw_deg = settings.track.mount_yaw_deg;
  plan.mask = read_ignored(settings);
  plan.auto_mask = settings.auto_mask && settings.mask.empty();
  plan.find_white_level = !sets_white_level(settings.processing);
  plan.source = make_source_options(settings.source_settings);
  for (const std::string& name : settings.write) {
    if (name == "mcap") {
      plan.mcap = true;
    } else {
      plan.write.push_back(frame_file(name));
    }
  }
  return plan;
}

}  // namespace roadstereo::cli
