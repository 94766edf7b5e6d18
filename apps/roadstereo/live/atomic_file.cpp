#include "live/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace fs = std::filesystem;
namespace {

/// Writes a file. Returns the error number of the system, 0 on success.
int write_bytes(const fs::path& path, std::span<const std::uint8_t> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  const bool closed = std::fclose(file) == 0;  // flushes the buffer
  if (!written) return write_error;
  return closed ? 0 : errno;
}

}  // namespace

void write_file_atomically(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const fs::path beside = path.parent_path() / ("." + path.filename().string() + ".part");
  int error = write_bytes(beside, bytes);
  if (error == 0 && std::rename(beside.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return;
  std::error_code ignored;
  fs::remove(beside, ignored);
  fail<SystemError>("cannot write ", path.string(), ": ", std::generic_category().message(error));
}

}  // namespace roadstereo::cli
