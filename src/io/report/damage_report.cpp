#include "roadstereo/io/damage_report.hpp"

#include <algorithm>

#include "io/damage_colours.hpp"
#include "io/frame_mat.hpp"
#include "io/panels.hpp"
#include "io/report/damage_section.hpp"
#include "io/report/list.hpp"
#include "io/report/markup.hpp"
#include "io/report/pictures.hpp"
#include "io/report/summary.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/flight_pictures.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::io {
namespace {

void require_size(const DamageMap& map, const char* what, int width, int height) {
  if (width == map.ids.width() && height == map.ids.height()) return;
  fail(what, " has ", width, "×", height, " pixels, but the damage map has ", map.ids.width(), "×", map.ids.height());
}

void validate(const DamageReportInput& input) {
  const DamageMap& map = input.map;
  if (input.left.data != nullptr) require_size(map, "the left image", input.left.width, input.left.height);
  for (const auto& view : {input.disparity, input.transformed}) {
    if (!view.empty()) require_size(map, "a disparity map", view.width(), view.height());
  }
}

cv::Mat background_of(const DamageReportInput& input) {
  validate(input);
  if (input.left.data != nullptr) return to_bgr(input.left, input.white_level);
  const ImageView<const float> map = input.transformed;
  if (map.empty()) return colour_pixels(input.map.depth, percentile_scale(input.map.depth, ""));
  const std::vector<double> road = percentiles(input.map.surface, {50});
  return colour_pixels(map, road.empty() ? percentile_scale(map, "") : transformed_scale(map, road.front()));
}

std::string figure(const std::string& id, const std::string& title, const std::string& picture,
                   const std::string& text) {
  return fill(templates::figure, {{"id", id}, {"title", title}, {"picture", picture}, {"text", text}});
}

std::string sheet_figure(const DamageReportInput& input) {
  constexpr PictureLimit limit{1700, 700000};
  if (input.sheet.empty()) return "";
  return figure(
      "sheet", "Result sheet", picture_uri(input.sheet, limit),
      "Left image, disparity, transformed disparity (intact road has a constant value) and v-disparity histogram.");
}

std::string overlay_figure(const DamageReportInput& input) {
  constexpr PictureLimit limit{1400, 600000};
  if (input.map.damages.empty()) return "";
  const Frame overlay = damage_overlay(damage_background(input).view(), 0, input.map);
  return figure("overlay", "Overlay", picture_uri(mat_over(overlay.view()), limit),
                input.map.metric
                    ? "Every damage with its id and maximum depth, coloured by severity; +: above the road."
                    : "Every damage with its id and maximum disparity change; +: above the road.");
}

std::string sections(const DamageReportInput& input) {
  const std::vector<Damage>& damages = input.map.damages;
  if (damages.empty()) return "";
  const cv::Mat background = background_of(input);
  const SectionSize size = SectionSize::for_count(damages.size());
  std::string html = "<h2>Damage details</h2>\n";
  if (damages.size() > max_reliefs) {
    html += "<p class=\"hint\">The " + std::to_string(max_reliefs) + " deepest of the " +
            std::to_string(damages.size()) + " damages have a 3-D view.</p>\n";
  }
  for (std::size_t i = 0; i < damages.size(); ++i) {
    html += damage_section(input, background, damages[i],
                           {size, i < max_reliefs, std::to_string(damages[i].id), "", false});
  }
  return html;
}

}  // namespace

std::string road_damage_section(const DamageReportInput& input, const Damage& damage, std::int64_t id) {
  validate(input);
  constexpr SectionSize size{{360, 30000}, 72};
  return damage_section(input, background_of(input), damage, {size, true, std::to_string(id), "{{&where}}", true});
}

Frame damage_background(const DamageReportInput& input) {
  return frame_from(background_of(input), ChannelOrder::bgr);
}

std::string damage_report(const DamageReportInput& input) {
  validate(input);
  const DamageMap& map = input.map;
  Fields fields;
  fields["title"] = input.title;
  fields["style"] = std::string(templates::style);
  fields["colours"] = severity_colours() + depth_colours();
  fields["version"] = version;
  fields["size"] = std::to_string(map.ids.width()) + " × " + std::to_string(map.ids.height()) + " px";
  fields["notices"] = summary_notices(input);
  fields["head"] = property_list(input.head);
  fields["cards"] = damages_cards(map.damages, map.damages.size(), map.candidates.size(), map.metric);
  fields["properties"] = property_list(input.properties);
  fields["sheet"] = sheet_figure(input);
  fields["overlay"] = overlay_figure(input);
  fields["list"] = damage_list(map);
  fields["candidates"] = candidate_list(map);
  fields["legend"] = map.metric && !map.damages.empty() ? severity_legend(input.severity) : "";
  fields["damages"] = sections(input);
  fields["palette"] = depth_palette_json();
  fields["scripts"] = std::string(templates::sorting) + std::string(templates::relief3d);
  return fill(templates::report, fields);
}

}  // namespace roadstereo::io
