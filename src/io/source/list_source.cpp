#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/source/image_pairs.hpp"
#include "io/source/sources.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

/// The words of a line; with a comma in it, what lies between commas.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  std::string word;
  if (line.find(',') == std::string::npos) {
    while (stream >> word) words.push_back(word);
    return words;
  }
  while (std::getline(stream, word, ',')) {
    const auto first = word.find_first_not_of(" \t");
    words.push_back(first == std::string::npos ? "" : word.substr(first, word.find_last_not_of(" \t") - first + 1));
  }
  return words;
}

ImagePair pair_of(const std::vector<std::string>& words, const std::string& where, const fs::path& folder) {
  if (words.size() < 2 || words.size() > 3 || words[0].empty() || words[1].empty()) {
    fail(where, ": \"left right [seconds]\" is expected, but there are ", words.size(), " words");
  }
  ImagePair pair;
  pair.left = (folder / words[0]).string();
  pair.right = (folder / words[1]).string();
  pair.name = fs::path(words[0]).stem().string();
  if (words.size() < 3) return pair;
  const char* end = words[2].data() + words[2].size();
  const auto [read_to, error] = std::from_chars(words[2].data(), end, pair.time_s);
  if (error != std::errc{} || read_to != end) fail(where, ": \"", words[2], "\" is no time in seconds");
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
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0].empty() || words[0][0] == '#') continue;
    pairs.push_back(pair_of(words, file + ", line " + std::to_string(number), fs::path(file).parent_path()));
  }
  if (pairs.empty()) fail(file, ": lists no pairs; a line is \"left right [seconds]\"");
  if (options.rate_hz > 0) {
    double place = 0;
    for (ImagePair& pair : pairs) pair.time_s = place++ / options.rate_hz;
  }
  return std::make_unique<ImagePairs>(std::move(pairs), "list");
}

}  // namespace roadstereo::io
