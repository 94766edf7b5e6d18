#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/scan_surface.hpp"
#include "pair_source.hpp"

namespace roadstereo::cli {

/// A stereo pair of a pothole and the scan of its cast.
struct ScanFiles {
  std::string name;
  PairFiles pair;
  std::string label;  ///< mask of the pothole, left image
  std::string scan;
};

/// The pairs of a folder with left/, right/, label/ (pM_NN.png: pothole M, frame NN), scan/pM_*.ply and
/// calibration_pM….yaml, whose digits are the potholes that it serves (calibration_p12.yaml: 1 and 2). Sorted by name.
/// Throws Error naming what is missing.
std::vector<ScanFiles> find_scan_frames(const std::string& folder);

/// The points of a cloud from a file, times `to_mm`.
Points read_points(const std::string& path, double to_mm);

/// The points of the labelled pixels that have a disparity, millimetres, and the pixels themselves.
struct LabelledPoints {
  Points points;
  std::vector<std::array<int, 2>> pixels;  ///< (u, v) of each point
  std::size_t labelled = 0;                ///< pixels of the label
};

/// Throws Error when the label has another size than the map or marks nothing.
LabelledPoints labelled_points(ImageView<const float> disparity, ImageView<const std::uint8_t> label,
                               const StereoCalibration& calibration);

}  // namespace roadstereo::cli
