#include <sqlite3.h>

#include <map>

#include "io/source/decompress.hpp"
#include "io/source/message_log.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// A prepared statement.
class Statement {
 public:
  Statement(sqlite3* database, const std::string& file, const std::string& text) : database_(database), file_(file) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(database, text.c_str(), -1, &made, nullptr) != SQLITE_OK) fail_reading();
    made_.reset(made);
  }

  /// Returns whether there is another row.
  bool step() {
    const int result = sqlite3_step(made_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail_reading();
    return result == SQLITE_ROW;
  }
  std::int64_t whole(int column) const { return sqlite3_column_int64(made_.get(), column); }
  std::string text(int column) const {
    const auto* letters = reinterpret_cast<const char*>(sqlite3_column_text(made_.get(), column));
    return letters == nullptr ? "" : letters;
  }
  std::vector<std::uint8_t> bytes(int column) const {
    const auto* first = static_cast<const std::uint8_t*>(sqlite3_column_blob(made_.get(), column));
    const auto count = static_cast<std::size_t>(sqlite3_column_bytes(made_.get(), column));
    return first == nullptr ? std::vector<std::uint8_t>{} : std::vector<std::uint8_t>(first, first + count);
  }

 private:
  [[noreturn]] void fail_reading() const { fail(file_, ": the bag cannot be read: ", sqlite3_errmsg(database_)); }

  sqlite3* database_;
  std::string file_;
  std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> made_{nullptr, sqlite3_finalize};
};

/// A file of rosbag2's storage sqlite3. Columns are named, since older bags have fewer.
class SqliteLog final : public MessageLog {
 public:
  explicit SqliteLog(const std::string& file) : file_(file), database_(open(file)) {
    Statement topics(database_.get(), file,
                     "SELECT id, name, type, serialization_format, (SELECT COUNT(*) FROM messages WHERE topic_id = "
                     "topics.id) FROM topics ORDER BY id");
    while (topics.step()) {
      if (topics.text(3) != "cdr") continue;
      names_[topics.whole(0)] = topics.text(1);
      topics_.push_back({topics.text(1), ros1_type(topics.text(2)), MessageFormat::cdr, topics.whole(4)});
    }
  }

  std::string kind() const override { return "ROS 2 bag"; }
  const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    std::string ids;
    for (const auto& [id, name] : names_) {
      for (const std::string& topic : topics) {
        if (name == topic) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
      }
    }
    messages_ = std::make_unique<Statement>(
        database_.get(), file_,
        "SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN (" + ids + ") ORDER BY timestamp, id");
  }

  std::optional<LoggedMessage> next() override {
    if (!messages_ || !messages_->step()) {
      messages_.reset();
      return std::nullopt;
    }
    return LoggedMessage{names_[messages_->whole(0)], messages_->whole(1), messages_->bytes(2)};
  }

 private:
  static std::unique_ptr<sqlite3, decltype(&sqlite3_close)> open(const std::string& file) {
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database(opened, sqlite3_close);
    if (result != SQLITE_OK) fail(file, ": the bag cannot be opened: ", sqlite3_errstr(result));
    // The file may come from anywhere: its schema may run nothing.
    sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(max_decompressed_bytes));
    return database;
  }

  std::string file_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database_;
  std::map<std::int64_t, std::string> names_;  // of the topics, by id
  std::vector<BagTopic> topics_;
  std::unique_ptr<Statement> messages_;
};

}  // namespace

std::unique_ptr<MessageLog> open_sqlite_log(const std::string& path) {
  return std::make_unique<SqliteLog>(path);
}

}  // namespace roadstereo::io
