#include "io/report/pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/round_length.hpp"
#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/panels.hpp"
#include "io/report/markup.hpp"
#include "io/report/templates.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Mask = Image<std::uint8_t>;

/// Outline of the mask as an SVG path of axis-parallel segments.
std::string edge_path(const Mask& mask) {
  const auto at = [&](int u, int v) {
    return u >= 0 && v >= 0 && u < mask.width() && v < mask.height() && mask(u, v) != 0;
  };
  std::string path;
  const auto add = [&path](int u, int v, char direction, int length) {
    if (length > 0) path += "M" + std::to_string(u) + " " + std::to_string(v) + direction + std::to_string(length);
  };
  for (int v = 0; v <= mask.height(); ++v) {
    int length = 0;
    for (int u = 0; u <= mask.width(); ++u) {
      const bool edge = u < mask.width() && at(u, v) != at(u, v - 1);
      if (!edge) add(u - length, v, 'h', length);
      length = edge ? length + 1 : 0;
    }
  }
  for (int u = 0; u <= mask.width(); ++u) {
    int length = 0;
    for (int v = 0; v <= mask.height(); ++v) {
      const bool edge = v < mask.height() && at(u, v) != at(u - 1, v);
      if (!edge) add(u, v - length, 'v', length);
      length = edge ? length + 1 : 0;
    }
  }
  return path;
}

/// Cells of `side` pixels of the mask as an SVG path of horizontal bars.
std::string area_path(const Mask& mask, int side) {
  std::string path;
  const auto number = [](int value) { return std::to_string(value); };
  for (int v = 0; v < mask.height(); ++v) {
    int length = 0;
    for (int u = 0; u <= mask.width(); ++u) {
      const bool on = u < mask.width() && mask(u, v) != 0;
      if (!on && length > 0) {
        path += 'M' + number((u - length) * side) + ' ' + number(v * side) + 'h' + number(length * side) + 'v' +
                number(side) + "h-" + number(length * side) + 'z';
      }
      length = on ? length + 1 : 0;
    }
  }
  return path;
}

/// Cells of `side` pixels of which at least half is in the mask.
Mask in_cells(const Mask& mask, int side) {
  Mask cells((mask.width() + side - 1) / side, (mask.height() + side - 1) / side);
  for (int row = 0; row < cells.height(); ++row) {
    for (int column = 0; column < cells.width(); ++column) {
      int in = 0, all = 0;
      for (int v = row * side; v < std::min((row + 1) * side, mask.height()); ++v) {
        for (int u = column * side; u < std::min((column + 1) * side, mask.width()); ++u) {
          in += mask(u, v) != 0 ? 1 : 0;
          ++all;
        }
      }
      cells(column, row) = 2 * in >= all ? 255 : 0;
    }
  }
  return cells;
}

/// Mask of the scaled crop: the predicate at the nearest pixel of the map.
template <class Holds>
Mask crop_mask(const Crop& crop, Holds holds) {
  Mask mask(crop.size.width, crop.size.height);
  for (int v = 0; v < mask.height(); ++v) {
    const int row = crop.box.v0 + v * crop.box.height() / mask.height();
    for (int u = 0; u < mask.width(); ++u) {
      mask(u, v) = holds(crop.box.u0 + u * crop.box.width() / mask.width(), row) ? 255 : 0;
    }
  }
  return mask;
}

std::string outline(const DamageMap& map, const Damage& damage, const Crop& crop) {
  return edge_path(crop_mask(crop, [&](int u, int v) { return map.ids(u, v) == damage.id; }));
}

cv::Rect rect_of(const PixelBox& box) {
  return {box.u0, box.v0, box.width(), box.height()};
}

/// Height of the strip with the scale bar below a crop.
int bar_height(const Crop& crop) {
  return std::max(10, crop.size.width / 12);
}

/// Scale bar below the crop, along its rows.
std::string bar_svg(const Crop& crop) {
  const double unit = crop.gsd_m > 0 ? crop.gsd_m : 1;  // of a pixel of the frame
  const double length = round_length(0.4 * crop.box.width() * unit);
  const double shown = length / unit * crop.size.width / crop.box.width();
  const int strip = bar_height(crop);
  const std::string y = number_text(crop.size.height + 0.6 * strip, 1);
  const std::string text = crop.gsd_m <= 0 ? number_text(length, length < 1 ? 1 : 0) + " px"
                           : length >= 1   ? number_text(length, 0) + " m"
                                           : number_text(1000 * length, 0) + " mm";
  return "<path class=\"bar\" d=\"M2 " + y + "h" + number_text(shown, 1) + "\"/><text x=\"" +
         number_text(shown + 0.4 * strip, 1) + "\" y=\"" + number_text(crop.size.height + 0.85 * strip, 1) +
         "\" font-size=\"" + number_text(0.75 * strip, 1) + "\">" + text + "</text>";
}

Fields crop_fields(const cv::Mat& picture, const DamageMap& map, const Damage& damage, const Crop& crop) {
  const auto [red, green, blue] = damage_colour(damage.kind, severity_of(damage));
  return {{"width", std::to_string(crop.size.width)},
          {"height", std::to_string(crop.size.height)},
          {"total_height", std::to_string(crop.size.height + bar_height(crop))},
          {"ratio", number_text(static_cast<double>(crop.size.width) / (crop.size.height + bar_height(crop)), 3)},
          {"bar", bar_svg(crop)},
          {"picture", picture_uri(picture, {std::max(crop.size.width, crop.size.height), crop.bytes})},
          {"outline", outline(map, damage, crop)},
          {"colour", "rgb(" + std::to_string(red) + "," + std::to_string(green) + "," + std::to_string(blue) + ")"},
          {"id", crop.id}};
}

/// Line of a cross-section as an SVG path.
std::string cut_path(const CrossSection& section, const Crop& crop) {
  const double scale = static_cast<double>(crop.size.width) / crop.box.width();
  const auto point_text = [&](const std::array<int, 2>& pixel) {
    return number_text((pixel[0] - crop.box.u0 + 0.5) * scale, 1) + " " +
           number_text((pixel[1] - crop.box.v0 + 0.5) * scale, 1);
  };
  return "M" + point_text(section.pixel.front()) + "L" + point_text(section.pixel.back());
}

/// Height above the road, for the same colours as transformed maps (red below).
Image<float> heights(const DamageMap& map, const PixelBox& box) {
  Image<float> part(box.width(), box.height());
  for (int v = 0; v < box.height(); ++v) {
    const float* const row = map.depth.row(box.v0 + v) + box.u0;
    std::transform(row, row + box.width(), part.row(v), [](float depth) { return -depth; });
  }
  return part;
}

cv::Mat shrunk(const cv::Mat& picture, int max_side) {
  const int longer = std::max(picture.cols, picture.rows);
  if (longer <= max_side) return picture;
  const double scale = static_cast<double>(max_side) / longer;
  cv::Mat small;
  const cv::Size size(std::max(1, cvRound(scale * picture.cols)), std::max(1, cvRound(scale * picture.rows)));
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

std::vector<std::uint8_t> encoded(const char* format, const cv::Mat& picture, const std::vector<int>& options) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(format, picture, bytes, options)) {
    fail<SystemError>("an image of the report could not be encoded as ", format);
  }
  return bytes;
}

}  // namespace

std::string picture_uri(const cv::Mat& picture, const PictureLimit& limit) {
  constexpr int good_quality = 88, min_quality = 60, quality_step = 14;
  constexpr int min_side = 32;
  const std::vector<std::uint8_t> png = encoded(".png", shrunk(picture, limit.side), {});
  std::vector<std::uint8_t> jpeg;
  for (int side = limit.side; jpeg.empty() || (jpeg.size() > limit.bytes && side > min_side); side = side * 3 / 4) {
    for (int quality = good_quality; quality >= min_quality; quality -= quality_step) {
      jpeg = encoded(".jpg", shrunk(picture, side), {cv::IMWRITE_JPEG_QUALITY, quality});
      if (jpeg.size() <= limit.bytes) break;
    }
  }
  if (png.size() < jpeg.size()) return "data:image/png;base64," + base64(png);
  return "data:image/jpeg;base64," + base64(jpeg);
}

std::string picture_uri(std::span<const std::uint8_t> encoded_picture, const PictureLimit& limit) {
  const std::vector<std::uint8_t> bytes(encoded_picture.begin(), encoded_picture.end());
  const cv::Mat picture = cv::imdecode(bytes, cv::IMREAD_COLOR);
  if (picture.empty()) fail("the sheet for the report, ", bytes.size(), " bytes, is not a PNG or JPEG image");
  return picture_uri(picture, limit);
}

Crop crop_around(const DamageMap& map, const Damage& damage, const PictureLimit& limit, double focal_px) {
  constexpr double share = 0.25;
  constexpr int min_margin_px = 8;
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const int longer = std::max(u1 - u0, v1 - v0) + 1;  // also shows the surroundings of a thin damage
  const PixelBox box = box_with_margin(map, damage, share, std::max(min_margin_px, longer / 8));
  const double scale = std::min(1.0, static_cast<double>(limit.side) / std::max(box.width(), box.height()));
  const double gsd_m = damage.metrics && focal_px > 0 ? damage.metrics->centroid_m[2] / focal_px : 0;
  return {box,
          {std::max(1, cvRound(scale * box.width())), std::max(1, cvRound(scale * box.height()))},
          limit.bytes,
          std::to_string(damage.id),
          gsd_m};
}

std::string crop_svg(const cv::Mat& picture, const DamageMap& map, const Damage& damage, const Crop& crop) {
  return fill(templates::crop, crop_fields(picture(rect_of(crop.box)), map, damage, crop));
}

std::string depth_svg(const DamageMap& map, const Damage& damage, const Crop& crop, const DepthMarks& marks) {
  const ImageView<const float> holes = marks.holes;
  const cv::Mat colours = colour_pixels(heights(map, crop.box), {-marks.max_depth, marks.max_depth, true, ""});
  Fields fields = crop_fields(colours, map, damage, crop);
  const Mask interpolated = crop_mask(crop, [&](int u, int v) {
    return !holes.empty() && std::isfinite(map.depth(u, v)) && !std::isfinite(holes(u, v));
  });
  constexpr int max_cells = 200;  // along a side; limits the size of the report
  const int side = 1 + (std::max(crop.size.width, crop.size.height) - 1) / max_cells;
  fields["holes"] = area_path(in_cells(interpolated, side), side);
  fields["cut"] = marks.section == nullptr ? "" : cut_path(*marks.section, crop);
  return fill(templates::depth, fields);
}

namespace {

/// The colour scale from −1 (above the road, top) to 1, one pixel wide.
cv::Mat depth_ramp(int steps) {
  Image<float> ramp(1, steps);
  for (int i = 0; i < steps; ++i) ramp(0, i) = 1 - 2 * static_cast<float>(i) / static_cast<float>(steps - 1);
  return colour_pixels(ramp, {-1, 1, true, ""});
}

}  // namespace

std::string depth_palette_json() {
  constexpr int steps = 65;
  const cv::Mat ramp = depth_ramp(steps);
  std::string colours = "[";
  for (int i = 0; i < steps; ++i) {
    const auto& bgr = ramp.at<cv::Vec3b>(i);
    colours += (i == 0 ? "[" : ",[") + std::to_string(bgr[2]) + "," + std::to_string(bgr[1]) + "," +
               std::to_string(bgr[0]) + "]";
  }
  return colours + "]";
}

std::string depth_colours() {
  constexpr int steps = 128;
  return ":root{--ramp:url(" + picture_uri(depth_ramp(steps), {steps, 10000}) + ")}";
}

}  // namespace roadstereo::io
