#include "evaluate/scan_sheet.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluation/tint.hpp"
#include "roadstereo/io/pictures.hpp"

namespace roadstereo::cli {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

/// Columns u0 … u1 − 1, rows v0 … v1 − 1.
struct Box {
  int u0, v0, u1, v1;
};

/// The labelled pixels and a margin.
Box box_around(ImageView<const std::uint8_t> label) {
  Box box{label.width(), label.height(), 0, 0};
  for (int v = 0; v < label.height(); ++v) {
    for (int u = 0; u < label.width(); ++u) {
      if (label(u, v) == 0) continue;
      box = {std::min(box.u0, u), std::min(box.v0, v), std::max(box.u1, u + 1), std::max(box.v1, v + 1)};
    }
  }
  constexpr int margin = 24;
  return {std::max(box.u0 - margin, 0), std::max(box.v0 - margin, 0), std::min(box.u1 + margin, label.width()),
          std::min(box.v1 + margin, label.height())};
}

Frame cut_out(const Frame& frame, const Box& box) {
  Frame part = frame;
  part.width = box.u1 - box.u0;
  part.height = box.v1 - box.v0;
  part.bytes.clear();
  const std::size_t pixel =
      frame.bytes.size() / (static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  const std::size_t row = pixel * static_cast<std::size_t>(frame.width);
  for (int v = box.v0; v < box.v1; ++v) {
    const auto first = frame.bytes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(v) * row +
                                                                         static_cast<std::size_t>(box.u0) * pixel);
    part.bytes.insert(part.bytes.end(), first,
                      first + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(part.width) * pixel));
  }
  return part;
}

const io::ColourScale& distance_scale() {
  static const io::ColourScale scale{0, 6, false, "distance, mm"};
  return scale;
}

}  // namespace

io::SheetCell pothole_picture(const std::string& name, const StereoPair& pair, ImageView<const std::uint8_t> label) {
  const Frame tinted = io::tint_magenta(pair.left.view(), pair.white_level, label);
  return {name + ", label in magenta", cut_out(tinted, box_around(label))};
}

io::SheetCell distance_picture(const std::string& method, const ScanScore& score, const LabelledPoints& found,
                               const std::vector<ScanDistance>& distances, ImageView<const std::uint8_t> label) {
  const Box box = box_around(label);
  Image<float> map(box.u1 - box.u0, box.v1 - box.v0, nothing);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    map(found.pixels[i][0] - box.u0, found.pixels[i][1] - box.v0) = static_cast<float>(distances[i].mm);
  }
  constexpr double percent = 100;
  return {fmt::format("{}: RMS {:.2f} mm, {:.1f} % complete", method, score.rms_mm, percent * score.completeness()),
          io::colour_map(map, distance_scale())};
}

Frame distance_plan(const Points& cloud, const ScanModel& scan, const RigidMotion& motion) {
  const PrincipalAxes& axes = scan.axes;
  constexpr double pixel_mm = 0.5, reach = 3.5;  // standard deviations
  const int width = static_cast<int>(2 * reach * axes.sigma[0] / pixel_mm);
  const int height = static_cast<int>(2 * reach * axes.sigma[1] / pixel_mm);
  Image<float> map(width, height, nothing);
  const std::vector<ScanDistance> distances = closest_distances(cloud, scan, motion);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d at = axes.axes.transpose() * (motion(cloud[i]) - axes.centre) / pixel_mm;
    const auto u = static_cast<int>(std::floor(at[0] + width / 2.0));
    const auto v = static_cast<int>(std::floor(at[1] + height / 2.0));
    if (u >= 0 && v >= 0 && u < width && v < height) map(u, v) = static_cast<float>(distances[i].mm);
  }
  return io::colour_map(map, distance_scale());
}

}  // namespace roadstereo::cli
