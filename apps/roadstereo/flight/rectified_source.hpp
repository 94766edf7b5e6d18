#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/io/calibration_file.hpp"
#include "roadstereo/io/frame_source.hpp"
#include "roadstereo/io/rectification.hpp"

namespace roadstereo::cli {

/// A source whose pairs are rectified with its calibration.
class RectifiedSource {
 public:
  /// `calibration`: empty (then that of the source, if any), one file, or two, left and right. `threads`: workers
  /// of the rectification, 0 takes all cores. Throws Error naming a file that is not a calibration.
  RectifiedSource(std::unique_ptr<io::FrameSource> source, const std::vector<std::string>& calibration,
                  int threads = 0);

  /// Returns the next pair, rectified, or nullopt at the end. `error` is set if it cannot be rectified. The white level
  /// of 16-bit pairs is that of the brightest one so far (io::find_white_level): a recording may begin in the dark.
  std::optional<io::SourcePair> next();

  /// Rectifies a pair of the source in place; sets its `error` on failure.
  void rectify(io::SourcePair& pair);

  io::FrameSource& source() { return *source_; }

  /// Calibration of the rectified frames; absent without a calibration, and before the first pair if the file of an
  /// unrectified rig has no image size.
  const std::optional<StereoCalibration>& calibration() const { return calibration_; }
  /// The same with the size of the pictures, once there was a pair.
  std::optional<StereoCalibration> sized_calibration() const;
  /// Why the calibration may be of another image size, naming its file; empty: it is not, or there was no pair yet.
  const std::string& size_doubt() const { return size_doubt_; }
  const std::string& calibration_format() const { return format_; }  ///< empty without a calibration

  /// The white level that earlier pairs have needed.
  void set_white_level(double level) { white_level_ = level; }
  /// Leaves SourcePair::white_level unknown.
  void ignore_white_level() { finds_white_ = false; }

 private:
  void prepare(const io::SourcePair& first);
  io::Rectifier make_rectifier(int width, int height) const;
  double needed_white_level(const io::SourcePair& pair) const;

  std::unique_ptr<io::FrameSource> source_;
  int threads_;
  std::optional<io::CalibrationFile> file_;
  std::string file_name_;
  std::string format_;
  std::string size_doubt_;
  std::optional<StereoCalibration> calibration_;
  std::optional<io::Rectifier> rectifier_;
  double white_level_ = 0;
  bool finds_white_ = true;
  bool prepared_ = false;
  int width_ = 0, height_ = 0;  ///< of the first pair
};

}  // namespace roadstereo::cli
