#include "evaluation/ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t max_header_bytes = 65536;
constexpr std::size_t max_shown = 60;

using NamedType = std::pair<std::string_view, PlyType>;
constexpr std::array<NamedType, 16> type_names{{{"char", PlyType::i8},
                                                {"int8", PlyType::i8},
                                                {"uchar", PlyType::u8},
                                                {"uint8", PlyType::u8},
                                                {"short", PlyType::i16},
                                                {"int16", PlyType::i16},
                                                {"ushort", PlyType::u16},
                                                {"uint16", PlyType::u16},
                                                {"int", PlyType::i32},
                                                {"int32", PlyType::i32},
                                                {"uint", PlyType::u32},
                                                {"uint32", PlyType::u32},
                                                {"float", PlyType::f32},
                                                {"float32", PlyType::f32},
                                                {"double", PlyType::f64},
                                                {"float64", PlyType::f64}}};

/// Parses a header line by line.
class HeaderReader {
 public:
  HeaderReader(const std::string& path, std::span<const std::uint8_t> bytes)
      : path_(path), text_(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), max_header_bytes)) {}

  PlyHeader read() {
    if (next_line() != "ply") fail(path_, " is not a PLY file: it does not start with \"ply\"");
    bool has_format = false;
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
      const std::vector<std::string> words = split(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "format") {
        read_format(words, line);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words, line);
      } else if (words[0] == "property") {
        read_property(words, line);
      } else {
        fail_line(line, "it must be a format, comment, element or property");
      }
    }
    if (!has_format) fail(path_, ": the PLY header has no line \"format\"");
    header_.bytes = at_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail_line(std::string_view line, const char* reason) const {
    fail(path_, ": the PLY header has the line \"", line.substr(0, max_shown), "\"; ", reason);
  }

  std::string_view next_line() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail(path_, at_ == 0 ? " is not a PLY file" : ": the PLY header does not end");
    std::string_view line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    return line;
  }

  static std::vector<std::string> split(std::string_view line) {
    std::istringstream stream{std::string(line)};
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  }

  void read_format(const std::vector<std::string>& words, std::string_view line) {
    const std::string name = words.size() < 2 ? "" : words[1];
    if (name == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      fail_line(line, "the format must be ascii, binary_little_endian or binary_big_endian");
    }
  }

  void read_element(const std::vector<std::string>& words, std::string_view line) {
    PlyElement element;
    if (words.size() != 3) fail_line(line, "an element has a name and a number");
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc{} || stop != end) fail_line(line, "the number of elements must be an integer of at least 0");
    header_.elements.push_back(element);
  }

  void read_property(const std::vector<std::string>& words, std::string_view line) {
    if (header_.elements.empty()) fail_line(line, "it must follow an element");
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3) fail_line(line, "a property has a type and a name");
    property.name = words.back();
    property.type = read_type(words[words.size() - 2], line);
    if (property.is_list) property.count_type = read_type(words[2], line);
    const bool whole = property.count_type != PlyType::f32 && property.count_type != PlyType::f64;
    if (!whole) fail_line(line, "the length of a list must be of an integer type");
    auto& properties = header_.elements.back().properties;
    const bool twice = std::any_of(properties.begin(), properties.end(),
                                   [&](const PlyProperty& other) { return other.name == property.name; });
    if (twice) fail_line(line, "the property is repeated");
    properties.push_back(property);
  }

  PlyType read_type(const std::string& name, std::string_view line) const {
    const auto* found =
        std::find_if(type_names.begin(), type_names.end(), [&](const NamedType& type) { return type.first == name; });
    if (found == type_names.end())
      fail_line(line, "the type must be one of char, uchar, short, ushort, int, uint, float, double");
    return found->second;
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::i8:
    case PlyType::u8:
      return 1;
    case PlyType::i16:
    case PlyType::u16:
      return 2;
    case PlyType::i32:
    case PlyType::u32:
    case PlyType::f32:
      return 4;
    case PlyType::f64:
      break;
  }
  return 8;
}

PlyHeader read_ply_header(const std::string& path, std::span<const std::uint8_t> bytes) {
  return HeaderReader(path, bytes).read();
}

}  // namespace roadstereo::io
