#include "io/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::size_t size_of_ordinary_file(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) fail("the file name is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) fail(path, ": the file does not exist");
  if (error) fail(path, ": the file cannot be read: ", error.message());
  if (fs::is_directory(status)) fail(path, ": this is a folder, not a file");
  if (!fs::is_regular_file(status)) fail(path, ": this is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(path, ": the file cannot be read: ", error.message());
  return static_cast<std::size_t>(size);
}

}  // namespace

std::vector<std::uint8_t> read_file(const std::string& path, std::size_t max_bytes) {
  const std::size_t size = size_of_ordinary_file(path);
  if (size > max_bytes) {
    fail(path, ": the file has ", size, " bytes; the limit is ", max_bytes);
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, ": the file cannot be read: ", std::generic_category().message(errno));
  std::vector<std::uint8_t> bytes(size);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (bytes.empty()) fail(path, ": the file is empty");
  return bytes;
}

std::string read_text(const std::string& path, std::size_t max_bytes, const char* is_not) {
  const std::vector<std::uint8_t> bytes = read_file(path, max_bytes);
  if (std::find(bytes.begin(), bytes.end(), std::uint8_t{0}) != bytes.end()) fail(path, ": this is ", is_not);
  std::string text(bytes.begin(), bytes.end());
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // byte order mark
  return text;
}

}  // namespace roadstereo::io
