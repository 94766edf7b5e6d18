#include "roadstereo/io/output_folder.hpp"

#include <fcntl.h>
#include <stdlib.h>  // mkdtemp is POSIX
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

bool is_full(int error) {
  return error == ENOSPC || error == EDQUOT || error == EIO;
}

[[noreturn]] void fail_folder(const fs::path& folder, const std::error_code& error) {
  if (is_full(error.value())) fail<SystemError>("cannot write to folder ", folder.string(), ": ", error.message());
  fail("cannot write to folder ", folder.string(), ": ", error.message());
}

[[noreturn]] void fail_write(const fs::path& file, int error) {
  fail<SystemError>("cannot write ", file.string(), ": ", std::generic_category().message(error));
}

/// The missing folders of the path `folder`, innermost first.
std::vector<fs::path> missing_folders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, ignored); at = at.parent_path()) missing.push_back(at);
  return missing;
}

void write_file(const fs::path& path, const fs::path& shown_as, std::span<const std::uint8_t> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) fail_write(shown_as, errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  const bool closed = std::fclose(file) == 0;  // flushes the buffer
  if (!written) fail_write(shown_as, write_error);
  if (!closed) fail_write(shown_as, errno);
}

void check_name(const std::string& name) {
  const fs::path path(name);
  const bool climbs = std::find(path.begin(), path.end(), fs::path("..")) != path.end();
  if (name.empty() || path.is_absolute() || climbs || !path.has_filename()) {
    fail("the output file name is \"", name, "\"; it must be relative and without \"..\"");
  }
}

constexpr const char* staging_prefix = ".roadstereo-";

/// Locks a staging folder. Returns the descriptor, or -1 if another process holds the lock.
int lock_staging(const fs::path& staging) {
  const int descriptor = ::open(staging.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

/// Removes the staging folders of processes that were killed: the locks of these are free.
void remove_stale(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!entry.path().filename().string().starts_with(staging_prefix)) continue;
    const int lock = lock_staging(entry.path());
    if (lock < 0) continue;
    fs::remove_all(entry.path(), ignored);
    ::close(lock);
  }
}

/// Moves files; the destructor takes that back unless they are to be kept.
class Moves {
 public:
  explicit Moves(fs::path replaced) : replaced_(std::move(replaced)) {}
  Moves(const Moves&) = delete;
  Moves& operator=(const Moves&) = delete;
  ~Moves() {
    std::error_code ignored;
    for (; !moves_.empty(); moves_.pop_back()) {
      const Move& done = moves_.back();
      fs::rename(done.aside.empty() ? done.to : done.aside, done.aside.empty() ? done.from : done.to, ignored);
    }
  }

  /// Moves `from` to `to`; an existing file is backed up. At every moment `to` is the old file or the new one.
  void move(const fs::path& from, const fs::path& to) {
    Move done{from, to, {}};
    if (fs::is_directory(to)) throw fs::filesystem_error("", to, std::make_error_code(std::errc::is_a_directory));
    if (fs::exists(fs::symlink_status(to))) {
      done.aside = replaced_ / std::to_string(moves_.size());
      fs::create_directories(replaced_);
      std::error_code no_links;
      fs::create_hard_link(to, done.aside, no_links);
      if (no_links) fs::copy(to, done.aside, fs::copy_options::copy_symlinks);
    }
    moves_.push_back(done);
    fs::rename(from, to);
  }

  void keep() { moves_.clear(); }

 private:
  struct Move {
    fs::path from;
    fs::path to;
    fs::path aside;
  };
  fs::path replaced_;
  std::vector<Move> moves_;
};

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder) : folder_(folder) {
  if (folder.empty()) fail("the name of the output folder is empty");
  made_folders_ = missing_folders(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0) error = std::error_code(errno, std::generic_category());
  if (error) {
    remove_unfinished();
    fail_folder(folder, error);
  }
  remove_stale(folder);
}

OutputFolder::~OutputFolder() {
  remove_unfinished();
}

void OutputFolder::stage() {
  while (true) {
    std::string staging = (folder_ / staging_prefix).string() + "XXXXXX";
    if (::mkdtemp(staging.data()) == nullptr) fail_folder(folder_, {errno, std::generic_category()});
    staging_ = staging;
    lock_ = lock_staging(staging_);
    if (fs::exists(staging_)) return;
    if (lock_ >= 0) ::close(std::exchange(lock_, -1));  // another process has taken it for a stale one
  }
}

void OutputFolder::unstage() noexcept {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  staging_.clear();
  if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

void OutputFolder::remove_unfinished() noexcept {
  unstage();
  std::error_code ignored;
  for (const fs::path& made : made_folders_) fs::remove(made, ignored);  // only when empty
}

void OutputFolder::protect(const fs::path& input) {
  protected_.push_back(input);
}

bool OutputFolder::is_protected(const std::string& name) const {
  std::error_code absent;
  return std::any_of(protected_.begin(), protected_.end(),
                     [&](const fs::path& input) { return fs::equivalent(folder_ / name, input, absent); });
}

/// Checks the name of a file to be staged and makes its folder.
fs::path OutputFolder::staged_path(const std::string& name) {
  check_name(name);
  if (is_protected(name)) {
    fail((folder_ / name).string(), ": this input would be overwritten; choose another output folder");
  }
  if (staging_.empty()) stage();
  fs::path staged = staging_ / "new" / name;
  std::error_code error;
  fs::create_directories(staged.parent_path(), error);
  if (error) fail_write(folder_ / name, error.value());
  return staged;
}

void OutputFolder::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  const fs::path staged = staged_path(name);
  try {
    write_file(staged, folder_ / name, bytes);
  } catch (const Error&) {
    std::error_code ignored;
    fs::remove(staged, ignored);
    throw;
  }
  if (!has(name)) names_.push_back(name);
}

void OutputFolder::add_file(const std::string& name, const fs::path& from) {
  const fs::path staged = staged_path(name);
  std::error_code error;
  fs::rename(from, staged, error);
  if (error) fail_write(folder_ / name, error.value());
  if (!has(name)) names_.push_back(name);
}

void OutputFolder::add(const std::string& name, const std::string& text) {
  add(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void OutputFolder::remove(const std::string& name) {
  check_name(name);
  if (!is_protected(name)) removed_.push_back(name);
}

bool OutputFolder::has(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

void OutputFolder::commit() {
  Moves moves(staging_ / "old");
  fs::path target = folder_;
  try {
    for (const std::string& name : names_) {
      target = folder_ / name;
      const std::vector<fs::path> missing = missing_folders(target.parent_path());
      made_folders_.insert(made_folders_.begin(), missing.begin(), missing.end());
      fs::create_directories(target.parent_path());
      moves.move(staging_ / "new" / name, target);
    }
  } catch (const fs::filesystem_error& error) {
    fail_write(target, error.code().value());
  }
  moves.keep();
  std::error_code ignored;
  for (const std::string& name : removed_) fs::remove(folder_ / name, ignored);
  unstage();
  names_.clear();
  removed_.clear();
  made_folders_.clear();
}

}  // namespace roadstereo::io
