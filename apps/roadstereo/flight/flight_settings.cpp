#include "flight/flight_settings.hpp"

#include <array>
#include <cmath>
#include <utility>

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
       "\"; it must be a comma-separated list of disparity, transformed, sheet, cloud and overlay");
}

void FlightSettings::validate() const {
  if (from < 0) fail("--from is ", from, "; it must be at least 0");
  if (to && *to < from) fail("--to is ", *to, "; it must be at least --from, which is ", from);
  if (!std::isfinite(track.offset_s)) fail("--track-offset is ", track.offset_s, "; it must be a number of seconds");
  if (every < 1) fail("--every is ", every, "; it must be at least 1");
}

FlightPlan resolve(const FlightSettings& settings) {
  settings.validate();
  FlightPlan plan;
  plan.options = make_options(settings.processing);
  plan.find_white_level = !sets_white_level(settings.processing);
  plan.source = make_source_options(settings.source_settings);
  for (const std::string& name : settings.write) plan.write.push_back(frame_file(name));
  return plan;
}

}  // namespace roadstereo::cli
