#include "core/resampling.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "core/spline_image.hpp"

namespace roadstereo {
namespace {

using Values = std::array<float, SplinePlaces::max_count>;

template <class Sample>
void resample_rows(const std::vector<SplineImage>& channels, SplinePlaces& places, ImageView<const float> x,
                   ImageView<const float> y, int first, int last, Sample* samples) {
  Values values;
  samples += static_cast<std::ptrdiff_t>(first) * x.width() * static_cast<std::ptrdiff_t>(channels.size());
  for (int v = first; v < last; ++v) {
    for (int u = 0; u < x.width(); u += SplinePlaces::max_count) {
      const int count = std::min(SplinePlaces::max_count, x.width() - u);
      places.set(x.row(v) + u, y.row(v) + u, count);
      for (std::size_t c = 0; c < channels.size(); ++c) {
        channels[c].sample(places, values.data());
        Sample* sample = samples + c;
        for (int k = 0; k < count; ++k, sample += channels.size()) {
          // Not negative, and lround is a call for every pixel.
          const float rounded = values[static_cast<std::size_t>(k)] + 0.5F;
          *sample = static_cast<Sample>(static_cast<int>(rounded));
        }
      }
      samples += static_cast<std::size_t>(count) * channels.size();
    }
  }
}

}  // namespace

Frame resample(const FrameView& frame, ImageView<const float> x, ImageView<const float> y, int threads) {
  constexpr int rows_per_band = 8;
  std::vector<SplineImage> channels;
  channels.reserve(static_cast<std::size_t>(channel_count(frame.order)));
  for (int c = 0; c < channel_count(frame.order); ++c) channels.emplace_back(frame, c, threads);
  const bool is_narrow = frame.sample == SampleType::u8;
  Frame result{{}, x.width(), x.height(), frame.sample, frame.order};
  result.bytes.resize(channels.size() * static_cast<std::size_t>(x.width()) * static_cast<std::size_t>(x.height()) *
                      (is_narrow ? sizeof(std::uint8_t) : sizeof(std::uint16_t)));
  parallel_rows(x.height(), rows_per_band, threads, [&](int first, int last, int) {
    SplinePlaces places(frame.width, frame.height);
    if (is_narrow) {
      resample_rows(channels, places, x, y, first, last, result.bytes.data());
    } else {
      resample_rows(channels, places, x, y, first, last, reinterpret_cast<std::uint16_t*>(result.bytes.data()));
    }
  });
  return result;
}

}  // namespace roadstereo
