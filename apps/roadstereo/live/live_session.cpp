#include "live/live_session.hpp"

#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "calibration_yaml.hpp"
#include "live/recording_folder.hpp"
#include "lower_priority.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

/// A source without pairs that keeps the calibration while the real source is reopened.
class CalibrationOnly final : public io::FrameSource {
 public:
  CalibrationOnly(std::optional<io::CalibrationFile> calibration, std::string description)
      : calibration_(std::move(calibration)), description_(std::move(description)) {}

  std::optional<io::SourcePair> next() override { return std::nullopt; }
  void skip(std::int64_t) override {}
  std::optional<std::int64_t> size() const override { return 0; }
  std::optional<io::CalibrationFile> calibration() const override { return calibration_; }
  std::string description() const override { return description_; }

 private:
  std::optional<io::CalibrationFile> calibration_;
  std::string description_;
};

/// The calibration of a recording, readable without the source: the file as it is, or what several say together.
std::string recorded_calibration(const std::vector<std::string>& files, const io::FrameSource& source,
                                 const std::optional<io::CalibrationFile>& own) {
  const std::string file = files.size() == 1 ? files[0] : files.empty() ? source.calibration_file() : std::string();
  if (!file.empty()) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const auto both = files.empty() ? own : io::read_calibration(files[0], files[1]);
  if (!both) return {};
  return both->rectified ? plain_yaml(*both->rectified) : opencv_yaml(both->rig.value());
}

}  // namespace

LiveSession::LiveSession(const LiveOptions& options, SourceOpener opener) : board_(options.max_age_s) {
  std::unique_ptr<io::FrameSource> source = opener();
  description_ = source->description();
  std::optional<io::CalibrationFile> own;
  if (options.calibration.empty()) own = source->calibration();
  auto rectifier = std::make_unique<RectifiedSource>(std::make_unique<CalibrationOnly>(own, source->description()),
                                                     options.calibration, options.processing.pipeline.threads);
  processing_ = std::make_unique<Processing>(options.processing, std::move(rectifier), board_, captured_);
  if (!options.record.empty()) {
    const auto folder =
        std::make_shared<RecordingFolder>(options.record, recorded_calibration(options.calibration, *source, own));
    recorder_ = std::make_unique<Recorder>([folder](const RecordedPair& pair) { folder->write(pair); }, board_);
  }
  capture_ = std::make_unique<Capture>(std::move(source), std::move(opener), options.capture, board_, captured_,
                                       recorder_.get());
}

void LiveSession::start() {
  try {
    start_threads();
  } catch (...) {  // the system may refuse a thread: what the others wait for ends
    captured_.close();
    if (!matching_.joinable()) processing_->match();
    if (!finishing_.joinable()) processing_->finish();
    for (std::thread* const thread : {&matching_, &finishing_, &following_}) {
      if (thread->joinable()) thread->join();
    }
    throw;
  }
}

void LiveSession::start_threads() {
  const auto set_finished = [this] { finished_ = true; };
  following_ = std::thread([=, this] {
    lower_priority();
    failure_.run([this] { processing_->follow(); }, set_finished);
  });
  finishing_ = std::thread([=, this] { failure_.run([this] { processing_->finish(); }, set_finished); });
  matching_ = std::thread([=, this] { failure_.run([this] { processing_->match(); }, set_finished); });
  capturing_ = std::jthread([=, this](const std::stop_token& stop) {
    failure_.run([&] { capture_->run(stop); }, set_finished);
    captured_.close();
    finished_ = true;
  });
}

/// Stops the threads in the order of the data flow, so that pairs already read are finished.
void LiveSession::stop() {
  if (!capturing_.joinable()) return;
  capturing_.request_stop();
  capturing_.join();
  matching_.join();
  finishing_.join();
  following_.join();
  recorder_.reset();
}

void LiveSession::end() {
  stop();
  try {
    failure_.rethrow();
  } catch (const std::exception& error) {
    board_.end(error.what());
    throw;
  }
  board_.end();
}

LiveSession::~LiveSession() {
  stop();
}

}  // namespace roadstereo::cli
