#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "io/source/frame_times.hpp"
#include "io/source/image_pairs.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Splits a line at commas or semicolons if there are any, else at blanks. Quotes protect separators.
std::vector<std::string> words_of(const std::string& line) {
  const char* const separators = line.find_first_of(",;") != std::string::npos ? ",;" : " \t";
  const bool blanks_separate = separators[0] == ' ';
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (quoted || std::string_view(separators).find(letter) == std::string_view::npos) {
      if (quoted || !words.back().empty() || (letter != ' ' && letter != '\t')) words.back() += letter;
    } else if (!blanks_separate || !words.back().empty()) {
      words.emplace_back();
    }
  }
  for (std::string& word : words) word.erase(word.find_last_not_of(" \t") + 1);
  if (blanks_separate && words.back().empty()) words.pop_back();
  return words;
}

/// Whether the line is a header "left right …".
bool is_heading(const std::vector<std::string>& words) {
  return words.size() >= 2 && words[0] == "left" && words[1] == "right";
}

ImagePair pair_of(const std::vector<std::string>& words, const std::string& where, const fs::path& folder) {
  if (words.size() < 2 || words.size() > 3 || words[0].empty() || words[1].empty()) {
    fail(where, ": \"left right [seconds]\" is expected, but the line has ", words.size(),
         words.size() > 3 ? " words; put names with blanks in quotes, or separate by commas" : " words");
  }
  ImagePair pair;
  pair.left = (folder / words[0]).string();
  pair.right = (folder / words[1]).string();
  pair.name = fs::path(words[0]).stem().string();
  if (words.size() < 3) return pair;
  const char* end = words[2].data() + words[2].size();
  const auto [read_to, error] = std::from_chars(words[2].data(), end, pair.time_s);
  if (error != std::errc{} || read_to != end || !std::isfinite(pair.time_s)) {
    fail(where, ": \"", words[2], "\" is not a time in seconds");
  }
  require_seconds(where, words[2], pair.time_s);
  return pair;
}

}  // namespace

std::unique_ptr<FrameSource> open_list(const std::string& file, const SourceOptions& options) {
  std::ifstream stream(file);
  if (!stream) fail(file, ": cannot be read");
  std::vector<ImagePair> pairs;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1 && line.rfind(byte_order_mark, 0) == 0) line.erase(0, byte_order_mark.size());
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0].empty() || words[0][0] == '#' || (pairs.empty() && is_heading(words))) continue;
    const std::string where = file + ", line " + std::to_string(number);
    ImagePair pair = pair_of(words, where, fs::path(file).parent_path());
    if (!pairs.empty() && pair.time_s < pairs.back().time_s) {
      fail(where, ": the time ", words[2], " lies before that of the pair above; times must not run backwards");
    }
    pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) fail(file, ": the list has no pairs; a line must be \"left right [seconds]\"");
  if (options.rate_hz > 0) {
    double index = 0;
    for (ImagePair& pair : pairs) pair.time_s = index++ / options.rate_hz;
  }
  return std::make_unique<ImagePairs>(std::move(pairs), "list", fs::path(file).parent_path());
}

}  // namespace roadstereo::io
