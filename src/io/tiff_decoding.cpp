#include <tiffio.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "io/image_check.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// A file in memory, as libtiff reads it.
struct MemoryFile {
  Bytes bytes;
  std::size_t at = 0;
};

MemoryFile& file_of(thandle_t handle) {
  return *static_cast<MemoryFile*>(handle);
}

tmsize_t read_bytes(thandle_t handle, void* to, tmsize_t count) {
  MemoryFile& file = file_of(handle);
  const std::size_t left = file.bytes.size() - std::min(file.at, file.bytes.size());
  const std::size_t given = std::min(left, static_cast<std::size_t>(count));
  std::copy_n(file.bytes.data() + file.at, given, static_cast<std::uint8_t*>(to));
  file.at += given;
  return static_cast<tmsize_t>(given);
}

tmsize_t refuse_writing(thandle_t, void*, tmsize_t) {
  return 0;
}

toff_t seek_to(thandle_t handle, toff_t offset, int whence) {
  MemoryFile& file = file_of(handle);
  const std::size_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? file.at : file.bytes.size();
  file.at = std::min(from + static_cast<std::size_t>(offset), file.bytes.size());
  return file.at;
}

int do_not_close(thandle_t) {
  return 0;
}

toff_t size_of(thandle_t handle) {
  return file_of(handle).bytes.size();
}

struct CloseTiff {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using OpenTiff = std::unique_ptr<TIFF, CloseTiff>;

/// Opens a file for reading ("m": without mapping it), whose errors are not printed.
OpenTiff open(MemoryFile& file) {
  constexpr const char *name = "", *mode = "rm";
#if TIFFLIB_VERSION >= 20221213
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  const auto ignore = [](TIFF*, void*, const char*, const char*, va_list) { return 1; };
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), ignore, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
  return OpenTiff(TIFFClientOpenExt(name, mode, &file, read_bytes, refuse_writing, seek_to, do_not_close, size_of,
                                    nullptr, nullptr, options.get()));
#else
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  return OpenTiff(
      TIFFClientOpen(name, mode, &file, read_bytes, refuse_writing, seek_to, do_not_close, size_of, nullptr, nullptr));
#endif
}

}  // namespace

void check_tiff_decodes(const std::string& path, Bytes bytes) {
  MemoryFile memory{bytes};
  const OpenTiff file = open(memory);
  if (!file) fail(path, ": the TIFF file is damaged: it has no image");
  std::uint16_t compression = COMPRESSION_NONE;
  TIFFGetField(file.get(), TIFFTAG_COMPRESSION, &compression);
  if (compression == COMPRESSION_NONE) return;
  if (TIFFIsCODECConfigured(compression) == 0) {
    fail(path, ": the TIFF file has compression ", compression, ", which is not supported; use LZW, Deflate or none");
  }
  constexpr tmsize_t max_bytes = tmsize_t{1} << 30;
  const bool tiled = TIFFIsTiled(file.get()) != 0;
  const std::uint32_t parts = tiled ? TIFFNumberOfTiles(file.get()) : TIFFNumberOfStrips(file.get());
  const tmsize_t size = tiled ? TIFFTileSize(file.get()) : TIFFStripSize(file.get());
  if (size <= 0 || size > max_bytes) fail(path, ": the TIFF file is damaged: a part has ", size, " bytes");
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size));
  for (std::uint32_t i = 0; i < parts; ++i) {
    const tmsize_t read = tiled ? TIFFReadEncodedTile(file.get(), i, pixels.data(), size)
                                : TIFFReadEncodedStrip(file.get(), i, pixels.data(), size);
    if (read < 0) fail(path, ": the TIFF file is damaged: part ", i + 1, " of ", parts, " cannot be decoded");
  }
}

}  // namespace roadstereo::io
