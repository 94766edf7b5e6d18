#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Writes a set of files atomically: files are staged in a hidden folder inside the output folder and moved by
/// `commit`. Uncommitted files, and the folders created for them, are removed on destruction; those of a killed process
/// by the next OutputFolder of the same path.
class OutputFolder {
 public:
  /// Creates the folder if it is missing. Throws Error naming it if it cannot be created or written to.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Names an input file that must not be overwritten.
  void protect(const std::filesystem::path& input);

  /// Stages one file; `name` may contain folders. Throws Error if it would overwrite a protected file, SystemError
  /// naming the file if the write fails.
  void add(const std::string& name, std::span<const std::uint8_t> bytes);
  void add(const std::string& name, const std::string& text);

  /// Stages a file that is too large for memory, by moving it here from the same file system. Throws as `add` does.
  void add_file(const std::string& name, const std::filesystem::path& from);

  /// Returns whether a file of that name is staged.
  bool has(const std::string& name) const;

  /// Names a file that is not part of this result. `commit` removes such a file of an earlier result, unless it is
  /// protected.
  void remove(const std::string& name);

  /// Moves all staged files into the output folder. Throws SystemError; the folder is then unchanged.
  void commit();

  const std::filesystem::path& path() const { return folder_; }

 private:
  bool is_protected(const std::string& name) const;
  std::filesystem::path staged_path(const std::string& name);
  void stage();
  void unstage() noexcept;
  void remove_unfinished() noexcept;

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> protected_;
  std::filesystem::path staging_;  // empty without staged files
  int lock_ = -1;                  // of the staging folder, as long as this process lives
  std::vector<std::string> names_, removed_;
  std::vector<std::filesystem::path> made_folders_;  // innermost first; empty after a commit
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
