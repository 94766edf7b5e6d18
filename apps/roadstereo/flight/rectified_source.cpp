#include "flight/rectified_source.hpp"

#include <algorithm>
#include <utility>

#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {

RectifiedSource::RectifiedSource(std::unique_ptr<io::FrameSource> source, const std::vector<std::string>& calibration,
                                 int threads)
    : source_(std::move(source)), threads_(threads) {
  if (!calibration.empty()) {
    file_ = io::read_calibration(calibration[0], calibration.size() > 1 ? calibration[1] : "");
    file_name_ = calibration[0];
  } else {
    file_ = source_->calibration();
    file_name_ = "the calibration of the source";
  }
  if (!file_) return;
  format_ = file_->format;
  calibration_ = file_->rectified;
  if (!file_->rectified && !file_->rig && file_->rigs.empty())
    fail(file_name_, ": there is no stereo calibration in this file");
  if (file_->rig && file_->rig->width > 0) {
    rectifier_.emplace(make_rectifier(file_->rig->width, file_->rig->height));
    calibration_ = rectifier_->calibration();
  }
}

io::Rectifier RectifiedSource::make_rectifier(int width, int height) const {
  try {
    return io::Rectifier(*file_->rig, width, height, threads_);
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    fail(file_name_, ": ", error.what());
  }
}

/// Determines the rectification maps from the first valid pair.
void RectifiedSource::prepare(const io::SourcePair& first) {
  if (file_) {
    file_->select_size(first.left.width, first.left.height, file_name_);
    if (!calibration_) calibration_ = file_->rectified;
    size_doubt_ = file_->size_doubt(first.left.width, first.left.height);
    if (!size_doubt_.empty()) size_doubt_ = file_name_ + ": " + size_doubt_;
  }
  if (file_ && file_->rig && !rectifier_) {
    rectifier_.emplace(make_rectifier(first.left.width, first.left.height));
    calibration_ = rectifier_->calibration();
  }
  prepared_ = true;
  width_ = first.left.width;
  height_ = first.left.height;
}

std::optional<StereoCalibration> RectifiedSource::sized_calibration() const {
  std::optional<StereoCalibration> sized = calibration_;
  if (sized && sized->width == 0) {
    sized->width = width_;
    sized->height = height_;
  }
  return sized;
}

/// White level that a pair needs; 0 where it is not to be found.
double RectifiedSource::needed_white_level(const io::SourcePair& pair) const {
  if (!finds_white_ || pair.left.sample != SampleType::u16 || pair.right.sample != SampleType::u16) return 0;
  return io::find_white_level(pair.left.view(), pair.right.view());
}

void RectifiedSource::rectify(io::SourcePair& pair) {
  if (!pair.error.empty()) return;
  try {
    if (!prepared_) prepare(pair);
    const double needed = needed_white_level(pair);  // of all pixels: rectification crops
    if (rectifier_) {
      io::RectifiedPair rectified = rectifier_->rectify(pair.left, pair.right);
      pair.left = std::move(rectified.left);
      pair.right = std::move(rectified.right);
    } else if (calibration_) {
      calibration_->validate(pair.left.width, pair.left.height, file_name_);
    }
    if (needed == 0) return;
    white_level_ = std::max(white_level_, needed);
    pair.white_level = white_level_;
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    pair.error = error.what();
  }
}

std::optional<io::SourcePair> RectifiedSource::next() {
  std::optional<io::SourcePair> pair = source_->next();
  if (pair) rectify(*pair);
  return pair;
}

}  // namespace roadstereo::cli
