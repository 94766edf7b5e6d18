#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

#include "io/calibration_formats.hpp"
#include "io/opencv_file.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Top-level entries of one file, or of two files that complete each other.
class Storage {
 public:
  Storage(const CalibrationText& file, const CalibrationText* second)
      : path_(second == nullptr ? file.path : file.path + " and " + second->path), entries_(parse_opencv_file(file)) {
    if (second != nullptr) entries_.merge(parse_opencv_file(*second));
  }

  const std::string& path() const { return path_; }

  /// Returns the first key that begins with `start`, in whatever case, but for "distortion_model"; empty: none.
  std::string first_key_with(std::string_view start) const {
    for (const auto& entry : entries_) {
      const std::string& key = entry.first;
      const bool begins = key.size() >= start.size() &&
                          std::equal(start.begin(), start.end(), key.begin(), [](char expected, char letter) {
                            return expected == std::tolower(static_cast<unsigned char>(letter));
                          });
      if (begins && key != "distortion_model") return key;
    }
    return {};
  }

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

/// A rectified pair has no distortion. One of a lens must not get lost because it has another name.
void require_distortion(const Storage& storage) {
  std::string name;
  const bool left = storage.find({"D1"}, name) != nullptr, right = storage.find({"D2"}, name) != nullptr;
  const std::string other = storage.first_key_with("dist");
  if (left == right && (left || other.empty())) return;
  fail(storage.path(), ": ", left ? "D2" : "D1", " is missing", other.empty() ? "" : "; there is a key " + other,
       "; a lens without distortion has 0 0 0 0 0");
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
  std::string name;
  for (const char letter : entry->words[0]) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) continue;  // quotes, "plumb_bob"
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  const auto is_one_of = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (is_one_of({"1", "true", "fisheye", "equidistant", "equi", "kannalabrandt", "kannalabrandt4", "kannalabrandt8"})) {
    return true;
  }
  if (is_one_of({"0", "false", "pinhole", "plumbbob", "radtan", "radialtangential", "brown", "brownconrady", "opencv",
                 "rationalpolynomial", "perspective", "standard", ""})) {
    return false;
  }
  fail(storage.path(), ": ", key, " is ", entry->words[0], "; it must be radtan or equidistant (fisheye)");
}

StereoRig read_rig(const Storage& storage) {
  StereoRig rig;
  rig.left_matrix = read_matrix<9>(storage, {"K1", "M1"});
  rig.right_matrix = read_matrix<9>(storage, {"K2", "M2"});
  require_distortion(storage);
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
  const Storage storage(file, second);
  return describe_rig(read_rig(storage), "OpenCV stereo", storage.path());
}

}  // namespace roadstereo::io
