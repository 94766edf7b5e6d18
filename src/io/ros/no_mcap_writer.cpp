#include "io/ros/mcap_chunk.hpp"
#include "io/ros/mcap_writer.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

[[noreturn]] void fail_without_mcap() {
  fail("this build cannot write MCAP files; it needs the packages libsqlite3-dev, libzstd-dev and liblz4-dev, and ",
       "CMake's -DROADSTEREO_ROS2=ON");
}

}  // namespace

std::vector<std::uint8_t> mcap_chunk(std::span<const TopicMessage> /*messages*/) {
  fail_without_mcap();
}

McapWriter McapWriter::begin(const std::filesystem::path& /*file*/, std::span<const RosTopic> /*topics*/) {
  fail_without_mcap();
}

McapWriter McapWriter::resume(const std::filesystem::path& /*file*/, std::span<const RosTopic> /*topics*/,
                              std::int64_t /*chunks*/) {
  fail_without_mcap();
}

McapWriter::McapWriter(McapWriter&& /*other*/) noexcept : topics_(0) {}

McapWriter::~McapWriter() = default;

void McapWriter::append(std::span<const std::uint8_t> /*chunk*/) {
  fail_without_mcap();
}

void McapWriter::finish() {
  fail_without_mcap();
}

}  // namespace roadstereo::io
