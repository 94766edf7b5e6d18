#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "roadstereo/error.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::io {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void fail_write(const fs::path& file, int error) {
  fail<SystemError>("cannot write ", file.string(), ": ", std::generic_category().message(error));
}

int open_file(const fs::path& file, int flags) {
  constexpr mode_t readable = 0644;
  const int descriptor = ::open(file.c_str(), flags | O_WRONLY | O_APPEND | O_CLOEXEC, readable);
  if (descriptor < 0) fail_write(file, errno);
  return descriptor;
}

std::string provenance_line(const Provenance& provenance) {
  Json document = Json::object();
  for (const auto& [name, value] : provenance) document[name] = value;
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Calls `visit` for every complete line of a file with the position after it.
template <class Visit>
void for_each_line(const fs::path& file, const Visit& visit) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream && errno == ENOENT) fail(file.string(), ": there is no flight to resume");
  if (!stream) fail<SystemError>(file.string(), " cannot be read: ", std::generic_category().message(errno));
  std::string line;
  std::uintmax_t end = 0;
  while (std::getline(stream, line) && !stream.eof()) {  // a line without its end is incomplete
    end += line.size() + 1;
    visit(line, end);
  }
  if (stream.bad()) fail<SystemError>(file.string(), " cannot be read");
}

FlightFrame frame_of(const std::string& line, const fs::path& file, std::int64_t number) {
  try {
    return read_flight_frame(line);
  } catch (const Error& error) {
    fail(file.string(), ", line ", number, ": ", error.what(), "; start again without --resume");
  }
}

void require_same(const std::string& begun_with, const Provenance& provenance, const fs::path& file) {
  const Json begun = Json::parse(begun_with, nullptr, false);
  if (!begun.is_object()) fail(file.string(), ": this is not a flight journal; start again without --resume");
  for (const auto& [name, value] : provenance) {
    const std::string before = begun.contains(name) && begun[name].is_string() ? begun[name].get<std::string>() : "";
    if (before == valid_utf8(value)) continue;
    fail(file.string(), ": this flight was started with ", name, " \"", before, "\", not \"", value,
         "\"; use the same, or start again without --resume");
  }
}

}  // namespace

FlightJournal::FlightJournal(fs::path file, int descriptor) : file_(std::move(file)), descriptor_(descriptor) {}

FlightJournal::FlightJournal(FlightJournal&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      frames_(other.frames_),
      last_(std::move(other.last_)) {}

FlightJournal::~FlightJournal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FlightJournal::write_line(const std::string& line) {
  const std::string text = line + "\n";
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t part = ::write(descriptor_, text.data() + written, text.size() - written);
    if (part < 0 && errno == EINTR) continue;
    if (part < 0) fail_write(file_, errno);
    written += static_cast<std::size_t>(part);
  }
}

FlightJournal FlightJournal::begin(const fs::path& file, const Provenance& provenance) {
  FlightJournal journal(file, open_file(file, O_CREAT | O_TRUNC));
  journal.write_line(provenance_line(provenance));
  return journal;
}

FlightJournal FlightJournal::resume(const fs::path& file, const Provenance& provenance) {
  std::uintmax_t good_end = 0;
  std::int64_t lines = 0;
  std::string last_line;
  for_each_line(file, [&](const std::string& line, std::uintmax_t end) {
    if (lines == 0) require_same(line, provenance, file);
    last_line = line;
    ++lines;
    good_end = end;
  });
  if (lines == 0) fail(file.string(), ": this is not a flight journal; start again without --resume");
  std::optional<FlightFrame> last;
  if (lines > 1) last = frame_of(last_line, file, lines);
  std::error_code error;
  fs::resize_file(file, good_end, error);
  if (error) fail_write(file, error.value());
  FlightJournal journal(file, open_file(file, 0));
  journal.frames_ = lines - 1;
  journal.last_ = std::move(last);
  return journal;
}

void FlightJournal::append(const FlightFrame& frame) {
  write_line(flight_frame_json(frame));
  ++frames_;
  last_ = frame;
}

void FlightJournal::for_each(const std::function<void(const FlightFrame&)>& visit) const {
  read_flight_journal(file_, visit);
}

void read_flight_journal(const fs::path& file, const std::function<void(const FlightFrame&)>& visit) {
  std::int64_t lines = 0;
  for_each_line(file, [&](const std::string& line, std::uintmax_t) {
    if (lines > 0) visit(frame_of(line, file, lines + 1));
    ++lines;
  });
}

}  // namespace roadstereo::io
