#include "core/spline_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

constexpr float pole = -0.26794919F;  // √3 − 2, of the filter that makes coefficients of samples
constexpr float gain = 6;             // of both directions of that filter, for one axis
constexpr int stride_margin = 2;      // columns beside the image

/// Initial value of the causal filter of samples that are reflected at both ends.
template <class Sample>
float first_coefficient(int count, const Sample& sample) {
  constexpr int horizon = 16;  // pole^16 is below the resolution of float
  const int last = count - 1, period = 2 * last;
  float sum = 0, power = 1;
  for (int k = 0; k < horizon; ++k, power *= pole) {
    const int reflected = k % period;
    sum += power * sample(reflected <= last ? reflected : period - reflected);
  }
  return sum;
}

/// Filter rows of `width` values in place, a few together, since every value waits for the one before it.
template <std::size_t rows>
void filter_rows(const std::array<float*, rows>& row, int width) {
  std::array<float, rows> value{};
  for (std::size_t r = 0; r < rows; ++r) {
    value[r] = row[r][0] = first_coefficient(width, [&](int u) { return row[r][u]; });
  }
  for (int u = 1; u < width; ++u) {
    for (std::size_t r = 0; r < rows; ++r) value[r] = row[r][u] += pole * value[r];
  }
  constexpr float at_end = pole / (pole * pole - 1);
  for (std::size_t r = 0; r < rows; ++r) {
    value[r] = row[r][width - 1] = at_end * (value[r] + pole * row[r][width - 2]);
  }
  for (int u = width - 2; u >= 0; --u) {
    for (std::size_t r = 0; r < rows; ++r) value[r] = row[r][u] = pole * (value[r] - row[r][u]);
  }
}

/// Filter columns `first` … `last` − 1 of an image in place.
void filter_columns(float* image, int stride, int height, int first, int last) {
  const auto row = [=](int v) { return image + static_cast<std::ptrdiff_t>(v) * stride; };
  float* const top = row(0);
  for (int u = first; u < last; ++u) top[u] = first_coefficient(height, [&](int v) { return row(v)[u]; });
  for (int v = 1; v < height; ++v) {
    const float* const above = row(v - 1);
    float* const here = row(v);
    for (int u = first; u < last; ++u) here[u] += pole * above[u];
  }
  constexpr float at_end = pole / (pole * pole - 1);
  const float* const before_end = row(height - 2);
  float* const end = row(height - 1);
  for (int u = first; u < last; ++u) end[u] = at_end * (end[u] + pole * before_end[u]);
  for (int v = height - 2; v >= 0; --v) {
    const float* const below = row(v + 1);
    float* const here = row(v);
    for (int u = first; u < last; ++u) here[u] = pole * (below[u] - here[u]);
  }
}

/// Read a row of samples of one channel, times the gain of both axes.
template <class Sample>
void read_row(const Sample* samples, int channels, int width, float* values) {
  for (int u = 0; u < width; ++u) values[u] = gain * gain * static_cast<float>(samples[std::ptrdiff_t{u} * channels]);
}

/// Weights of the four coefficients around a place that lies `f`, 0 … 1, after the second.
std::array<float, 4> spline_weights(float f) {
  constexpr float sixth = 1.0F / 6;
  const float g = 1 - f, before = sixth * g * g * g, beyond = sixth * f * f * f;
  const float at = 4 * sixth + f * f * (0.5F * f - 1);
  return {before, at, 1 - before - at - beyond, beyond};
}

}  // namespace

SplinePlaces::SplinePlaces(int width, int height) : width_(width), height_(height) {}

void SplinePlaces::set(const float* x, const float* y, int count) {
  count_ = count;
  const int stride = width_ + stride_margin;
  const auto last_x = static_cast<float>(width_ - 1), last_y = static_cast<float>(height_ - 1);
  for (int k = 0; k < count; ++k) {
    // The order of the operands turns NaN into 0.
    const float u = std::min(std::max(0.0F, x[k]), last_x), v = std::min(std::max(0.0F, y[k]), last_y);
    const int i = std::min(static_cast<int>(u), width_ - 2), j = std::min(static_cast<int>(v), height_ - 2);
    first_[static_cast<std::size_t>(k)] = j * stride + i;
    const auto across = spline_weights(u - static_cast<float>(i)), down = spline_weights(v - static_cast<float>(j));
    for (std::size_t n = 0; n < taps; ++n) {
      across_[n][static_cast<std::size_t>(k)] = across[n];
      down_[n][static_cast<std::size_t>(k)] = down[n];
    }
  }
}

SplineImage::SplineImage(const FrameView& frame, int channel, int threads)
    : width_(frame.width), height_(frame.height) {
  constexpr int rows_per_band = 16, columns_per_band = 64;
  constexpr std::size_t together = 4;
  const int stride = width_ + stride_margin, channels = channel_count(frame.order);
  coefficients_.resize(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height_ + 2));
  const auto row = [&](int v) { return coefficients_.data() + static_cast<std::ptrdiff_t>(v + 1) * stride + 1; };
  std::vector<std::array<float, 2>> ranges(static_cast<std::size_t>((height_ + rows_per_band - 1) / rows_per_band));
  parallel_rows(height_, rows_per_band, threads, [&](int first, int last, int) {
    auto& range = ranges[static_cast<std::size_t>(first / rows_per_band)];
    range = {HUGE_VALF, -HUGE_VALF};
    for (int v = first; v < last; ++v) {
      const auto* const bytes = static_cast<const std::uint8_t*>(frame.data) + v * frame.stride_bytes;
      if (frame.sample == SampleType::u8) {
        read_row(bytes + channel, channels, width_, row(v));
      } else {
        read_row(reinterpret_cast<const std::uint16_t*>(bytes) + channel, channels, width_, row(v));
      }
      const auto [least, most] = std::minmax_element(row(v), row(v) + width_);
      range = {std::min(range[0], *least), std::max(range[1], *most)};
    }
    int v = first;
    for (; v + static_cast<int>(together) <= last; v += together) {
      filter_rows<together>({row(v), row(v + 1), row(v + 2), row(v + 3)}, width_);
    }
    for (; v < last; ++v) filter_rows<1>({row(v)}, width_);
  });
  darkest_ = ranges[0][0] / (gain * gain);
  brightest_ = ranges[0][1] / (gain * gain);
  for (const auto& range : ranges) {
    darkest_ = std::min(darkest_, range[0] / (gain * gain));
    brightest_ = std::max(brightest_, range[1] / (gain * gain));
  }
  parallel_rows(width_, columns_per_band, threads,
                [&](int first, int last, int) { filter_columns(row(0), stride, height_, first, last); });
  for (int v = 0; v < height_; ++v) {
    float* const values = row(v);
    values[-1] = values[1];
    values[width_] = values[width_ - 2];
  }
  std::copy_n(row(1) - 1, stride, row(-1) - 1);
  std::copy_n(row(height_ - 2) - 1, stride, row(height_) - 1);
}

void SplineImage::sample(const SplinePlaces& places, float* values) const {
  constexpr std::size_t taps = SplinePlaces::taps;
  const int stride = width_ + stride_margin;
  for (std::size_t k = 0; k < static_cast<std::size_t>(places.count_); ++k) {
    const float* const a = coefficients_.data() + places.first_[k];
    const float *const b = a + stride, *const c = b + stride, *const d = c + stride;
    const float of_a = places.down_[0][k], of_b = places.down_[1][k], of_c = places.down_[2][k],
                of_d = places.down_[3][k];
    std::array<float, taps> column{};
    for (std::size_t n = 0; n < taps; ++n) column[n] = of_a * a[n] + of_b * b[n] + of_c * c[n] + of_d * d[n];
    const float value = places.across_[0][k] * column[0] + places.across_[1][k] * column[1] +
                        places.across_[2][k] * column[2] + places.across_[3][k] * column[3];
    values[k] = std::clamp(value, darkest_, brightest_);
  }
}

}  // namespace roadstereo
