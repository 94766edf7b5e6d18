#include "io/source/message_log.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "io/source/mcap_records.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view ros1_magic = "#ROSBAG V2.0";
constexpr std::string_view sqlite_magic{"SQLite format 3\0", 16};

bool is_rosbag2_folder(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return false;
  std::ifstream file(fs::path(path) / "metadata.yaml", std::ios::binary);
  std::array<char, 200> start{};
  file.read(start.data(), start.size());
  const std::string_view text(start.data(), static_cast<std::size_t>(file.gcount()));
  return text.find("rosbag2_bagfile_information") != std::string_view::npos;
}

std::string first_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 16> start{};
  file.read(start.data(), start.size());
  return {start.data(), static_cast<std::size_t>(file.gcount())};
}

}  // namespace

bool is_message_log(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return is_rosbag2_folder(path);
  if (!fs::is_regular_file(path, ignored)) return false;
  const std::string start = first_bytes(path);
  return start.starts_with(ros1_magic) || start == sqlite_magic || start.starts_with(mcap_magic);
}

std::unique_ptr<MessageLog> open_message_log(const std::string& path) {
  if (is_rosbag2_folder(path)) return open_rosbag2_folder(path);
  if (!fs::is_regular_file(path)) fail(path, ": the file does not exist, or is not a regular file");
  const std::string start = first_bytes(path);
  if (start == sqlite_magic) return open_sqlite_log(path);
  if (start.starts_with(mcap_magic)) return open_mcap_log(path);
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".mcap" || extension == ".db3") fail(path, ": this is not a bag; its first bytes are other");
  return open_ros1_log(path);
}

}  // namespace roadstereo::io
