#pragma once

#include <filesystem>

namespace roadstereo::cli {

/// Whose results a folder has. Commands have files of the same names, such as damages.csv.
enum class OutputOwner { none, pair, recording, map };

/// Returns whose results the folder has, finished or not; `none` if it does not exist, too.
OutputOwner owner_of(const std::filesystem::path& folder);

/// Throws Error naming the folder if it has the results of another than `own`.
void require_no_other_owner(const std::filesystem::path& folder, OutputOwner own);

}  // namespace roadstereo::cli
