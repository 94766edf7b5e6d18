#include <algorithm>
#include <cctype>
#include <map>
#include <opencv2/core/affine.hpp>

#include "io/calibration_formats.hpp"
#include "io/plain_text.hpp"
#include "io/rig_camera.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

struct Resolution {
  const char* name;
  int width;
  int height;
};
constexpr std::array<Resolution, 6> resolutions{{{"2k", 2208, 1242},
                                                 {"fhd", 1920, 1080},
                                                 {"fhd1200", 1920, 1200},
                                                 {"hd", 1280, 720},
                                                 {"svga", 960, 600},
                                                 {"vga", 672, 376}}};

/// Values of an INI file by "section:key" in lower case.
class IniFile {
 public:
  explicit IniFile(const CalibrationText& file) : path_(file.path) {
    std::string section;
    std::string_view text = file.text;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      add_line(text.substr(0, end), section);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  bool has(const std::string& key) const { return values_.count(key) != 0; }
  double number(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) fail(path_, ": ", key, " is missing");
    return parse_number(path_, key, found->second);
  }
  double number_or(const std::string& key, double absent) const { return has(key) ? number(key) : absent; }

 private:
  void add_line(std::string_view line, std::string& section) {
    const std::size_t begin = line.find('['), end = line.find(']');
    if (begin != std::string_view::npos && end != std::string_view::npos && begin < end) {
      section = lower_case(line.substr(begin + 1, end - begin - 1));
      return;
    }
    for (const KeyLine& value : key_lines(line, '=')) {
      values_[section + ":" + lower_case(value.key)] = std::string(value.value);
    }
  }

  std::string path_;
  std::map<std::string, std::string> values_;
};

RigCamera read_camera(const IniFile& file, const std::string& section, const Resolution& resolution) {
  const auto number = [&](const char* key) { return file.number(section + ":" + key); };
  RigCamera camera;
  camera.matrix = camera_matrix(number("fx"), number("fy"), number("cx"), number("cy"));
  for (const char* key : {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}) {
    if (std::string_view(key) == "k4" && !file.has(section + ":k4")) break;
    camera.distortion.push_back(file.number_or(section + ":" + key, 0));
  }
  camera.width = resolution.width;
  camera.height = resolution.height;
  return camera;
}

/// The vector (RX, CV, RZ) rotates the axes of the left camera to those of the right one, in which the right camera is
/// at (Baseline, TY, TZ) from the left one, millimetres: what the manufacturer's open driver gives to
/// cv::stereoRectify.
cv::Matx44d left_to_right(const IniFile& file, const std::string& resolution) {
  constexpr double mm = 1e-3;
  const auto value = [&](const std::string& name) {
    const std::string key = "stereo:" + name, of_resolution = key + "_" + resolution;
    return file.number(file.has(of_resolution) || !file.has(key) ? of_resolution : key);
  };
  const auto or_zero = [&](const std::string& name) {
    const std::string key = "stereo:" + name;
    return file.number_or(key + "_" + resolution, file.number_or(key, 0));
  };
  const cv::Vec3d turn(value("rx"), value("cv"), value("rz"));
  const cv::Vec3d position(file.number("stereo:baseline"), or_zero("ty"), or_zero("tz"));
  return cv::Affine3d(turn, -mm * position).matrix;
}

}  // namespace

CalibrationFile read_zed_conf(const CalibrationText& text) {
  const IniFile file(text);
  CalibrationFile result{"ZED", std::nullopt, std::nullopt, {}};
  for (const Resolution& resolution : resolutions) {
    const std::string left = std::string("left_cam_") + resolution.name;
    if (!file.has(left + ":fx")) continue;
    const std::string right = std::string("right_cam_") + resolution.name;
    result.rigs.push_back(join_cameras(read_camera(file, left, resolution), read_camera(file, right, resolution),
                                       left_to_right(file, resolution.name), text.path));
    check_rig(result.rigs.back(), text.path);
  }
  if (result.rigs.empty()) fail(text.path, ": there is no camera of a known resolution, such as [LEFT_CAM_HD]");
  return result;
}

}  // namespace roadstereo::io
