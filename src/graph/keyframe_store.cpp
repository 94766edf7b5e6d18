#include "graph/keyframe_store.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>

#include "core/downsample.hpp"
#include "core/own_files.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr float disparity_steps = 64, sigma_steps = 128;

/// Whether a file has the name of a keyframe: its frame's index.
bool is_keyframe(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Means of 2 × 2 pixels, in pixels of the smaller map; NaN unless all four are valid.
Image<float> halved(ImageView<const float> map) {
  Image<float> smaller(map.width() / 2, map.height() / 2);
  for (int y = 0; y < smaller.height(); ++y) {
    for (int x = 0; x < smaller.width(); ++x) {
      const int u = 2 * x, v = 2 * y;
      smaller(x, y) = (map(u, v) + map(u + 1, v) + map(u, v + 1) + map(u + 1, v + 1)) / 8;
    }
  }
  return smaller;
}

/// The plane in pixels of half the size, whose centres are between the old ones.
DisparityPlane halved(const DisparityPlane& plane) {
  DisparityPlane smaller = plane;
  smaller.a0 = plane.disparity(0.5, 0.5) / 2;
  return smaller;
}

template <class T>
void put(std::ofstream& stream, const std::vector<T>& values) {
  stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template <class T>
std::vector<T> get(std::ifstream& stream, std::size_t count) {
  std::vector<T> values(count);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  return values;
}

template <class T>
std::vector<T> quantised(const Image<float>& map, float steps, float offset = 0) {
  constexpr auto most = static_cast<float>(std::numeric_limits<T>::max());
  std::vector<T> values(map.pixels());
  std::transform(map.row(0), map.row(0) + map.pixels(), values.begin(), [=](float value) {
    const float raised = value + offset;
    const float scaled = std::max(std::round(steps * raised), 1.0F);      // the surest are not lost
    return raised > 0 && scaled <= most ? static_cast<T>(scaled) : T{0};  // NaN compares false
  });
  return values;
}

template <class T>
Image<float> restored(const std::vector<T>& values, int width, int height, float steps, float offset = 0) {
  Image<float> map(width, height);
  std::transform(values.begin(), values.end(), map.row(0), [=](T value) {
    return value == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(value) / steps - offset;
  });
  return map;
}

}  // namespace

KeyframeStore::KeyframeStore(std::filesystem::path folder, double disparity_offset_px)
    : folder_(std::move(folder)), disparity_offset_px_(disparity_offset_px) {
  try {
    std::filesystem::create_directories(folder_);
    for (const std::filesystem::path& earlier : own_files(folder_, "loop search", "keyframes", is_keyframe)) {
      std::filesystem::remove(earlier);
    }
  } catch (const std::filesystem::filesystem_error& error) {
    fail<SystemError>("cannot write to folder ", folder_.string(), ": ", error.code().message());
  }
}

KeyframeStore::~KeyframeStore() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void KeyframeStore::write(int frame, const OdometryFrame& maps) {
  constexpr int most_pixels = 640 * 480;
  KeyframeMaps kept;
  kept.road = maps.road;
  const int width = maps.grey.width(), height = maps.grey.height();
  kept.grey.resize(width, height);
  kept.disparity.resize(width, height);
  kept.sigma.resize(width, height);
  for (int v = 0; v < height; ++v) {
    std::copy_n(maps.grey.row(v), width, kept.grey.row(v));
    std::copy_n(maps.disparity.row(v), width, kept.disparity.row(v));
    std::copy_n(maps.sigma.row(v), width, kept.sigma.row(v));
  }
  for (halvings_ = 0; kept.grey.width() * kept.grey.height() > most_pixels; ++halvings_) {
    GreyImage smaller(kept.grey.width() / 2, kept.grey.height() / 2);
    downsample(kept.grey, 2, smaller.view());
    kept.grey = std::move(smaller);
    kept.disparity = halved(kept.disparity);
    kept.sigma = halved(kept.sigma);
    kept.road = halved(kept.road);
  }
  width_ = kept.grey.width();
  height_ = kept.grey.height();
  std::ofstream stream(file(frame), std::ios::binary);
  put(stream, std::vector<double>{kept.road.a0, kept.road.a1, kept.road.a2});
  put(stream, std::vector<std::int16_t>(kept.grey.row(0), kept.grey.row(0) + kept.grey.pixels()));
  put(stream, quantised<std::uint16_t>(kept.disparity, disparity_steps, offset_px()));
  put(stream, quantised<std::uint8_t>(kept.sigma, sigma_steps));
  stream.close();
  if (!stream) fail<SystemError>(file(frame).string(), ": cannot be written: ", std::generic_category().message(errno));
}

KeyframeMaps KeyframeStore::read(int frame) const {
  std::ifstream stream(file(frame), std::ios::binary);
  const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  KeyframeMaps maps;
  const std::vector<double> plane = get<double>(stream, 3);
  maps.road.a0 = plane[0];
  maps.road.a1 = plane[1];
  maps.road.a2 = plane[2];
  const std::vector<std::int16_t> grey = get<std::int16_t>(stream, pixels);
  maps.grey.resize(width_, height_);
  std::copy(grey.begin(), grey.end(), maps.grey.row(0));
  maps.disparity = restored(get<std::uint16_t>(stream, pixels), width_, height_, disparity_steps, offset_px());
  maps.sigma = restored(get<std::uint8_t>(stream, pixels), width_, height_, sigma_steps);
  if (!stream) fail<SystemError>(file(frame).string(), ": cannot be read: ", std::generic_category().message(errno));
  return maps;
}

StereoCalibration KeyframeStore::calibration(const StereoCalibration& full) const {
  StereoCalibration result = full;
  for (int i = 0; i < halvings_; ++i) {
    result.focal_px /= 2;
    result.cx_px = (result.cx_px - 0.5) / 2;
    result.cy_px = (result.cy_px - 0.5) / 2;
    result.disparity_offset_px /= 2;
    result.width /= 2;
    result.height /= 2;
  }
  return result;
}

}  // namespace roadstereo
