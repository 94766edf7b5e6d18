#include "roadstereo/perspective.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/max_disparities.hpp"
#include "core/parallel.hpp"
#include "core/require_range.hpp"
#include "core/require_size.hpp"
#include "core/scratch.hpp"
#include "road/cubic.hpp"
#include "road/cubic_row.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 32;

/// Room beyond the wanted range, so that the winner at its end still has neighbours and a small error of the road
/// model costs nothing.
constexpr double margin_px = 2.0;

/// How far below and above the road's disparity must be searched, pixels.
struct ResidualRange {
  double below = 0;
  double above = 0;
};

/// Residual disparities of the deepest damage and the highest bump where the road is nearest to the camera. A point
/// at distance e beyond the road plane has the road's disparity times h / (h + e), h = distance of camera and plane.
ResidualRange physical_range(const PerspectiveShift& shift, int width, int height, const PerspectiveOptions& options) {
  const double h = shift.camera_height_m;
  const DisparityPlane& road = shift.road;
  const std::array<double, 4> corners{road.disparity(0, 0), road.disparity(width - 1, 0), road.disparity(0, height - 1),
                                      road.disparity(width - 1, height - 1)};
  const double nearest = *std::max_element(corners.begin(), corners.end()) + shift.disparity_offset_px;
  const double bump = std::min(options.max_bump_height_m, 0.5 * h);
  return {nearest * options.max_damage_depth_m / (h + options.max_damage_depth_m), nearest * bump / (h - bump)};
}

/// Largest disparity of the scene: what the correspondences show, but not more than a quarter of the image, since wrong
/// ones lie anywhere.
double max_scene_disparity(const RoadModelEstimate& road, int width) {
  const double largest = width / 4.0;
  return road.max_disparity_px > 0 ? std::min(road.max_disparity_px * 1.1 + 8, largest) : largest;
}

/// Pixels that cubic interpolation reads beyond the ends of a row, where the target is misaligned, too: copies of the
/// border.
constexpr std::ptrdiff_t border = 2 + static_cast<std::ptrdiff_t>(Misalignment::max_px);

/// out[x] = what lies `f_at_first` + x·`f_step` below row v of the image, for x in [0, columns); both are 0 … 1 there.
void interpolate_rows(ImageView<const std::int16_t> image, int v, int first, int columns, float f_at_first,
                      float f_step, float* out) {
  const auto row = [&](int below) { return image.row(std::clamp(v + below, 0, image.height() - 1)) + first; };
  const std::int16_t *a = row(-1), *b = row(0), *c = row(1), *d = row(2);
  if (f_at_first == 0 && f_step == 0) {
    std::copy_n(b, columns, out);
    return;
  }
  for (int x = 0; x < columns; ++x) {
    const CubicWeights weight = cubic_weights(f_at_first + static_cast<float>(x) * f_step);
    out[x] = weighted(weight, a[x], b[x], c[x], d[x]);
  }
}

/// padded = row v of the view as it should be, in runs of columns that lie between the same two rows of the image.
void copy_with_border(ImageView<const std::int16_t> image, int v, const Misalignment& misalignment, float* padded) {
  const int width = image.width();
  const double slope = misalignment.turn_rad;
  float* out = padded + border;
  for (int begin = 0; begin < width;) {
    const double at_begin = misalignment.rows_at(begin, v), whole = std::floor(at_begin);
    int end = width;
    if (slope != 0) {
      const double limit = slope > 0 ? whole + 1 : whole;  // where the next two rows begin
      const double run = std::ceil((limit - at_begin) / slope);
      end = run < width - begin ? begin + std::max(1, static_cast<int>(run)) : width;
    }
    interpolate_rows(image, v + static_cast<int>(whole), begin, end - begin, static_cast<float>(at_begin - whole),
                     static_cast<float>(slope), out + begin);
    begin = end;
  }
  std::fill_n(padded, border, out[0]);
  std::fill_n(out + width, border, out[width - 1]);
}

/// One row of the transformed target from column `first` on, out[x] = row(x − shift), in runs of columns whose shift
/// has one whole part.
void transform_row(const float* row, const PerspectiveShift& shift, int v, int first, int width, std::int16_t* out) {
  for (int begin = first; begin < width;) {
    const bool is_shifted = shift.at(begin, v) > 0;
    const double at_begin = source_shift(shift, begin, v);
    const int whole = static_cast<int>(std::ceil(at_begin));
    int end = begin + 1;
    for (int reach = width - begin; reach > 0; reach /= 2) {
      const auto inside = [&](int x) {
        return static_cast<int>(std::ceil(source_shift(shift, x, v))) == whole && (shift.at(x, v) > 0) == is_shifted;
      };
      while (end + reach <= width && inside(end + reach - 1)) end += reach;
    }
    const double step = end - begin > 1 ? (source_shift(shift, end - 1, v) - at_begin) / (end - 1 - begin) : 0;
    sample_cubic(row + border - whole, static_cast<float>(whole - at_begin), static_cast<float>(-step), begin, end,
                 out);
    begin = end;
  }
}

}  // namespace

void PerspectiveOptions::validate() const {
  require_range("perspective", "max_damage_depth_m", max_damage_depth_m, Above{0.0}, 2.0);
  require_range("perspective", "max_bump_height_m", max_bump_height_m, Above{0.0}, 2.0);
  require_range("perspective", "disparities", disparities, 0, max_disparities);
  require_range("perspective", "delta_p_px", delta_p_px, -unlimited, double{max_disparities});
  if (disparities > 0 && delta_p_px >= disparities) {
    fail("perspective.delta_p_px is ", delta_p_px, "; it must be less than perspective.disparities, ", disparities);
  }
}

PerspectiveShift plan_perspective(const RoadModelEstimate& road, const std::optional<StereoCalibration>& calibration,
                                  int width, int height, const PerspectiveOptions& options) {
  options.validate();
  require_image_size(width, height);
  PerspectiveShift shift;
  shift.whole_pixel = options.shift == ShiftPrecision::whole_pixel;
  shift.enabled = options.enabled && road.has_road();
  if (!shift.enabled) {
    const int full_range = static_cast<int>(std::ceil(max_scene_disparity(road, width))) + 1;
    shift.disparities =
        options.disparities > 0 ? options.disparities : std::clamp(full_range, 8, std::min(max_disparities, width - 1));
    return shift;
  }
  shift.road = road.model;
  if (calibration) {
    shift.camera_height_m = ground_plane(road.model, *calibration).height_m;
    shift.disparity_offset_px = calibration->disparity_offset_px;
  }
  // What the correspondences show of the road's unevenness, and what is to be measured.
  const ResidualRange physical = physical_range(shift, width, height, options);
  ResidualRange range{std::max(-road.residual_p01_px, physical.below), std::max(road.residual_p99_px, physical.above)};
  // Where the road's disparity is 0 or less there is no shift, and the residual is the disparity.
  if (options.scope == Scope::scene) range.above = std::max(range.above, max_scene_disparity(road, width));
  range.below += margin_px;
  range.above += margin_px;
  if (options.disparities > 0) {
    // A given number of disparities is shared out in the same proportion.
    shift.disparities = options.disparities;
    shift.delta_p = std::round((shift.disparities - 1) * range.below / (range.below + range.above));
  } else {
    shift.delta_p = std::ceil(range.below);
    const double above = options.delta_p_px >= 0 ? options.delta_p_px - shift.delta_p : 0;
    shift.disparities = std::clamp(static_cast<int>(std::ceil(shift.delta_p + above + range.above)) + 1, 1,
                                   std::min(max_disparities, width - 1));
  }
  if (options.delta_p_px >= 0) shift.delta_p = options.delta_p_px;
  if (shift.delta_p >= shift.disparities) {
    fail("perspective.delta_p_px is ", shift.delta_p, "; it must be less than the ", shift.disparities,
         " disparities that are searched in images ", width, " pixels wide");
  }
  return shift;
}

void transform_target(ImageView<const std::int16_t> target, const PerspectiveShift& shift, int threads,
                      GreyImage& transformed, std::vector<int>& first_column) {
  const int width = target.width();
  const int height = target.height();
  require_range("misalignment", "largest_px", shift.misalignment.largest_px(width, height), 0.0, Misalignment::max_px);
  transformed.resize(width, height);
  first_column.resize(static_cast<std::size_t>(height));
  const std::size_t padded = static_cast<std::size_t>(width + 2 * border);
  auto rows = scratch_vector<float>(padded * static_cast<std::size_t>(resolve_threads(threads)));
  parallel_rows(height, rows_per_band, threads, [&](int first_row, int last_row, int worker) {
    float* in = rows.data() + padded * static_cast<std::size_t>(worker);
    for (int v = first_row; v < last_row; ++v) {
      const int first = find_first_column(shift, v, width);
      first_column[static_cast<std::size_t>(v)] = first;
      copy_with_border(target, v, shift.misalignment, in);
      std::fill_n(transformed.row(v), first, std::int16_t{0});
      transform_row(in, shift, v, first, width, transformed.row(v));
    }
  });
}

void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, int pixel_step, int threads,
                       Image<float>& disparity) {
  disparity.resize(residual.width(), residual.height());
  parallel_rows(residual.height(), rows_per_band, threads, [&](int first_row, int last_row, int) {
    for (int y = first_row; y < last_row; ++y) {
      const float* in = residual.row(y);
      float* out = disparity.row(y);
      if (!shift.enabled) {
        std::copy_n(in, residual.width(), out);
        continue;
      }
      const int v = y * pixel_step;
      if (shift.whole_pixel) {
        for (int x = 0; x < residual.width(); ++x) out[x] = with_whole_shift(in[x], shift, x * pixel_step, v);
        continue;
      }
      const RowLine road = row_line(shift.road, v, shift.delta_p);
      for (int x = 0; x < residual.width(); ++x) out[x] = with_shift(in[x], road, x * pixel_step);
    }
  });
}

}  // namespace roadstereo
