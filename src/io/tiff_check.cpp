#include <algorithm>
#include <optional>

#include "core/image_limits.hpp"
#include "io/image_check.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

enum Tag : std::uint16_t {
  image_width = 256,
  image_height = 257,
  bits_per_sample = 258,
  strip_offsets = 273,
  orientation = 274,
  samples_per_pixel = 277,
  strip_byte_counts = 279,
  tile_offsets = 324,
  tile_byte_counts = 325,
  sample_format = 339
};

/// Directory of the first image of a TIFF file.
class Directory {
 public:
  Directory(const std::string& path, Bytes bytes) : path_(path), bytes_(bytes), big_endian_(bytes[0] == 'M') {
    start_ = number(4, 4);
    entries_ = number(start_, 2);
    need(start_ + 2, entries_ * entry_size);
  }

  /// Returns the values of a tag; empty if it is missing.
  std::vector<std::size_t> values(Tag tag) const {
    for (std::size_t i = 0; i < entries_; ++i) {
      const std::size_t entry = start_ + 2 + i * entry_size;
      if (number(entry, 2) == tag) return entry_values(entry);
    }
    return {};
  }

  std::size_t value(Tag tag, std::size_t absent) const {
    const std::vector<std::size_t> all = values(tag);
    return all.empty() ? absent : all.front();
  }

  void need(std::size_t at, std::size_t count) const {
    if (at > bytes_.size() || count > bytes_.size() - at) fail(path_, ": the TIFF file is truncated");
  }

 private:
  static constexpr std::size_t entry_size = 12;

  std::size_t number(std::size_t at, std::size_t size) const {
    need(at, size);
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = bytes_[at + (big_endian_ ? i : size - 1 - i)];
      value = value << 8U | byte;
    }
    return value;
  }

  std::vector<std::size_t> entry_values(std::size_t entry) const {
    const std::size_t type = number(entry + 2, 2);
    const std::size_t size = type == 1 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 0;
    if (size == 0) fail(path_, ": the TIFF file is damaged: a tag has the wrong type");
    const std::size_t count = number(entry + 4, 4);
    const std::size_t at = count * size <= 4 ? entry + 8 : number(entry + 8, 4);
    need(at, count * size);
    constexpr std::size_t max_count =
        2 * std::size_t{max_image_side} * max_image_side / 256;  // strips or tiles of an image of the largest size
    if (count > max_count) fail(path_, ": the TIFF file is damaged: a tag has ", count, " values");
    std::vector<std::size_t> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = number(at + i * size, size);
    return values;
  }

  const std::string& path_;
  Bytes bytes_;
  bool big_endian_;
  std::size_t start_ = 0;
  std::size_t entries_ = 0;
};

void check_data(const std::string& path, const Directory& directory) {
  const bool tiled = !directory.values(tile_offsets).empty();
  const std::vector<std::size_t> offsets = directory.values(tiled ? tile_offsets : strip_offsets);
  const std::vector<std::size_t> counts = directory.values(tiled ? tile_byte_counts : strip_byte_counts);
  if (offsets.empty() || offsets.size() != counts.size()) {
    fail(path, ": the TIFF file is damaged: it has no image");
  }
  for (std::size_t i = 0; i < offsets.size(); ++i) directory.need(offsets[i], counts[i]);
}

}  // namespace

bool is_tiff(Bytes bytes) {
  if (bytes.size() < 4) return false;
  const bool little = bytes[0] == 'I' && bytes[1] == 'I' && bytes[3] == 0 && (bytes[2] == 42 || bytes[2] == 43);
  const bool big = bytes[0] == 'M' && bytes[1] == 'M' && bytes[2] == 0 && (bytes[3] == 42 || bytes[3] == 43);
  return little || big;
}

ImageHeader check_tiff(const std::string& path, Bytes bytes) {
  if (bytes[2] == 43 || bytes[3] == 43) fail(path, ": BigTIFF is not supported; save it as a classic TIFF");
  const Directory directory(path, bytes);
  ImageHeader header;
  header.width = static_cast<std::int64_t>(directory.value(image_width, 0));
  header.height = static_cast<std::int64_t>(directory.value(image_height, 0));
  header.bits = static_cast<int>(directory.value(bits_per_sample, 1));
  header.channels = static_cast<int>(directory.value(samples_per_pixel, 1));
  header.is_float = directory.value(sample_format, 1) == 3;
  constexpr std::size_t upright = 1;
  if (const std::size_t stored = directory.value(orientation, upright); stored != upright) {
    fail(path, ": the TIFF file has the orientation ", stored,
         "; it must be 1, rows from the top and columns from the left");
  }
  check_data(path, directory);
  return header;
}

}  // namespace roadstereo::io
