#pragma once

#include <filesystem>
#include <vector>

#include "roadstereo/error.hpp"

namespace roadstereo {

/// The files of a folder that belongs to an `owner`, such as a map, and holds nothing but its `files`. Throws Error
/// naming the first other file: it is somebody's.
template <class IsOwn>
std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder, const char* owner, const char* files,
                                             const IsOwn& is_own) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!is_own(entry.path())) {
      fail("folder ", folder.string(), " holds ", entry.path().filename().string(), "; the folder of a ", owner,
           " must be new, or hold nothing but its ", files);
    }
    found.push_back(entry.path());
  }
  return found;
}

}  // namespace roadstereo
