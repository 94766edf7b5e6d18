#include "output_owner.hpp"

#include <system_error>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

const char* text_of(OutputOwner owner) {
  if (owner == OutputOwner::pair) return "a pair";
  return owner == OutputOwner::recording ? "a recording" : "a map";
}

}  // namespace

OutputOwner owner_of(const std::filesystem::path& folder) {
  std::error_code absent;
  const auto has = [&](const char* name) { return std::filesystem::exists(folder / name, absent); };
  if (has("flight/journal.jsonl")) return OutputOwner::recording;
  if (has("result.json")) return OutputOwner::pair;
  return has("map.json") || has(".tiles/checkpoint.json") ? OutputOwner::map : OutputOwner::none;
}

void require_no_other_owner(const std::filesystem::path& folder, OutputOwner own) {
  const OutputOwner owner = owner_of(folder);
  if (owner == OutputOwner::none || owner == own) return;
  fail(folder.string(), ": this folder has the results of ", text_of(owner), "; choose another output folder");
}

}  // namespace roadstereo::cli
