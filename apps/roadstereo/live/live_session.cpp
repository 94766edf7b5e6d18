#include "live/live_session.hpp"

#include <optional>
#include <utility>

#include "live/recording_folder.hpp"
#include "lower_priority.hpp"
#include "roadstereo/error.hpp"
#include "synth_files.hpp"

namespace roadstereo::cli {
namespace {

/// A source without pairs that keeps the calibration while the real source is reopened.
class CalibrationOnly final : public io::FrameSource {
 public:
  explicit CalibrationOnly(const io::FrameSource& source)
      : calibration_(source.calibration()), description_(source.description()) {}

  std::optional<io::SourcePair> next() override { return std::nullopt; }
  void skip(std::int64_t) override {}
  std::optional<std::int64_t> size() const override { return 0; }
  std::optional<io::CalibrationFile> calibration() const override { return calibration_; }
  std::string description() const override { return description_; }

 private:
  std::optional<io::CalibrationFile> calibration_;
  std::string description_;
};

}  // namespace

LiveSession::LiveSession(const LiveOptions& options, SourceOpener opener) : board_(options.max_age_s) {
  std::unique_ptr<io::FrameSource> source = opener();
  description_ = source->description();
  auto rectifier = std::make_unique<RectifiedSource>(std::make_unique<CalibrationOnly>(*source), options.calibration);
  processing_ = std::make_unique<Processing>(options.processing, std::move(rectifier), board_, captured_);
  if (!options.record.empty()) start_recorder(options, *source);
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

void LiveSession::start_recorder(const LiveOptions& options, const io::FrameSource& source) {
  const auto folder = std::make_shared<RecordingFolder>(options.record, options.calibration);
  const std::optional<io::CalibrationFile> own = source.calibration();
  if (options.calibration.empty() && own && own->rectified) {
    folder->add_calibration("calibration.yaml", plain_yaml(*own->rectified));
  }
  recorder_ = std::make_unique<Recorder>([folder](const RecordedPair& pair) { folder->write(pair); }, board_);
}

/// Stops the threads in the order of the data flow, so that pairs already read are finished.
void LiveSession::join() {
  if (!capturing_.joinable()) return;
  capturing_.request_stop();
  capturing_.join();
  matching_.join();
  finishing_.join();
  following_.join();
  recorder_.reset();
}

void LiveSession::end() {
  join();
  try {
    failure_.rethrow();
  } catch (const std::exception& error) {
    board_.end(error.what());
    throw;
  }
  board_.end();
}

LiveSession::~LiveSession() {
  join();
}

}  // namespace roadstereo::cli
