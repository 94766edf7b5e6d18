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

/// A source together with its calibration: its pairs come out rectified.
class RectifiedSource {
 public:
  /// `calibration`: none (then the source's own, if it has one), one file, or the two of a ROS pair. Throws Error
  /// naming a file that is no calibration.
  RectifiedSource(std::unique_ptr<io::FrameSource> source, const std::vector<std::string>& calibration);

  /// The next pair, rectified; one that cannot be (another size, say) carries its reason. Nothing at the end.
  std::optional<io::SourcePair> next();

  /// The same for a pair that was taken from the source.
  void rectify(io::SourcePair& pair);

  io::FrameSource& source() { return *source_; }

  /// The calibration that belongs to rectified frames; known before the first frame unless the rig must be rectified
  /// and its file does not tell the size. Absent without a calibration.
  const std::optional<StereoCalibration>& calibration() const { return calibration_; }
  const std::string& calibration_format() const { return format_; }  ///< empty without a calibration

  /// Sample value of white, found on the first good pair of a 16-bit source; 0 takes the largest of the sample type.
  double white_level() const { return white_level_; }

  /// Takes white as found earlier instead of looking for it.
  void set_white_level(double level);

 private:
  void prepare(const io::SourcePair& first);

  std::unique_ptr<io::FrameSource> source_;
  std::optional<io::CalibrationFile> file_;
  std::string file_name_;
  std::string format_;
  std::optional<StereoCalibration> calibration_;
  std::optional<io::Rectifier> rectifier_;
  double white_level_ = 0;
  bool white_known_ = false;
  bool prepared_ = false;
};

}  // namespace roadstereo::cli
