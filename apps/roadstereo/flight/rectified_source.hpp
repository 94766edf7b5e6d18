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
  /// `calibration`: empty (then that of the source, if any), one file, or two, left and right. Throws Error
  /// naming a file that is not a calibration.
  RectifiedSource(std::unique_ptr<io::FrameSource> source, const std::vector<std::string>& calibration);

  /// Returns the next pair, rectified, or nullopt at the end. `error` is set if it cannot be rectified.
  std::optional<io::SourcePair> next();

  /// Rectifies a pair of the source in place; sets its `error` on failure.
  void rectify(io::SourcePair& pair);

  io::FrameSource& source() { return *source_; }

  /// Calibration of the rectified frames; absent without a calibration, and before the first pair if the file of an
  /// unrectified rig has no image size.
  const std::optional<StereoCalibration>& calibration() const { return calibration_; }
  const std::string& calibration_format() const { return format_; }  ///< empty without a calibration

  /// Sample value of white, determined from the first valid pair of a 16-bit source; 0: maximum of the sample type.
  double white_level() const { return white_level_; }

  /// Sets the white level instead of determining it.
  void set_white_level(double level);
  /// Accepts samples above the white level, which somebody else sets.
  void ignore_white_level() { checks_white_ = false; }

 private:
  void prepare(const io::SourcePair& first);
  void require_white_level(const io::SourcePair& pair) const;

  std::unique_ptr<io::FrameSource> source_;
  std::optional<io::CalibrationFile> file_;
  std::string file_name_;
  std::string format_;
  std::optional<StereoCalibration> calibration_;
  std::optional<io::Rectifier> rectifier_;
  double white_level_ = 0;
  bool white_known_ = false;
  bool checks_white_ = true;
  bool prepared_ = false;
};

}  // namespace roadstereo::cli
