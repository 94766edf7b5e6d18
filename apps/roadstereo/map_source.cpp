#include "map_source.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {
namespace {

void require_size(int width, int height, const Image<float>& map, const std::string& file, const MapFiles& files) {
  if (width == map.width() && height == map.height()) return;
  fail(file, " has ", width, "×", height, " pixels and ", files.transformed, " has ", map.width(), "×", map.height(),
       "; they must have equal sizes");
}

/// Linear relation value = factor · residual + offset between the transformed map and the disparity above the road.
struct Scale {
  double factor = 1;
  double offset = 0;
  double correlation = 0;
};

struct Pairing {
  double residual = 0;  ///< of the disparity above the road's plane, pixels
  double value = 0;     ///< of the transformed map
};

std::vector<Pairing> pair_up(const Image<float>& transformed, const Image<float>& disparity,
                             const DisparityPlane& plane) {
  std::vector<Pairing> pairs;
  for (int v = 0; v < transformed.height(); ++v) {
    for (int u = 0; u < transformed.width(); ++u) {
      const double residual = disparity(u, v) - plane.disparity(u, v);
      if (std::isfinite(residual) && std::isfinite(transformed(u, v))) pairs.push_back({residual, transformed(u, v)});
    }
  }
  return pairs;
}

Scale fit_scale(const std::vector<Pairing>& pairs) {
  double residuals = 0;
  double values = 0;
  const auto n = static_cast<double>(pairs.size());
  for (const Pairing& pair : pairs) {
    residuals += pair.residual / n;
    values += pair.value / n;
  }
  double along = 0;
  double across = 0;
  double both = 0;
  for (const Pairing& pair : pairs) {
    along += (pair.residual - residuals) * (pair.residual - residuals);
    across += (pair.value - values) * (pair.value - values);
    both += (pair.residual - residuals) * (pair.value - values);
  }
  if (along == 0 || across == 0) return {};
  const double factor = both / along;
  return {factor, values - factor * residuals, both / std::sqrt(along * across)};
}

/// Converts the map to pixels of disparity.
void scale_to_pixels(const MapFiles& files, TransformedMap& map) {
  constexpr std::size_t min_pairs = 100;
  constexpr double min_correlation = 0.8;
  const std::vector<Pairing> pairs = pair_up(map.transformed, *map.disparity, *map.plane);
  if (pairs.size() < min_pairs) {
    fail(files.transformed, " and ", files.disparity, " share ", pairs.size(), " valid pixels; at least ", min_pairs,
         " are needed");
  }
  const Scale scale = fit_scale(pairs);
  if (!(scale.correlation >= min_correlation)) {
    fail(files.disparity, " does not belong to ", files.transformed,
         ": the correlation of their values above the road is ", scale.correlation, "; it must be at least ",
         min_correlation);
  }
  for (int v = 0; v < map.transformed.height(); ++v) {
    float* row = map.transformed.row(v);
    std::transform(row, row + map.transformed.width(), row,
                   [&](float value) { return static_cast<float>((value - scale.offset) / scale.factor); });
  }
}

DisparityPlane fit_road(const Image<float>& disparity, const std::string& file, int threads) {
  try {
    return estimate_roll(disparity, {}, std::nullopt, 0, {}, threads).plane;
  } catch (const Error& error) {
    fail(file, ": ", error.what());
  }
}

void read_disparity_map(const MapFiles& files, int threads, TransformedMap& map) {
  map.disparity = io::read_disparity(files.disparity);
  require_size(map.disparity->width(), map.disparity->height(), map.transformed, files.disparity, files);
  map.plane = fit_road(*map.disparity, files.disparity, threads);
  scale_to_pixels(files, map);
}

void read_rig(const MapFiles& files, TransformedMap& map) {
  io::CalibrationFile file =
      io::read_calibration(files.calibration.front(), files.calibration.size() > 1 ? files.calibration[1] : "");
  file.select_size(map.transformed.width(), map.transformed.height(), files.calibration.front());
  if (!file.rectified) {
    fail(files.calibration.front(), ": the rig is not rectified; use the calibration of the rectified pair");
  }
  map.calibration = *file.rectified;
  map.calibration->validate(map.transformed.width(), map.transformed.height(), files.calibration.front());
}

}  // namespace

TransformedMap read_transformed_map(const MapFiles& files, int threads) {
  TransformedMap map;
  map.transformed = io::read_disparity(files.transformed);
  if (!files.image.empty()) {
    map.image = io::read_frame(files.image);
    require_size(map.image->width, map.image->height, map.transformed, files.image, files);
  }
  if (!files.disparity.empty()) read_disparity_map(files, threads, map);
  if (!files.calibration.empty()) read_rig(files, map);
  return map;
}

}  // namespace roadstereo::cli
