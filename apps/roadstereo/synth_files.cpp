#include "synth_files.hpp"

#include <fmt/format.h>

#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/label_image.hpp"
#include "roadstereo/rigid_transform.hpp"
#include "truth_json.hpp"

namespace roadstereo::cli {

namespace {

Image<float> to_float(const Image<double>& map) {
  Image<float> result(map.width(), map.height());
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) result(u, v) = static_cast<float>(map(u, v));
  }
  return result;
}

FrameView grey_view(const Image<std::uint8_t>& image) {
  return {image.row(0), image.width(), image.height(), image.width(), SampleType::u8, ChannelOrder::grey};
}

}  // namespace

std::string FrameNumber::path(const std::string& name, const std::string& extension) const {
  if (frames == 1) return name + extension;
  return fmt::format("{}/{:06}{}", name, frame, extension);
}

std::vector<std::string> synthetic_pair_files(const FrameNumber& number) {
  return {number.path("left", ".png"),
          number.path("right", ".png"),
          number.path("truth_disparity", ".tiff"),
          number.path("truth_visible", ".png"),
          number.path("truth_labels", ".png"),
          number.path("truth_road", ".png"),
          number.path("truth", ".json")};
}

void add_synthetic_pair(const synth::Scene& scene, const synth::SyntheticPair& pair, const FrameNumber& number,
                        io::OutputFolder& folder) {
  const int quality = scene.degradation.jpeg_quality;
  const auto recorded = [quality](const Frame& image) {
    return quality > 0 ? io::with_jpeg_loss(image, quality) : image;
  };
  const std::vector<std::string> names = synthetic_pair_files(number);
  folder.add(names[0], io::encode_png(recorded(pair.left).view()));
  folder.add(names[1], io::encode_png(recorded(pair.right).view()));
  folder.add(names[2], io::encode_float_tiff(to_float(pair.disparity)));
  folder.add(names[3], io::encode_png(grey_view(pair.visible)));
  folder.add(names[4], io::encode_label_png(pair.labels));
  folder.add(names[5], io::encode_png(grey_view(pair.road)));
  folder.add(names[6], truth_json(scene, pair));
}

std::string true_trajectory(const std::vector<std::array<double, 12>>& camera_to_road) {
  const RigidTransform& first = camera_to_road.front();
  RigidTransform turn = inverse(first);
  for (const std::size_t k : {3, 7, 11}) turn[k] = 0;
  std::string text;
  for (RigidTransform pose : camera_to_road) {
    for (const std::size_t k : {3, 7, 11}) pose[k] -= first[k];  // before it is turned: what is 0 stays so
    text += fmt::format("{:.12g}\n", fmt::join(compose(turn, pose), " "));
  }
  return text;
}

std::string frame_times(int frames, double rate_hz) {
  std::string text;
  for (int frame = 0; frame < frames; ++frame) text += fmt::format("{:.6f}\n", frame / rate_hz);
  return text;
}

}  // namespace roadstereo::cli
