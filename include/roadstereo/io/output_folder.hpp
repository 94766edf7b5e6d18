#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace roadstereo::io {

/// A folder whose files appear together or not at all: everything is written to a hidden folder inside it (so
/// on the same file system) and moved by `commit`. What is not committed is removed, with the folders made
/// for it.
class OutputFolder {
 public:
  /// Makes the folder when it is missing. Throws Error naming it when it cannot be made or written to.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Stages one file; `name` may have folders in it. Throws SystemError naming the file when the disk is full
  /// or the write fails.
  void add(const std::string& name, std::span<const std::uint8_t> bytes);
  void add(const std::string& name, const std::string& text);

  /// Moves every staged file to its place. Throws SystemError.
  void commit();

  const std::filesystem::path& path() const { return folder_; }

 private:
  void remove_unfinished() noexcept;

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::vector<std::string> names_;
  std::vector<std::filesystem::path> made_folders_;  // innermost first; empty after a commit
};

}  // namespace roadstereo::io
