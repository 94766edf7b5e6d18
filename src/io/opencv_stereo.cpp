#include <algorithm>
#include <initializer_list>

#include "io/calibration_formats.hpp"
#include "io/opencv_file.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Top-level entries of one file, or of two files that complete each other.
class Storage {
 public:
  Storage(const CalibrationText& file, const CalibrationText* second) : path_(file.path) {
    entries_ = parse_opencv_file(file);
    if (second != nullptr) entries_.merge(parse_opencv_file(*second));
  }

  const std::string& path() const { return path_; }

  /// Returns the first existing entry of `keys` and its name, or null.
  const OpenCvEntry* find(std::initializer_list<const char*> keys, std::string& name) const {
    for (const char* key : keys) {
      const auto found = entries_.find(key);
      if (found == entries_.end()) continue;
      name = key;
      return &found->second;
    }
    return nullptr;
  }

 private:
  std::string path_;
  OpenCvEntries entries_;
};

std::size_t matrix_side(const Storage& storage, const std::string& key, const std::string& text) {
  constexpr double max_side = 14;  // number of coefficients of the largest lens model
  const double side = text.empty() ? -1 : parse_number(storage.path(), key, text);
  if (side >= 0 && side <= max_side) return static_cast<std::size_t>(side);
  fail(storage.path(), ": ", key, " must be a matrix with at most ", max_side, " rows and columns");
}

std::vector<double> values_of(const Storage& storage, const std::string& key, const OpenCvEntry& entry) {
  const bool is_matrix = entry.kind == OpenCvEntry::Kind::matrix;
  if (!is_matrix && entry.kind != OpenCvEntry::Kind::list) {
    fail(storage.path(), ": ", key, " must be a matrix or a list of numbers");
  }
  if (is_matrix) {
    const std::size_t claimed = matrix_side(storage, key, entry.rows) * matrix_side(storage, key, entry.cols);
    if (claimed != entry.words.size()) {
      fail(storage.path(), ": ", key, " has ", entry.words.size(), " values; it must have rows times columns, ",
           claimed);
    }
  }
  std::vector<double> values;
  for (const std::string& word : entry.words) values.push_back(parse_number(storage.path(), key, word));
  return values;
}

template <std::size_t Count>
std::array<double, Count> read_matrix(const Storage& storage, std::initializer_list<const char*> keys) {
  std::string key;
  const OpenCvEntry* entry = storage.find(keys, key);
  if (entry == nullptr) {
    std::string other;
    if (keys.size() > 1) other.append(" (or ").append(*(keys.begin() + 1)).append(")");
    fail(storage.path(), ": ", *keys.begin(), other, " is missing");
  }
  const std::vector<double> values = values_of(storage, key, *entry);
  if (values.size() != Count) {
    fail(storage.path(), ": ", key, " has ", values.size(), " values; it must have ", Count);
  }
  std::array<double, Count> matrix{};
  std::copy(values.begin(), values.end(), matrix.begin());
  return matrix;
}

std::vector<double> read_distortion(const Storage& storage, const char* key) {
  std::string name;
  const OpenCvEntry* entry = storage.find({key}, name);
  return entry == nullptr ? std::vector<double>{} : values_of(storage, key, *entry);
}

int read_side(const Storage& storage, std::initializer_list<const char*> keys, std::size_t index) {
  std::string key;
  const OpenCvEntry* entry = storage.find(keys, key);
  if (entry == nullptr) return 0;
  if (entry->words.size() != 1 && entry->words.size() != 2) {
    fail(storage.path(), ": ", key, " must be a number of pixels");
  }
  return parse_side(storage.path(), key, entry->words[std::min(index, entry->words.size() - 1)]);
}

bool read_fisheye(const Storage& storage) {
  std::string key;
  const OpenCvEntry* entry = storage.find({"fisheye", "distortion_model", "camera_model"}, key);
  if (entry == nullptr || entry->kind != OpenCvEntry::Kind::text) return false;
  constexpr std::array<std::string_view, 6> names = {"1",           "true",        "fisheye",
                                                     "equidistant", "\"fisheye\"", "\"equidistant\""};
  return std::find(names.begin(), names.end(), entry->words[0]) != names.end();
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
  return describe_rig(read_rig(file, second), "OpenCV stereo", file.path);
}

}  // namespace roadstereo::io
