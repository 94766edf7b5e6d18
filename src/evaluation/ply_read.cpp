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

/// The values after the header, one after the other, in whatever encoding.
class Values {
 public:
  Values(const std::string& path, const PlyHeader& header, std::span<const std::uint8_t> data)
      : path_(path), encoding_(header.encoding), data_(data) {}

  double next(PlyType type) { return encoding_ == PlyEncoding::ascii ? next_word() : next_bytes(type); }

  /// What is left of the file.
  std::size_t bytes_left() const { return data_.size() - at_; }

  /// Bytes that a value takes at the least; the last one of a text has no space behind it.
  std::size_t min_size(PlyType type) const { return encoding_ == PlyEncoding::ascii ? 1 : size_of(type); }

  void skip_list(const PlyProperty& property) {
    const double length = next(property.count_type);
    if (!(length >= 0)) fail(path_, ": a list \"", property.name, "\" has ", length, " entries");
    if (length > static_cast<double>(bytes_left())) fail_truncated();
    for (auto left = static_cast<std::size_t>(length); left > 0; --left) next(property.type);
  }

  [[noreturn]] void fail_truncated() const {
    fail(path_, ": the file is truncated: its PLY header promises more than there is");
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
      fail(path_, ": \"", std::string(first, last).substr(0, max_shown), "\" stands where a number must be");
    }
    return value;
  }

  const std::string& path_;
  PlyEncoding encoding_;
  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
};

/// Every element takes at least so many bytes; refuses numbers that the file cannot hold before memory is asked for.
void check_count(const std::string& path, const PlyElement& element, const Values& values) {
  std::size_t least = 0;
  for (const PlyProperty& property : element.properties) {
    least += values.min_size(property.is_list ? property.count_type : property.type);
  }
  if (least > 0 && element.count > values.bytes_left() / least) {
    fail(path, ": the file is truncated: its header promises ", element.count, " of \"", element.name, "\", and ",
         values.bytes_left(), " bytes are left for them");
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

/// The place of a scalar property among those of the vertices.
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

/// Where the figures of a vertex stand.
struct VertexPlaces {
  std::array<std::size_t, 3> xyz{};
  std::optional<std::array<std::size_t, 3>> rgb{};
};

VertexPlaces find_places(const std::string& path, const PlyElement& vertex) {
  VertexPlaces places;
  const std::array<std::string, 3> axes{"x", "y", "z"}, colours{"red", "green", "blue"};
  std::array<std::size_t, 3> rgb{};
  bool coloured = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = find_property(vertex, axes[i]);
    if (!axis) fail(path, ": the vertices have no property \"", axes[i], "\"");
    places.xyz[i] = *axis;
    const auto colour = find_property(vertex, colours[i]);
    coloured = coloured && colour;
    rgb[i] = colour.value_or(0);
  }
  if (coloured) places.rgb = rgb;
  return places;
}

PointCloud read_vertices(const std::string& path, const PlyElement& vertex, Values& values) {
  const VertexPlaces places = find_places(path, vertex);
  PointCloud cloud;
  cloud.points.reserve(vertex.count);
  if (places.rgb) cloud.colours.reserve(vertex.count);
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
    for (std::size_t k = 0; k < 3; ++k) point[k] = static_cast<float>(row[places.xyz[k]]);
    if (!std::all_of(point.begin(), point.end(), [](float x) { return std::isfinite(x); })) continue;
    cloud.points.push_back(point);
    if (!places.rgb) continue;
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t place = (*places.rgb)[k];
      colour[k] = colour_of(row[place], vertex.properties[place].type);
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
