#include <algorithm>
#include <initializer_list>
#include <opencv2/core.hpp>

#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Top-level nodes of one file, or of two files that complete each other.
class Storage {
 public:
  Storage(const CalibrationText& file, const CalibrationText* second) : path_(file.path) {
    open(file, files_[0]);
    if (second != nullptr) open(*second, files_[1]);
  }

  const std::string& path() const { return path_; }

  /// Returns the first existing node of `keys` and its name, or an empty node.
  cv::FileNode find(std::initializer_list<const char*> keys, std::string& name) const {
    for (const cv::FileStorage& file : files_) {
      if (!file.isOpened()) continue;
      for (const char* key : keys) {
        const cv::FileNode node = file[key];
        if (node.empty()) continue;
        name = key;
        return node;
      }
    }
    return {};
  }

 private:
  static void open(const CalibrationText& file, cv::FileStorage& storage) {
    std::string text = file.text;
    const bool has_header = text.starts_with("%YAML") || text.find('<') == 0;
    if (!has_header) text.insert(0, "%YAML:1.0\n---\n");
    bool opened = false;
    try {
      opened = storage.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    } catch (const cv::Exception& error) {
      fail(file.path, ": invalid OpenCV calibration: ", error.err);
    }
    if (!opened) fail(file.path, ": invalid OpenCV calibration");
  }

  std::string path_;
  std::array<cv::FileStorage, 2> files_;
};

/// Limits the size of a matrix in a damaged file.
void check_claimed_size(const Storage& storage, const std::string& key, const cv::FileNode& node) {
  constexpr int max_side = 14;  // number of coefficients of the largest lens model
  for (const char* side : {"rows", "cols"}) {
    const cv::FileNode claimed = node[side];
    if (claimed.isInt() && static_cast<int>(claimed) >= 0 && static_cast<int>(claimed) <= max_side) continue;
    fail(storage.path(), ": ", key, " must be a matrix with at most ", max_side, " rows and columns");
  }
}

std::vector<double> values_of(const Storage& storage, const std::string& key, const cv::FileNode& node) {
  cv::Mat matrix;
  if (node.isMap()) {
    check_claimed_size(storage, key, node);
    try {
      matrix = node.mat();
    } catch (const cv::Exception&) {
      fail(storage.path(), ": ", key, " is not a matrix of numbers");
    }
    cv::Mat values;
    matrix.reshape(1, 1).convertTo(values, CV_64F);
    return {values.begin<double>(), values.end<double>()};
  }
  std::vector<double> values;
  if (!node.isSeq()) fail(storage.path(), ": ", key, " must be a matrix or a list of numbers");
  for (const cv::FileNode& item : node) {
    if (!item.isInt() && !item.isReal()) fail(storage.path(), ": ", key, " must be a list of numbers");
    values.push_back(static_cast<double>(item));
  }
  return values;
}

template <std::size_t Count>
std::array<double, Count> read_matrix(const Storage& storage, std::initializer_list<const char*> keys) {
  std::string key;
  const cv::FileNode node = storage.find(keys, key);
  if (node.empty()) {
    std::string other;
    if (keys.size() > 1) other.append(" (or ").append(*(keys.begin() + 1)).append(")");
    fail(storage.path(), ": ", *keys.begin(), other, " is missing");
  }
  const std::vector<double> values = values_of(storage, key, node);
  if (values.size() != Count) {
    fail(storage.path(), ": ", key, " has ", values.size(), " values; it must have ", Count);
  }
  std::array<double, Count> matrix{};
  std::copy(values.begin(), values.end(), matrix.begin());
  return matrix;
}

std::vector<double> read_distortion(const Storage& storage, const char* key) {
  std::string name;
  const cv::FileNode node = storage.find({key}, name);
  return node.empty() ? std::vector<double>{} : values_of(storage, key, node);
}

int read_side(const Storage& storage, std::initializer_list<const char*> keys, std::size_t index) {
  std::string key;
  const cv::FileNode node = storage.find(keys, key);
  if (node.empty()) return 0;
  const cv::FileNode item = node.isSeq() && node.size() == 2 ? node[static_cast<int>(index)] : node;
  if (!item.isInt() && !item.isReal()) fail(storage.path(), ": ", key, " must be a number of pixels");
  return parse_side(storage.path(), key, std::to_string(static_cast<double>(item)));
}

bool read_fisheye(const Storage& storage) {
  std::string key;
  const cv::FileNode node = storage.find({"fisheye", "distortion_model", "camera_model"}, key);
  if (node.isInt()) return static_cast<int>(node) != 0;
  if (!node.isString()) return false;
  const auto model = static_cast<std::string>(node);
  return model == "fisheye" || model == "equidistant" || model == "true";
}

StereoRig read_rig(const CalibrationText& file, const CalibrationText* second) {
  const Storage storage(file, second);
  StereoRig rig;
  rig.left_matrix = read_matrix<9>(storage, {"K1", "M1"});
  rig.right_matrix = read_matrix<9>(storage, {"K2", "M2"});
  rig.left_distortion = read_distortion(storage, "D1");
  rig.right_distortion = read_distortion(storage, "D2");
  rig.rotation = read_matrix<9>(storage, {"R"});
  rig.translation_m = read_matrix<3>(storage, {"T"});
  rig.fisheye = read_fisheye(storage);
  rig.width = read_side(storage, {"image_width", "width", "imageSize", "image_size"}, 0);
  rig.height = read_side(storage, {"image_height", "height", "imageSize", "image_size"}, 1);
  return rig;
}

}  // namespace

CalibrationFile read_opencv_stereo(const CalibrationText& file, const CalibrationText* second) {
  try {
    return describe_rig(read_rig(file, second), "OpenCV stereo", file.path);
  } catch (const cv::Exception&) {  // parsed, but of another structure
    fail(file.path, ": invalid OpenCV calibration");
  }
}

}  // namespace roadstereo::io
