#include "folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

bool knows_no_locks(int error) {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP;
}

/// Whether the process that had the lock has removed the file since it was opened.
bool is_removed(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) != 0 || status.st_nlink == 0;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::filesystem::path& file) : file_(file) {
  constexpr mode_t readable = 0644;
  while (true) {
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, readable);
    if (descriptor_ < 0) {
      fail("cannot write to folder ", folder.string(), ": ", std::generic_category().message(errno));
    }
    const int error = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    if (knows_no_locks(error) || (error == 0 && !is_removed(descriptor_))) return;
    ::close(descriptor_);
    if (error == EWOULDBLOCK) fail(folder.string(), ": another process is writing to this folder");
    if (error != 0) fail<SystemError>("cannot lock ", file.string(), ": ", std::generic_category().message(error));
  }
}

FolderLock::~FolderLock() {
  ::unlink(file_.c_str());  // while it is locked: who opens it now sees that it is removed
  ::close(descriptor_);
}

}  // namespace roadstereo::cli
