#include "live/view_pictures.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "roadstereo/io/damage_overlay.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/jpeg.hpp"

namespace roadstereo::cli {
namespace {

constexpr int quality = 82;
constexpr int max_width = 1280;  // pixels

/// Crops the scale bar of a colour map; the page draws its own.
FrameView without_bar(const Frame& picture, ImageView<const float> map) {
  FrameView view = picture.view();
  view.width = map.width();
  view.height = map.height();
  return view;
}

ViewPicture picture_of(const FrameView& frame) {
  const std::vector<std::uint8_t> jpeg = io::encode_jpeg(frame, quality, max_width);
  return {{jpeg.begin(), jpeg.end()}, 0};
}

ViewPicture left_picture(const LiveView& view) {
  DamageMap map;
  map.damages = view.damages;
  map.ids = view.ids;
  return picture_of(io::damage_overlay(view.left.view(), view.white_level, map).view());
}

/// Returns a round number, so that successive views have equal scales.
double half_range_of(const LiveView& view) {
  constexpr std::array round_px = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0};
  const io::ColourScale scale = io::transformed_scale(view.transformed, view.delta_t);
  const double half_range = (scale.highest - scale.lowest) / 2;
  const auto* const entry = std::lower_bound(round_px.begin(), round_px.end(), half_range);
  return entry == round_px.end() ? half_range : *entry;
}

ViewPicture transformed_picture(const LiveView& view) {
  const double half_range = half_range_of(view);
  const Frame colours =
      io::colour_map(view.transformed, {view.delta_t - half_range, view.delta_t + half_range, true, ""});
  ViewPicture picture = picture_of(without_bar(colours, view.transformed));
  picture.half_range_px = half_range;
  return picture;
}

}  // namespace

std::string scale_ramp_png() {
  constexpr int steps = 256;
  Image<float> ramp(steps, 1);
  for (int i = 0; i < steps; ++i) ramp(i, 0) = static_cast<float>(i) / (steps - 1);
  const Frame picture = io::colour_map(ramp, {0, 1, true, ""});
  const std::vector<std::uint8_t> png = io::encode_png(without_bar(picture, ramp));
  return {png.begin(), png.end()};
}

std::shared_ptr<ViewPictures::Entry> ViewPictures::entry_of(const SharedView& view, Kind kind) {
  constexpr std::size_t kept = 4;
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const std::shared_ptr<Entry>& entry) {
    return entry->view == view && entry->kind == kind;
  });
  if (found != entries_.end()) return *found;
  auto entry = std::make_shared<Entry>();
  entry->view = view;
  entry->kind = kind;
  entries_.push_front(entry);
  if (entries_.size() > kept) entries_.pop_back();
  return entry;
}

ViewPictures::Shared ViewPictures::get(const SharedView& view, Kind kind) {
  const std::shared_ptr<Entry> entry = entry_of(view, kind);
  const std::lock_guard lock(entry->mutex);
  if (!entry->picture) {
    entry->picture =
        std::make_shared<const ViewPicture>(kind == Kind::left ? left_picture(*view) : transformed_picture(*view));
  }
  return entry->picture;
}

ViewPictures::Shared ViewPictures::left(const SharedView& view) {
  return get(view, Kind::left);
}

ViewPictures::Shared ViewPictures::transformed(const SharedView& view) {
  return get(view, Kind::transformed);
}

}  // namespace roadstereo::cli
