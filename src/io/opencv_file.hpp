#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/calibration_formats.hpp"

namespace roadstereo::io {

/// A top-level entry of a file of cv::FileStorage.
struct OpenCvEntry {
  enum class Kind { text, list, matrix, other };
  Kind kind = Kind::other;
  std::vector<std::string> words;  ///< one of a text, those of a list or of a matrix
  std::string rows;                ///< of a matrix, not parsed
  std::string cols;
};

/// Top-level entries by their keys.
using OpenCvEntries = std::map<std::string, OpenCvEntry, std::less<>>;

/// Parses a file in the YAML, JSON or XML dialect of cv::FileStorage, without cv::FileStorage: its parsers neither
/// bound the depth of their recursion nor end on every input. Throws Error naming the file.
OpenCvEntries parse_opencv_file(const CalibrationText& file);

}  // namespace roadstereo::io
