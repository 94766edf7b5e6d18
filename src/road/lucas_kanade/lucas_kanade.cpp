#include "roadstereo/lucas_kanade.hpp"

#include <algorithm>
#include <cstddef>

#include "core/mid_grey.hpp"
#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/scratch.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 32;
constexpr std::size_t planes = 10;  // of AlignmentSums

/// What is aligned.
struct AlignmentMaps {
  const TransformedPair& pair;
  ImageView<const float> disparity;

  int width() const { return disparity.width(); }
  int height() const { return disparity.height(); }
};

/// Sums over the columns of the windows of one row of pixels, updated from row to row. A sample is an integer times a
/// small power of two but for its rounding, and sums are of double precision: they do not depend on where a band
/// begins.
class AlignmentColumns {
 public:
  AlignmentColumns(const AlignmentMaps& maps, int radius, double* numbers, AlignmentSample* samples, float* rows)
      : maps_(maps),
        radius_(radius),
        pitch_(static_cast<std::size_t>(maps.width() + 2 * radius + 1)),
        sums_(numbers),
        samples_(samples),
        rows_(rows) {}

  static std::size_t numbers(int width, int radius) {
    return planes * static_cast<std::size_t>(width + 2 * radius + 1);
  }
  static std::size_t samples(int width, int radius) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(2 * radius + 1);
  }

  /// Sums for the windows around row v, the first of a band.
  void begin(int v) {
    std::fill_n(sums_, planes * pitch_, 0.0);
    for (int row = v - radius_; row <= v + radius_; ++row) add(row);
  }
  /// Goes on from row v to row v + 1.
  void move_down(int v) {
    add_products(v - radius_, -1.0);
    add(v + radius_ + 1);
  }
  /// Column u of plane k, for −radius ≤ u ≤ width + radius.
  const double* plane(std::size_t k) const { return sums_ + k * pitch_ + radius_ + 1; }

 private:
  AlignmentSample* row(int v) const {
    return samples_ + static_cast<std::size_t>(v % (2 * radius_ + 1)) * static_cast<std::size_t>(maps_.width());
  }

  /// Leaves the ends of the row as they are: no sample is there.
  void prefilter(const std::int16_t* row, float* filtered) const {
    for (int u = prefilter_radius; u < maps_.width() - prefilter_radius; ++u) filtered[u] = prefiltered(row, u);
  }

  void add(int v) {
    if (v < 0 || v >= maps_.height()) return;
    AlignmentSample* const out = row(v);
    const TransformedPair& pair = maps_.pair;
    const int first = pair.first_column != nullptr ? pair.first_column[v] : 0;
    const float* const disparity = maps_.disparity.row(v);
    prefilter(pair.reference.row(v), rows_);
    float* const target = rows_ + maps_.width();
    prefilter(pair.target.row(v), target);
    const RowLine road = shift_line(pair.shift, v);
    constexpr float centre = 9.0F * mid_grey;
    for (int u = 0; u < maps_.width(); ++u) {
      out[u] = alignment_sample(rows_, target, first, maps_.width(), u, without_shift(disparity[u], road, u), centre);
    }
    add_products(v, 1.0);
  }

  void add_products(int v, double sign) {
    if (v < 0 || v >= maps_.height()) return;
    const AlignmentSample* const in = row(v);
    double* const n = sums_ + radius_ + 1;
    for (int u = 0; u < maps_.width(); ++u) {
      const double weight = sign * static_cast<double>(in[u].weight);
      const double t = static_cast<double>(in[u].target), g = static_cast<double>(in[u].gradient);
      const double r = static_cast<double>(in[u].difference);
      double* at = n + u;
      const auto accumulate = [&at, this](double value) {
        *at += value;
        at += pitch_;
      };
      accumulate(weight);
      accumulate(sign * t);
      accumulate(sign * g);
      accumulate(sign * r);
      accumulate(sign * t * t);
      accumulate(sign * t * g);
      accumulate(sign * t * r);
      accumulate(sign * g * g);
      accumulate(sign * g * r);
      accumulate(sign * r * r);
    }
  }

  const AlignmentMaps& maps_;
  int radius_;
  std::size_t pitch_;
  double* sums_;
  AlignmentSample* samples_;
  float* rows_;  ///< prefiltered rows of reference and target
};

void align_row(const AlignmentMaps& maps, const AlignmentColumns& columns, int radius,
               const AlignmentSettings& settings, int v, float* aligned) {
  const double* plane[planes];
  double sum[planes] = {};
  for (std::size_t k = 0; k < planes; ++k) {
    plane[k] = columns.plane(k);
    for (int u = -radius; u < radius; ++u) sum[k] += plane[k][u];
  }
  const float* const disparity = maps.disparity.row(v);
  const float full_scale = 1 - shift_line(maps.pair.shift, v).slope;  // d disparity / d residual
  for (int u = 0; u < maps.width(); ++u) {
    for (std::size_t k = 0; k < planes; ++k) sum[k] += plane[k][u + radius] - (u > 0 ? plane[k][u - radius - 1] : 0.0);
    const AlignmentSums<double> sums{sum[0], sum[1], sum[2], sum[3], sum[4], sum[5], sum[6], sum[7], sum[8], sum[9]};
    aligned[u] = disparity[u] + full_scale * alignment_shift(sums, settings);
  }
}

}  // namespace

void LucasKanadeOptions::validate() const {
  require_range("lucas_kanade", "radius", radius, 0, 16);
  require_range("lucas_kanade", "max_shift_px", max_shift_px, 0.01, 2.0);
  require_range("lucas_kanade", "bias_sigma_px", bias_sigma_px, 0.001, 10.0);
}

void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, const LucasKanadeOptions& options,
                  int threads, Image<float>& aligned) {
  options.validate();
  for (const ImageView<const std::int16_t>& image : {pair.reference, pair.target}) {
    if (image.width() == disparity.width() && image.height() == disparity.height()) continue;
    fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels and an image ", image.width(),
         "×", image.height(), "; they must be equal");
  }
  const AlignmentMaps maps{pair, disparity};
  const int radius = options.radius;
  aligned.resize(maps.width(), maps.height());
  const AlignmentSettings settings = alignment_settings(options);
  const auto workers = static_cast<std::size_t>(resolve_threads(threads));
  const std::size_t numbers = AlignmentColumns::numbers(maps.width(), radius);
  const std::size_t samples = AlignmentColumns::samples(maps.width(), radius);
  auto all_numbers = scratch_vector<double>(numbers * workers);
  const std::size_t row_numbers = 2 * static_cast<std::size_t>(maps.width());
  auto all_rows = scratch_vector<float>(row_numbers * workers);
  auto all_samples = scratch_vector<AlignmentSample>(samples * workers);
  parallel_rows(maps.height(), rows_per_band, threads, [&](int first, int last, int worker) {
    const auto own = static_cast<std::size_t>(worker);
    AlignmentColumns columns(maps, radius, all_numbers.data() + own * numbers, all_samples.data() + own * samples,
                             all_rows.data() + own * row_numbers);
    columns.begin(first);
    for (int v = first; v < last; ++v) {
      align_row(maps, columns, radius, settings, v, aligned.row(v));
      if (v + 1 < last) columns.move_down(v);
    }
  });
}

}  // namespace roadstereo
