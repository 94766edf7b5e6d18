#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

/// One pair of image files, or the reason why it is incomplete.
struct ImagePair {
  std::string name;
  std::string left;
  std::string right;
  double time_s = std::numeric_limits<double>::quiet_NaN();
  std::string error;
};

/// Reads pairs of image files.
class ImagePairs final : public FrameSource {
 public:
  /// The calibration is that of `calibration.yaml` in `folder`, if there is one.
  ImagePairs(std::vector<ImagePair> pairs, std::string kind, const std::filesystem::path& folder);

  std::optional<SourcePair> next() override;
  void skip(std::int64_t pairs) override;
  std::optional<std::int64_t> size() const override { return static_cast<std::int64_t>(pairs_.size()); }
  std::optional<CalibrationFile> calibration() const override;
  std::string calibration_file() const override { return calibration_; }
  std::string description() const override;

 private:
  std::vector<ImagePair> pairs_;
  std::string kind_;
  std::string calibration_;
  std::size_t next_ = 0;
};

}  // namespace roadstereo::io
