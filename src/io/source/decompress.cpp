#include "io/source/decompress.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <new>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 18U;

/// Makes room behind the first `used` bytes.
void grow(const std::string& source, std::size_t used, std::vector<std::uint8_t>& bytes) {
  if (used >= max_decompressed_bytes) {
    fail(source, ": decompressed data have more than ", max_decompressed_bytes, " bytes; that is the limit");
  }
  if (bytes.size() == used) bytes.resize(std::min(std::max(block_bytes, 2 * used), max_decompressed_bytes));
}

}  // namespace

std::vector<std::uint8_t> decompress_zstd(const std::string& source, std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  std::vector<std::uint8_t> plain;
  ZSTD_inBuffer input{bytes.data(), bytes.size(), 0};
  std::size_t used = 0;
  std::size_t expected = 1;  // 0 at the end of a frame
  while (input.pos < input.size || expected != 0) {
    grow(source, used, plain);
    ZSTD_outBuffer output{plain.data() + used, plain.size() - used, 0};
    const std::size_t before = input.pos;
    expected = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(expected) != 0) fail(source, ": zstd data are damaged: ", ZSTD_getErrorName(expected));
    used += output.pos;
    if (output.pos == 0 && input.pos == before) fail(source, ": zstd data are truncated");
  }
  plain.resize(used);
  return plain;
}

void decompress_zstd_file(const std::string& from, const std::string& to) {
  std::ifstream source(from, std::ios::binary);
  if (!source) fail(from, ": the file cannot be read");
  std::ofstream target(to, std::ios::binary);
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  std::vector<char> packed(block_bytes);
  std::vector<char> plain(block_bytes);
  std::size_t expected = 1;  // 0 at the end of a frame
  while (source.read(packed.data(), static_cast<std::streamsize>(packed.size())) || source.gcount() > 0) {
    ZSTD_inBuffer input{packed.data(), static_cast<std::size_t>(source.gcount()), 0};
    while (input.pos < input.size) {
      ZSTD_outBuffer output{plain.data(), plain.size(), 0};
      expected = ZSTD_decompressStream(stream.get(), &output, &input);
      if (ZSTD_isError(expected) != 0) fail(from, ": zstd data are damaged: ", ZSTD_getErrorName(expected));
      target.write(plain.data(), static_cast<std::streamsize>(output.pos));
    }
  }
  if (expected != 0) fail(from, ": zstd data are truncated");
  target.close();
  if (!target) throw SystemError("cannot write " + to + ": the disk may be full");
}

std::vector<std::uint8_t> decompress_lz4(const std::string& source, std::span<const std::uint8_t> bytes) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(created,
                                                                                     LZ4F_freeDecompressionContext);
  std::vector<std::uint8_t> plain;
  std::size_t used = 0;
  std::size_t expected = 1;
  while (expected != 0) {
    grow(source, used, plain);
    std::size_t written = plain.size() - used;
    std::size_t taken = bytes.size();
    expected = LZ4F_decompress(context.get(), plain.data() + used, &written, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(expected) != 0) fail(source, ": LZ4 data are damaged: ", LZ4F_getErrorName(expected));
    used += written;
    bytes = bytes.subspan(taken);
    if (written == 0 && taken == 0) fail(source, ": LZ4 data are truncated");
  }
  plain.resize(used);
  return plain;
}

}  // namespace roadstereo::io
