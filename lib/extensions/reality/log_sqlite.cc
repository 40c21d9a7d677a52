// SPDX-License-Identifier: GPL-3.0-or-later
// rosbag2's storage in SQLite, the default of ROS 2 Humble.
#include <sqlite3.h>

#include <memory>

#include "base/file.h"
#include "extensions/reality/log_parts.h"

namespace ispace::reality {

namespace {

struct SqliteClose {
    void operator()(sqlite3* base) const { sqlite3_close(base); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// Reads the tables `topics` and `messages`.
class SqliteBag {
  public:
    explicit SqliteBag(const std::string& file) : file_(file) {
        static_cast<void>(openRegular(file));  // and no folder, pipe or missing file
        sqlite3* base = nullptr;
        const int status = sqlite3_open_v2(file.c_str(), &base, SQLITE_OPEN_READONLY, nullptr);
        base_.reset(base);
        if (status != SQLITE_OK) fail();
        // A stranger's schema runs no functions, and a damaged one is an error.
        sqlite3_db_config(base, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        sqlite3_db_config(base, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        sqlite3_db_config(base, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
        sqlite3_db_config(base, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
        constexpr int kMostBytes = 1 << 30;
        sqlite3_limit(base, SQLITE_LIMIT_LENGTH, kMostBytes);
    }

    void read(RosLogBuilder& builder) {
        const auto rows = prepare(
            "SELECT topics.name, topics.type, topics.serialization_format, messages.data, "
            "messages.id FROM messages JOIN topics ON topics.id = messages.topic_id "
            "ORDER BY messages.timestamp, messages.id");
        for (int status = sqlite3_step(rows.get()); status != SQLITE_DONE;
             status = sqlite3_step(rows.get())) {
            if (status != SQLITE_ROW) fail();
            const std::string_view topic = text(rows.get(), 0), type = text(rows.get(), 1);
            if (!builder.reads(type) || text(rows.get(), 2) != "cdr") continue;
            constexpr int kData = 3, kId = 4;
            builder.add(topic, type, text(rows.get(), kData), file_,
                        "message " + std::to_string(sqlite3_column_int64(rows.get(), kId)));
        }
    }

  private:
    std::unique_ptr<sqlite3_stmt, SqliteClose> prepare(const char* query) {
        sqlite3_stmt* statement = nullptr;
        const int status = sqlite3_prepare_v2(base_.get(), query, -1, &statement, nullptr);
        std::unique_ptr<sqlite3_stmt, SqliteClose> owner(statement);
        if (status != SQLITE_OK) fail();
        return owner;
    }
    static std::string_view text(sqlite3_stmt* row, int column) {
        const auto* const bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
        if (bytes == nullptr) return {};
        return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
    }
    [[noreturn]] void fail() const {
        throw FormatError(
            {displayName(file_), 0, 0,
             std::string("no bag of ROS 2 in SQLite: ") + sqlite3_errmsg(base_.get())});
    }

    const std::string& file_;
    std::unique_ptr<sqlite3, SqliteClose> base_;
};

}  // namespace

void addSqliteBag(const std::string& file, RosLogBuilder& builder) {
    SqliteBag(file).read(builder);
}

}  // namespace ispace::reality
