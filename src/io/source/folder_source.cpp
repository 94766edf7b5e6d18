#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <unordered_set>

#include "io/plain_text.hpp"
#include "io/source/frame_times.hpp"
#include "io/source/pairing.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

struct SubFolders {
  const char* left;
  const char* right;
};

/// Colour is preferred to grey.
constexpr std::array layouts = {SubFolders{"left", "right"},
                                SubFolders{"image_2", "image_3"},
                                SubFolders{"image_02/data", "image_03/data"},
                                SubFolders{"image_0", "image_1"},
                                SubFolders{"image_00/data", "image_01/data"},
                                SubFolders{"cam0/data", "cam1/data"},
                                SubFolders{"mav0/cam0/data", "mav0/cam1/data"}};

/// Names of the sides in a folder with both views: prefix or suffix.
struct SideNames {
  const char* left;
  const char* right;
  bool at_end;
};
constexpr std::array side_names = {SideNames{"left", "right", false}, SideNames{"L", "R", false},
                                   SideNames{"left", "right", true}, SideNames{"_L", "_R", true}};

bool is_image(const fs::path& file) {
  constexpr std::array extensions = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".pgm", ".ppm"};
  const std::string extension = lower_case(file.extension().string());
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::vector<ViewFile> images_in(const fs::path& folder) {
  std::vector<ViewFile> views;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    if (!is_image(file) || file.filename().string()[0] == '.') continue;
    const std::string stem = file.stem().string();
    views.push_back({file.string(), stem, stem, time_of_name(stem)});
  }
  if (error) fail(folder.string(), ": cannot be read: ", error.message());
  return views;
}

/// Returns the name without its side ("L0001" and "R0001" are both "0001"), or nullopt if it does not name that side.
std::optional<std::string> without_side(const std::string& stem, const std::string& side, bool at_end) {
  if (stem.size() < side.size()) return std::nullopt;
  const std::size_t at = at_end ? stem.size() - side.size() : 0;
  if (lower_case(stem.substr(at, side.size())) != lower_case(side)) return std::nullopt;
  return at_end ? stem.substr(0, at) : stem.substr(side.size());
}

std::vector<ViewFile> views_of_side(const std::vector<ViewFile>& images, const char* side, bool at_end) {
  std::vector<ViewFile> views;
  for (const ViewFile& image : images) {
    const auto key = without_side(image.stem, side, at_end);
    if (!key) continue;
    views.push_back({image.path, image.stem, *key, time_of_name(*key)});
  }
  return views;
}

bool share_a_key(const std::vector<ViewFile>& left, const std::vector<ViewFile>& right) {
  std::unordered_set<std::string> keys;
  for (const ViewFile& view : right) keys.insert(view.key);
  return std::any_of(left.begin(), left.end(), [&](const ViewFile& view) { return keys.count(view.key) > 0; });
}

/// Numbers in a name, from the first to the last, without leading zeros.
std::vector<std::string> numbers_in(const std::string& stem) {
  constexpr const char* digits = "0123456789";
  std::vector<std::string> numbers;
  for (auto first = stem.find_first_of(digits); first != std::string::npos;) {
    const std::size_t end = std::min(stem.find_first_not_of(digits, first), stem.size());
    const std::size_t significant = std::min(stem.find_first_not_of('0', first), end - 1);
    numbers.push_back(stem.substr(significant, end - significant));
    first = stem.find_first_of(digits, end);
  }
  return numbers;
}

/// Uses the number as key if the names differ by camera ("left0001", "right0001"): the last one that is not the same in
/// all names ("0001_left8bit").
void key_by_number(std::vector<ViewFile>& views) {
  std::vector<std::vector<std::string>> numbers(views.size());
  std::transform(views.begin(), views.end(), numbers.begin(), [](const auto& view) { return numbers_in(view.stem); });
  const std::vector<std::string>& some = numbers.front();
  const bool alike =
      std::all_of(numbers.begin(), numbers.end(), [&](const auto& of) { return of.size() == some.size(); });
  std::size_t behind = 0;  // numbers that are the same in all names
  while (alike && views.size() > 1 && behind < some.size()) {
    const auto is_same = [&](const auto& of) { return of[of.size() - 1 - behind] == some[some.size() - 1 - behind]; };
    if (!std::all_of(numbers.begin(), numbers.end(), is_same)) break;
    ++behind;
  }
  if (behind == some.size()) behind = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (numbers[i].size() > behind) views[i].key = numbers[i][numbers[i].size() - 1 - behind];
  }
}

/// Finds the file of times: times.txt of KITTI odometry and `synth`, timestamps.txt of KITTI raw data.
std::optional<fs::path> times_file(const fs::path& folder, const fs::path& left) {
  for (const fs::path& file :
       {folder / "times.txt", left / "times.txt", left.parent_path() / "timestamps.txt", left / "timestamps.txt"}) {
    if (fs::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

std::optional<std::size_t> frame_number(const ImagePair& pair) {
  std::size_t number = 0;
  const char* const end = pair.name.data() + pair.name.size();
  const auto [read_to, error] = std::from_chars(pair.name.data(), end, number);
  if (error != std::errc{} || read_to != end) return std::nullopt;
  return number;
}

/// Number of the first time: 0 or 1, if the images are numbered from there to that of the last time; else nullopt.
std::optional<std::size_t> first_number(const std::vector<ImagePair>& pairs, std::size_t times) {
  std::size_t smallest = times + 1, largest = 0;
  for (const ImagePair& pair : pairs) {
    const auto number = frame_number(pair);
    if (!number) return std::nullopt;
    smallest = std::min(smallest, *number);
    largest = std::max(largest, *number);
  }
  if (smallest > 1 || largest + 1 - smallest != times) return std::nullopt;
  return smallest;
}

/// The first number that has no left image: ", none has the number 3".
std::string gap_text(const std::vector<ImagePair>& pairs) {
  std::optional<std::size_t> last;
  for (const ImagePair& pair : pairs) {
    const auto number = frame_number(pair);
    if (!number) return "";
    if (pair.left.empty()) return "; that of " + pair.name + " is missing";
    if (last && *number > *last + 1) return "; none has the number " + std::to_string(*last + 1);
    last = number;
  }
  return "";
}

/// Assigns the times by number, where images are missing. Throws Error naming the gap if the names have none.
void set_times_by_number(std::vector<ImagePair>& pairs, const std::vector<double>& times, const fs::path& file,
                         std::size_t left_images) {
  const bool all = pairs.size() == times.size();  // every missing left image has a right one
  const auto first = first_number(pairs, times.size());
  if (!all && !first) {
    fail(file.string(), " has ", times.size(), " times, but there are ", left_images, " left images", gap_text(pairs),
         "; delete the lines of missing images, or give --rate instead");
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].time_s = times[all ? i : *frame_number(pairs[i]) - *first];
}

/// Assigns the times to the left images in order. A pair without a left image has none; one without a time is
/// unfinished.
void set_times(std::vector<ImagePair>& pairs, const std::vector<double>& times) {
  auto time = times.begin();
  for (ImagePair& pair : pairs) {
    if (pair.left.empty()) continue;
    if (time != times.end()) {
      pair.time_s = *time++;
    } else if (pair.error.empty()) {
      pair.error = "the recording ended before the time of this pair was written";
    }
  }
}

void add_times(std::vector<ImagePair>& pairs, std::size_t left_images, const std::optional<fs::path>& file,
               const SourceOptions& options) {
  if (options.rate_hz > 0) {
    double index = 0;
    for (ImagePair& pair : pairs) pair.time_s = index++ / options.rate_hz;
  } else if (file) {
    const std::vector<double> times = read_times(*file);
    const bool fits = times.size() <= left_images && 2 * times.size() >= left_images;  // or the recording was killed
    if (fits) {
      set_times(pairs, times);
    } else {
      set_times_by_number(pairs, times, *file, left_images);
    }
  }
}

std::unique_ptr<FrameSource> folder_pair(const fs::path& folder, const fs::path& left_folder,
                                         const fs::path& right_folder, const SourceOptions& options) {
  std::vector<ViewFile> left = images_in(left_folder);
  std::vector<ViewFile> right = images_in(right_folder);
  for (const auto& [views, in] : {std::pair(&left, &left_folder), std::pair(&right, &right_folder)}) {
    if (views->empty()) fail(in->string(), ": there is no image (PNG, JPEG, TIFF, PGM or PPM) in this folder");
  }
  const bool by_time = named_by_time(left) && named_by_time(right);
  if (!by_time && !share_a_key(left, right)) {
    key_by_number(left);
    key_by_number(right);
    if (!share_a_key(left, right)) {
      fail(left_folder.string(), " and ", right_folder.string(), " have no names in common, ", left[0].stem, " and ",
           right[0].stem, " for example; both images of a pair must have the same name or number");
    }
  }
  const std::size_t left_images = left.size();
  std::vector<ImagePair> pairs = pair_views(std::move(left), std::move(right), options.max_time_difference_s);
  add_times(pairs, left_images, times_file(folder, left_folder), options);
  return std::make_unique<ImagePairs>(
      std::move(pairs), "folders " + left_folder.filename().string() + " and " + right_folder.filename().string(),
      folder);
}

/// The folder of that name, else one that differs in case only ("Left"); nullopt without.
std::optional<fs::path> sub_folder(const fs::path& folder, const std::string& name) {
  if (fs::is_directory(folder / name)) return folder / name;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (lower_case(entry->path().filename().string()) == name && entry->is_directory()) return entry->path();
  }
  return std::nullopt;
}

/// "there is left/ but no right/", or why the images are no pairs.
std::string no_pairs_reason(const fs::path& folder, std::size_t images) {
  for (const SubFolders& layout : layouts) {
    const bool left = sub_folder(folder, layout.left).has_value(), right = sub_folder(folder, layout.right).has_value();
    if (left == right) continue;
    const auto [there, lacking] = left ? std::pair(layout.left, layout.right) : std::pair(layout.right, layout.left);
    return std::string("there is ") + there + "/ but no " + lacking + "/";
  }
  if (images == 0) return "there are no stereo pairs in this folder";
  return "the names of the " + std::to_string(images) +
         " images in this folder do not tell left from right; images with both views side by side must be cut apart, "
         "or "
         "made a video and read with --layout";
}

std::unique_ptr<FrameSource> one_folder(const fs::path& folder, const SourceOptions& options) {
  const std::vector<ViewFile> images = images_in(folder);
  for (const SideNames& names : side_names) {
    std::vector<ViewFile> left = views_of_side(images, names.left, names.at_end);
    std::vector<ViewFile> right = views_of_side(images, names.right, names.at_end);
    if (!share_a_key(left, right)) continue;
    const std::size_t left_images = left.size();
    std::vector<ImagePair> pairs = pair_views(std::move(left), std::move(right), options.max_time_difference_s);
    add_times(pairs, left_images, times_file(folder, folder), options);
    return std::make_unique<ImagePairs>(std::move(pairs), "folder", folder);
  }
  fail(folder.string(), ": ", no_pairs_reason(folder, images.size()),
       "; a folder must contain left/ right/, image_2/ image_3/, image_0/ image_1/ or cam0/data cam1/data, or images "
       "named L… and R…");
}

}  // namespace

std::unique_ptr<FrameSource> open_folder(const std::string& folder, const SourceOptions& options) {
  const fs::path path(folder);
  for (const SubFolders& layout : layouts) {
    const auto left = sub_folder(path, layout.left), right = sub_folder(path, layout.right);
    if (left && right) return folder_pair(path, *left, *right, options);
  }
  return one_folder(path, options);
}

std::unique_ptr<FrameSource> open_two_folders(const std::string& left, const std::string& right,
                                              const SourceOptions& options) {
  const auto without_slash = [](const std::string& folder) {
    const fs::path path = fs::path(folder).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
  };
  const fs::path left_path = without_slash(left);
  return folder_pair(left_path.parent_path(), left_path, without_slash(right), options);
}

}  // namespace roadstereo::io
