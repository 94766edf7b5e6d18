#include "evaluation/ply_read.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "evaluation/ply_header.hpp"
#include "io/file_bytes.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t max_bytes = std::size_t{4} << 30U;

template <class Value>
double value_at(const std::uint8_t* bytes, bool swapped) {
  std::array<std::uint8_t, sizeof(Value)> raw{};
  std::memcpy(raw.data(), bytes, sizeof(Value));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Value>(raw));
}

double decode(PlyType type, const std::uint8_t* bytes, bool swapped) {
  switch (type) {
    case PlyType::i8:
      return value_at<std::int8_t>(bytes, swapped);
    case PlyType::u8:
      return value_at<std::uint8_t>(bytes, swapped);
    case PlyType::i16:
      return value_at<std::int16_t>(bytes, swapped);
    case PlyType::u16:
      return value_at<std::uint16_t>(bytes, swapped);
    case PlyType::i32:
      return value_at<std::int32_t>(bytes, swapped);
    case PlyType::u32:
      return value_at<std::uint32_t>(bytes, swapped);
    case PlyType::f32:
      return value_at<float>(bytes, swapped);
    case PlyType::f64:
      break;
  }
  return value_at<double>(bytes, swapped);
}

/// Reads the values after the header in any encoding.
class Values {
 public:
  Values(const std::string& path, const PlyHeader& header, std::span<const std::uint8_t> data)
      : path_(path), encoding_(header.encoding), data_(data) {}

  double next(PlyType type) { return encoding_ == PlyEncoding::ascii ? next_word() : next_bytes(type); }

  /// Size of the unread part of the file.
  std::size_t bytes_left() const { return data_.size() - at_; }

  /// Minimum number of bytes of a value; the last one of a text file has no separator.
  std::size_t min_size(PlyType type) const { return encoding_ == PlyEncoding::ascii ? 1 : size_of(type); }

  void skip_list(const PlyProperty& property) {
    const double length = next(property.count_type);
    if (!(length >= 0)) fail(path_, ": a list \"", property.name, "\" has ", length, " entries");
    if (length > static_cast<double>(bytes_left())) fail_truncated();
    for (auto left = static_cast<std::size_t>(length); left > 0; --left) next(property.type);
  }

  [[noreturn]] void fail_truncated() const {
    fail(path_, ": the file is truncated: its PLY header declares more data");
  }

 private:
  double next_bytes(PlyType type) {
    const std::size_t size = size_of(type);
    if (bytes_left() < size) fail_truncated();
    const bool little = encoding_ == PlyEncoding::little_endian;
    const double value = decode(type, data_.data() + at_, little != (std::endian::native == std::endian::little));
    at_ += size;
    return value;
  }

  double next_word() {
    const auto is_space = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    while (at_ < data_.size() && is_space(data_[at_])) ++at_;
    const std::size_t start = at_;
    while (at_ < data_.size() && !is_space(data_[at_])) ++at_;
    if (start == at_) fail_truncated();
    const char* first = reinterpret_cast<const char*>(data_.data() + start);
    const char* last = reinterpret_cast<const char*>(data_.data() + at_);
    const char* digits = *first == '+' ? first + 1 : first;
    double value = 0;
    const auto [end, error] = std::from_chars(digits, last, value);
    if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::quiet_NaN();
    if (error != std::errc{} || end != last) {
      constexpr std::size_t max_shown = 40;
      fail(path_, ": \"", std::string(first, last).substr(0, max_shown), "\" is not a number");
    }
    return value;
  }

  const std::string& path_;
  PlyEncoding encoding_;
  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
};

/// Checks the number of elements against the size of the file before memory is allocated.
void check_count(const std::string& path, const PlyElement& element, const Values& values) {
  std::size_t min_bytes = 0;
  for (const PlyProperty& property : element.properties) {
    min_bytes += values.min_size(property.is_list ? property.count_type : property.type);
  }
  if (min_bytes > 0 && element.count > values.bytes_left() / min_bytes) {
    fail(path, ": the file is truncated: its header declares ", element.count, " of \"", element.name, "\", but only ",
         values.bytes_left(), " bytes are left");
  }
}

void skip_element(const PlyElement& element, Values& values) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        values.skip_list(property);
      } else {
        values.next(property.type);
      }
    }
  }
}

/// Returns the index of a scalar property of the vertices.
std::optional<std::size_t> find_property(const PlyElement& vertex, const std::string& name) {
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    if (vertex.properties[i].name == name && !vertex.properties[i].is_list) return i;
  }
  return std::nullopt;
}

double white_of(PlyType type) {
  switch (type) {
    case PlyType::i8:
      return std::numeric_limits<std::int8_t>::max();
    case PlyType::u8:
      return std::numeric_limits<std::uint8_t>::max();
    case PlyType::i16:
      return std::numeric_limits<std::int16_t>::max();
    case PlyType::u16:
      return std::numeric_limits<std::uint16_t>::max();
    case PlyType::i32:
      return std::numeric_limits<std::int32_t>::max();
    case PlyType::u32:
      return std::numeric_limits<std::uint32_t>::max();
    case PlyType::f32:
    case PlyType::f64:
      break;
  }
  return 1;
}

std::uint8_t colour_of(double value, PlyType type) {
  constexpr double white = 255;
  const double level = value / white_of(type) * white;
  return std::isfinite(level) ? static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, white))) : 0;
}

/// Indices of coordinates and colours in the properties of a vertex.
struct VertexProperties {
  std::array<std::size_t, 3> xyz{};
  std::optional<std::array<std::size_t, 3>> rgb{};
};

VertexProperties find_properties(const std::string& path, const PlyElement& vertex) {
  VertexProperties properties;
  const std::array<std::string, 3> axes{"x", "y", "z"}, colours{"red", "green", "blue"};
  std::array<std::size_t, 3> rgb{};
  bool coloured = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = find_property(vertex, axes[i]);
    if (!axis) fail(path, ": the vertices have no property \"", axes[i], "\"");
    properties.xyz[i] = *axis;
    const auto colour = find_property(vertex, colours[i]);
    coloured = coloured && colour;
    rgb[i] = colour.value_or(0);
  }
  if (coloured) properties.rgb = rgb;
  return properties;
}

PointCloud read_vertices(const std::string& path, const PlyElement& vertex, Values& values) {
  const VertexProperties properties = find_properties(path, vertex);
  PointCloud cloud;
  cloud.points.reserve(vertex.count);
  if (properties.rgb) cloud.colours.reserve(vertex.count);
  std::vector<double> row(vertex.properties.size());
  for (std::uint64_t i = 0; i < vertex.count; ++i) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      const PlyProperty& property = vertex.properties[k];
      if (property.is_list) {
        values.skip_list(property);
      } else {
        row[k] = values.next(property.type);
      }
    }
    std::array<float, 3> point{};
    for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<float>(row[properties.xyz[k]]);
    if (!std::all_of(point.begin(), point.end(), [](float x) { return std::isfinite(x); })) continue;
    cloud.points.push_back(point);
    if (!properties.rgb) continue;
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t index = (*properties.rgb)[k];
      colour[k] = colour_of(row[index], vertex.properties[index].type);
    }
    cloud.colours.push_back(colour);
  }
  return cloud;
}

}  // namespace

PointCloud read_ply(const std::string& path) {
  const std::vector<std::uint8_t> bytes = read_file(path, max_bytes);
  const PlyHeader header = read_ply_header(path, bytes);
  Values values(path, header, std::span(bytes).subspan(header.bytes));
  for (const PlyElement& element : header.elements) {
    check_count(path, element, values);
    if (element.name != "vertex") {
      skip_element(element, values);
      continue;
    }
    PointCloud cloud = read_vertices(path, element, values);
    if (cloud.points.empty()) fail(path, ": the file has no vertex with finite coordinates");
    return cloud;
  }
  fail(path, ": the file has no element \"vertex\"");
}

}  // namespace roadstereo::io
