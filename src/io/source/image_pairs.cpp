#include "io/source/image_pairs.hpp"

#include <algorithm>
#include <utility>

#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::io {

ImagePairs::ImagePairs(std::vector<ImagePair> pairs, std::string kind, const std::filesystem::path& folder)
    : pairs_(std::move(pairs)), kind_(std::move(kind)) {
  const std::filesystem::path file = folder / "calibration.yaml";
  if (std::filesystem::exists(file)) calibration_ = file.string();
}

std::optional<SourcePair> ImagePairs::next() {
  if (next_ >= pairs_.size()) return std::nullopt;
  const ImagePair& files = pairs_[next_];
  SourcePair pair;
  pair.index = static_cast<std::int64_t>(next_++);
  pair.name = files.name;
  pair.time_s = files.time_s;
  pair.error = files.error;
  if (!pair.error.empty()) return pair;
  try {
    pair.left = read_frame(files.left);
    pair.right = read_frame(files.right);
    if (pair.left.width != pair.right.width || pair.left.height != pair.right.height) {
      fail("left and right image have different sizes: ", files.left, " has ", pair.left.width, "×", pair.left.height,
           " pixels, ", files.right, " has ", pair.right.width, "×", pair.right.height);
    }
  } catch (const Error& error) {
    pair.error = error.what();
  }
  return pair;
}

void ImagePairs::skip(std::int64_t pairs) {
  const auto left = static_cast<std::int64_t>(pairs_.size() - next_);
  next_ += static_cast<std::size_t>(std::clamp<std::int64_t>(pairs, 0, left));
}

std::optional<CalibrationFile> ImagePairs::calibration() const {
  if (calibration_.empty()) return std::nullopt;
  return read_calibration(calibration_);
}

std::string ImagePairs::description() const {
  return kind_ + ", " + std::to_string(pairs_.size()) + (pairs_.size() == 1 ? " pair" : " pairs");
}

}  // namespace roadstereo::io
