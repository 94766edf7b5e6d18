#pragma once

#include <filesystem>

namespace roadstereo::cli {

/// Keeps other processes from writing to an output folder: a lock on a file in it, which the destructor removes. Where
/// the file system knows no locks nobody is kept out.
class FolderLock {
 public:
  /// Throws Error naming `folder` if another process has the lock or the file cannot be made.
  FolderLock(const std::filesystem::path& folder, const std::filesystem::path& file);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace roadstereo::cli
