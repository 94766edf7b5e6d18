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
  const OpenCvEntry* find(const std::vector<const char*>& keys, std::string& name) const {
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

/// A figure and its names in the files of calibration programs, the usual one first.
struct KeyNames {
  std::vector<const char*> keys;
};
const KeyNames k1_names{{"K1", "M1", "cameraMatrix1", "left_camera_matrix"}};
const KeyNames k2_names{{"K2", "M2", "cameraMatrix2", "right_camera_matrix"}};
const KeyNames d1_names{{"D1", "distCoeffs1", "left_distortion"}}, d2_names{{"D2", "distCoeffs2", "right_distortion"}};
const KeyNames rotation_names{{"R", "rotation"}}, translation_names{{"T", "translation"}};

bool has_key(const Storage& storage, const KeyNames& name) {
  std::string key;
  return storage.find(name.keys, key) != nullptr;
}

template <std::size_t Count>
std::array<double, Count> read_matrix(const Storage& storage, const KeyNames& name) {
  std::string key;
  const OpenCvEntry* entry = storage.find(name.keys, key);
  const std::vector<double> values = values_of(storage, key, *entry);
  if (values.size() != Count) {
    fail(storage.path(), ": ", key, " has ", values.size(), " values; it must have ", Count);
  }
  std::array<double, Count> matrix{};
  std::copy(values.begin(), values.end(), matrix.begin());
  return matrix;
}

std::vector<double> read_distortion(const Storage& storage, const KeyNames& name) {
  std::string key;
  const OpenCvEntry* entry = storage.find(name.keys, key);
  return entry == nullptr ? std::vector<double>{} : values_of(storage, key, *entry);
}

/// "R and T", or "K1, D1 and K2".
std::string missing_text(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

/// Throws Error naming all that is missing. A rectified pair has no distortion; one of a lens must not get lost because
/// it has another name.
void require_opencv_keys(const Storage& storage) {
  std::vector<std::string> missing;
  const bool left = has_key(storage, d1_names), right = has_key(storage, d2_names);
  const std::string other = left || right ? "" : storage.first_key_with("dist");
  const bool matrices = has_key(storage, k1_names) && has_key(storage, k2_names),
             poses = has_key(storage, rotation_names) && has_key(storage, translation_names);
  const bool needs_distortion = left != right || !other.empty() || !matrices;
  const auto require = [&](const KeyNames& name) {
    if (!has_key(storage, name)) missing.emplace_back(name.keys.front());
  };
  require(k1_names);
  if (needs_distortion) require(d1_names);
  require(k2_names);
  if (needs_distortion) require(d2_names);
  require(rotation_names);
  require(translation_names);
  if (missing.empty()) return;
  std::string hint;
  if (!other.empty()) hint += "; there is a key " + other;
  if (matrices != poses) {
    hint += matrices ? "; extrinsics in another file are a second --calibration"
                     : "; intrinsics in another file are a first --calibration";
  }
  if (!matrices) hint += "; other names are M1 or cameraMatrix1, and distCoeffs1";
  if (matrices && left != right) hint += "; a lens without distortion has 0 0 0 0 0";
  fail(storage.path(), ": ", missing_text(missing), missing.size() > 1 ? " are missing" : " is missing", hint);
}

/// Whether the file has nothing but the projection matrices of a rectified pair.
bool has_projections_only(const Storage& storage) {
  const auto any = [&](std::initializer_list<const KeyNames*> names) {
    return std::any_of(names.begin(), names.end(), [&](const KeyNames* name) { return has_key(storage, *name); });
  };
  return has_key(storage, {{"P1"}}) && has_key(storage, {{"P2"}}) &&
         !any({&k1_names, &k2_names, &d1_names, &d2_names, &rotation_names, &translation_names});
}

int read_side(const Storage& storage, const std::vector<const char*>& keys, std::size_t index) {
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

int read_width(const Storage& storage) {
  return read_side(storage, {"image_width", "width", "imageSize", "image_size"}, 0);
}

int read_height(const Storage& storage) {
  return read_side(storage, {"image_height", "height", "imageSize", "image_size"}, 1);
}

StereoRig read_rig(const Storage& storage) {
  require_opencv_keys(storage);
  StereoRig rig;
  rig.left_matrix = read_matrix<9>(storage, k1_names);
  rig.right_matrix = read_matrix<9>(storage, k2_names);
  rig.left_distortion = read_distortion(storage, d1_names);
  rig.right_distortion = read_distortion(storage, d2_names);
  rig.rotation = read_matrix<9>(storage, rotation_names);
  rig.translation_m = read_matrix<3>(storage, translation_names);
  rig.fisheye = read_fisheye(storage);
  rig.width = read_width(storage);
  rig.height = read_height(storage);
  return rig;
}

/// P1 and P2 of `stereoRectify`: P2[3] is −focal length × baseline.
CalibrationFile read_projections(const Storage& storage) {
  const std::array<double, 12> left = read_matrix<12>(storage, {{"P1"}}), right = read_matrix<12>(storage, {{"P2"}});
  StereoCalibration calibration;
  calibration.focal_px = left[0];
  calibration.cx_px = left[2];
  calibration.cy_px = left[6];
  calibration.disparity_offset_px = right[2] - left[2];
  calibration.baseline_m = left[0] != 0 ? (left[3] - right[3]) / left[0] : 0;
  calibration.width = read_width(storage);
  calibration.height = read_height(storage);
  check_rectified(calibration, storage.path(), {"P1[0]", "P1[2]", "P1[6]", "P1[3] and P2[3]"});
  check_one_projection(storage.path(), {"P1", left[0], left[6]}, {"P2", right[0], right[6]});
  check_square_pixels(left[0], left[5], storage.path(), "P1");
  return {"OpenCV P1/P2", calibration, std::nullopt};
}

}  // namespace

CalibrationFile read_opencv_stereo(const CalibrationText& file, const CalibrationText* second) {
  const Storage storage(file, second);
  if (has_projections_only(storage)) return read_projections(storage);
  return describe_rig(read_rig(storage), "OpenCV stereo", storage.path());
}

}  // namespace roadstereo::io
