#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/file_bytes.hpp"
#include "io/source/decompress.hpp"
#include "io/source/message_log.hpp"
#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

/// An empty file for a decompressed copy, removed with its owner.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = (fs::temp_directory_path() / "roadstereo-bag-XXXXXX").string();
    const int file = ::mkstemp(name.data());
    if (file < 0) throw SystemError("cannot write a file in " + fs::temp_directory_path().string());
    ::close(file);
    path_ = name;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The files of a bag, one after the other.
class Rosbag2Folder final : public MessageLog {
 public:
  explicit Rosbag2Folder(const std::string& folder) : folder_(folder) {
    const std::string path = (fs::path(folder) / "metadata.yaml").string();
    constexpr std::size_t max_bytes = std::size_t{1} << 24U;
    const std::vector<std::uint8_t> bytes = read_file(path, max_bytes);
    read_metadata({path, std::string(bytes.begin(), bytes.end())});
  }

  std::string kind() const override { return "ROS 2 bag"; }
  const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    selected_ = topics;
    next_file_ = 0;
    log_.reset();
  }

  std::optional<LoggedMessage> next() override {
    while (true) {
      if (log_) {
        if (std::optional<LoggedMessage> message = log_->next()) return unpacked(*std::move(message));
        log_.reset();
      }
      if (next_file_ == files_.size()) return std::nullopt;
      open(files_[next_file_++]);
    }
  }

 private:
  void read_metadata(const CalibrationText& file) {
    const YAML::Node bag = load_yaml(file)["rosbag2_bagfile_information"];
    if (!bag || !bag.IsMap()) fail(file.path, ": there is no rosbag2_bagfile_information");
    try {
      for (const YAML::Node& name : bag["relative_file_paths"]) {
        files_.push_back((fs::path(folder_) / fs::path(name.as<std::string>()).filename()).string());
      }
      for (const YAML::Node& entry : bag["topics_with_message_count"]) add_topic(entry);
      const std::string format = bag["compression_format"].as<std::string>("");
      const std::string mode = bag["compression_mode"].as<std::string>("");
      if (!format.empty() && format != "zstd") fail(file.path, ": the compression is ", format, "; it must be zstd");
      packed_files_ = mode == "FILE" || mode == "file";
      packed_messages_ = mode == "MESSAGE" || mode == "message";
    } catch (const YAML::Exception& error) {
      fail(file.path, ": ", error.what());
    }
    if (files_.empty()) fail(file.path, ": relative_file_paths lists no file");
  }

  void add_topic(const YAML::Node& entry) {
    const YAML::Node topic = entry["topic_metadata"];
    if (topic["serialization_format"].as<std::string>("cdr") != "cdr") return;
    topics_.push_back({topic["name"].as<std::string>(), ros1_type(topic["type"].as<std::string>()), MessageFormat::cdr,
                       entry["message_count"].as<std::int64_t>(0)});
  }

  void open(const std::string& file) {
    if (!fs::is_regular_file(file)) fail(file, ": the file does not exist, or is not a regular file");
    if (packed_files_ && file != unpacked_file_) {
      unpacked_ = std::make_unique<TemporaryFile>();
      decompress_zstd_file(file, unpacked_->path());
      unpacked_file_ = file;
    }
    try {
      log_ = open_message_log(unpacked_ ? unpacked_->path() : file);
      log_->select(selected_);
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      if (!unpacked_) throw;
      fail(file, ", decompressed as ", error.what());
    }
  }

  LoggedMessage unpacked(LoggedMessage message) const {
    if (!packed_messages_ || !message.error.empty()) return message;
    try {
      message.bytes = decompress_zstd(folder_ + ": " + message.topic, message.bytes);
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      message.error = error.what();
    }
    return message;
  }

  std::string folder_;
  std::vector<std::string> files_;
  bool packed_files_ = false;
  bool packed_messages_ = false;
  std::vector<BagTopic> topics_;
  std::vector<std::string> selected_;
  std::size_t next_file_ = 0;
  std::string unpacked_file_;
  std::unique_ptr<TemporaryFile> unpacked_;  // of that file; outlives the log
  std::unique_ptr<MessageLog> log_;
};

}  // namespace

std::unique_ptr<MessageLog> open_rosbag2_folder(const std::string& path) {
  return std::make_unique<Rosbag2Folder>(path);
}

}  // namespace roadstereo::io
