#include "roadstereo/io/trajectory_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/shortest_text.hpp"
#include "io/quaternion.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::io {
namespace {

/// Parses a word as a number, whatever the locale; nullopt if it is none.
std::optional<double> number_of(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Whether every frame of a piece has a time.
bool has_times(const Trajectory& trajectory, int piece, const std::vector<double>& times_s) {
  for (std::size_t i = 0; i < trajectory.frames.size(); ++i) {
    if (trajectory.frames[i].piece != piece) continue;
    if (i >= times_s.size() || !std::isfinite(times_s[i])) return false;
  }
  return true;
}

}  // namespace

Trajectory read_trajectory(const std::string& path) {
  constexpr double max_rotation_error = 1e-3;
  std::ifstream file(path);
  if (!file) fail(path, ": this trajectory cannot be read");
  Trajectory trajectory;
  std::string line;
  for (int row = 0; std::getline(file, line); ++row) {
    std::istringstream words(line);
    std::vector<double> numbers;
    bool missing = false;
    for (std::string word; words >> word;) {
      const std::optional<double> value = number_of(word);
      if (!value) fail(path, ", line ", row + 1, ": \"", word, "\" is no number");
      missing = missing || !std::isfinite(*value);
      numbers.push_back(*value);
    }
    if (numbers.empty() && (file >> std::ws).eof()) break;
    if (numbers.size() != 12) {
      fail(path, ", line ", row + 1, " has ", numbers.size(),
           " numbers; a pose has 12, the 3×4 matrix from the camera to the world");
    }
    if (missing) continue;
    FramePose pose;
    pose.frame = row;
    std::copy(numbers.begin(), numbers.end(), pose.camera_to_world.begin());
    if (rotation_error(pose.camera_to_world) > max_rotation_error) {
      fail(path, ", line ", row + 1, ": the first three columns are no rotation");
    }
    if (determinant(pose.camera_to_world) < 0) {
      fail(path, ", line ", row + 1, ": the first three columns are a reflection, not a rotation: the axes of the ",
           "camera or of the world are left-handed");
    }
    trajectory.frames.push_back(pose);
  }
  if (file.bad()) fail<SystemError>(path, " cannot be read");
  if (trajectory.frames.empty()) fail(path, ": there is no pose in this file");
  return trajectory;
}

std::string kitti_trajectory(const Trajectory& trajectory, int piece) {
  std::string text;
  int line = 0;
  const auto add = [&](const std::array<double, 12>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? " " : "") + shortest_text(values[i]);
    text += '\n';
    ++line;
  };
  std::array<double, 12> unknown{};
  unknown.fill(std::numeric_limits<double>::quiet_NaN());
  for (const FramePose& pose : trajectory.frames) {
    while (line < pose.frame) add(unknown);
    add(pose.piece == piece ? pose.camera_to_world : unknown);
  }
  return text;
}

std::string tum_trajectory(const Trajectory& trajectory, int piece, const std::vector<double>& times_s) {
  std::string text = "# time x y z qx qy qz qw: seconds, metres, camera to world\n";
  const bool timed = has_times(trajectory, piece, times_s);
  for (std::size_t i = 0; i < trajectory.frames.size(); ++i) {
    const FramePose& pose = trajectory.frames[i];
    if (pose.piece != piece) continue;
    const std::array<double, 12>& m = pose.camera_to_world;
    text += shortest_text(timed ? times_s[i] : pose.frame);
    for (const double value : {m[3], m[7], m[11]}) text += ' ' + shortest_text(value);
    for (const double value : quaternion(m)) text += ' ' + shortest_text(value);
    text += '\n';
  }
  return text;
}

int longest_piece(const Trajectory& trajectory) {
  std::map<int, int> frames;
  for (const FramePose& pose : trajectory.frames) ++frames[pose.piece];
  const auto longest =
      std::max_element(frames.begin(), frames.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return longest == frames.end() ? 0 : longest->first;
}

}  // namespace roadstereo::io
