#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/scan_surface.hpp"
#include "pair_source.hpp"

namespace roadstereo::cli {

/// Files of a stereo pair of a pothole.
struct LabelledFiles {
  std::string name;
  PairFiles pair;
  std::string label;  ///< mask of the pothole in the left image
};

/// Find the pairs of a folder with left/, right/, label/ (pM_NN.png: pothole M, frame NN) and calibration_pM….yaml,
/// whose digits are the potholes that it applies to (calibration_p12.yaml: 1 and 2), or calibration.yaml for all
/// others. Sorted by name. Throws Error naming the file or folder that is missing.
std::vector<LabelledFiles> find_labelled_pairs(const std::string& folder);

/// The same and the scan of its cast.
struct ScanFiles : LabelledFiles {
  std::string scan;
};

/// The labelled pairs of a folder with scan/pM_*.ply. Throws Error likewise.
std::vector<ScanFiles> find_scan_frames(const std::string& folder);

/// Read the points of a PLY file and scale them by `to_mm`.
Points read_points(const std::string& path, double to_mm);

/// Points of the labelled pixels with a disparity.
struct LabelledPoints {
  Points points;                           ///< camera frame, millimetres
  std::vector<std::array<int, 2>> pixels;  ///< (u, v) of each point
  std::size_t labelled = 0;                ///< labelled pixels, with or without a disparity
};

/// Reconstruct the points of the labelled pixels. Throws Error when the sizes differ or no pixel is labelled.
LabelledPoints labelled_points(ImageView<const float> disparity, ImageView<const std::uint8_t> label,
                               const StereoCalibration& calibration);

}  // namespace roadstereo::cli
