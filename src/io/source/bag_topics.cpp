#include "io/source/bag_topics.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::string_view compressed_ending = "/compressed";

struct SideNames {
  std::string_view left;
  std::string_view right;
};
constexpr std::array side_names = {SideNames{"left", "right"},        SideNames{"cam0", "cam1"},
                                   SideNames{"cam_0", "cam_1"},       SideNames{"camera0", "camera1"},
                                   SideNames{"camera_0", "camera_1"}, SideNames{"image_00", "image_01"},
                                   SideNames{"image_02", "image_03"}, SideNames{"image_0", "image_1"},
                                   SideNames{"image_2", "image_3"},   SideNames{"infra1", "infra2"}};

/// Removes the suffix of image_transport.
std::string camera_topic(const std::string& name) {
  return name.ends_with(compressed_ending) ? name.substr(0, name.size() - compressed_ending.size()) : name;
}

/// Returns the name of the right camera if this is the left one, else "".
std::string right_partner(const std::string& left) {
  for (const SideNames& names : side_names) {
    std::string right = left;
    for (std::size_t at = right.find(names.left); at != std::string::npos; at = right.find(names.left, at)) {
      right.replace(at, names.left.size(), names.right);
      at += names.right.size();
    }
    if (right != left) return right;
  }
  return "";
}

const BagTopic* find_topic(const std::vector<BagTopic>& topics, const std::string& name) {
  const auto found = std::find_if(topics.begin(), topics.end(), [&](const BagTopic& t) { return t.name == name; });
  return found == topics.end() ? nullptr : &*found;
}

[[noreturn]] void fail_topics(const std::string& source, const std::string& reason,
                              const std::vector<BagTopic>& images) {
  std::string list;
  for (const BagTopic& topic : images) list += (list.empty() ? "" : ", ") + topic.name;
  fail(source, ": ", reason,
       "; select two of its image topics with --topics LEFT,RIGHT: ", list.empty() ? "none" : list);
}

/// Keeps one topic per camera, preferring raw images.
std::vector<BagTopic> one_per_camera(const std::vector<BagTopic>& images) {
  std::vector<BagTopic> cameras;
  std::copy_if(images.begin(), images.end(), std::back_inserter(cameras), [&](const BagTopic& topic) {
    const std::string raw = camera_topic(topic.name);
    return raw == topic.name || find_topic(images, raw) == nullptr;
  });
  return cameras;
}

}  // namespace

std::string ros1_type(std::string type) {
  constexpr std::string_view ros2_part = "/msg/";
  const std::size_t at = type.find(ros2_part);
  return at == std::string::npos ? type : type.replace(at, ros2_part.size(), "/");
}

bool is_image_topic(const BagTopic& topic) {
  if (topic.name.ends_with("/compressedDepth")) return false;
  return topic.type == "sensor_msgs/Image" || topic.type == "sensor_msgs/CompressedImage";
}

std::pair<BagTopic, BagTopic> find_image_topics(const std::string& source, const std::vector<BagTopic>& topics,
                                                const std::vector<std::string>& wanted) {
  std::vector<BagTopic> images;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(images), is_image_topic);
  if (wanted.size() == 2) {
    const BagTopic* left = find_topic(images, wanted[0]);
    const BagTopic* right = find_topic(images, wanted[1]);
    if (left == nullptr) fail_topics(source, wanted[0] + " is not an image topic of the bag", images);
    if (right == nullptr) fail_topics(source, wanted[1] + " is not an image topic of the bag", images);
    return {*left, *right};
  }
  const std::vector<BagTopic> cameras = one_per_camera(images);
  std::vector<std::pair<BagTopic, BagTopic>> pairs;
  for (const BagTopic& camera : cameras) {
    const std::string partner = right_partner(camera.name);
    const BagTopic* right = find_topic(cameras, partner);
    if (right != nullptr) pairs.emplace_back(camera, *right);
  }
  if (pairs.empty()) fail_topics(source, "no left and right camera can be recognised by the topic names", images);
  if (pairs.size() > 1) fail_topics(source, "the bag has more than one pair of cameras", images);
  return pairs.front();
}

std::string camera_info_topic(const std::string& image_topic) {
  const std::string camera = camera_topic(image_topic);
  const std::size_t slash = camera.rfind('/');
  return slash == std::string::npos ? "camera_info" : camera.substr(0, slash + 1) + "camera_info";
}

}  // namespace roadstereo::io
