// SPDX-License-Identifier: GPL-3.0-or-later
// A room is kept with the identity, size and time of all files that it was read from; it is current
// while these are unchanged. A file that changes within the clock's resolution, at the same size,
// would be missed. Rooms that looked for a missing file are not kept, as it may appear.
#include "cli/kept_rooms.h"

#include <sys/stat.h>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/missed_files.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "io/glb/glb_read.h"
#include "scene/placement_schemas.h"
#include "site/chosen_storeys.h"

namespace ispace {

namespace {

/// Of a file: another one has another identity or time.
using Stamp = std::tuple<dev_t, ino_t, off_t, std::int64_t, std::int64_t>;

std::optional<Stamp> stampOf(const std::string& file) {
    struct stat info = {};
    if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
    return Stamp(info.st_dev, info.st_ino, info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
}

/// A room that is kept, or a file that is not to be kept.
struct Entry {
    explicit Entry(std::string name) : file(std::move(name)) {}

    const std::string file;
    std::mutex mutex = {};  // of all below
    bool is_read = false;
    std::vector<std::pair<std::string, Stamp>> stamps = {};
    std::shared_ptr<const KeptRoom> room = nullptr;

    [[nodiscard]] bool isCurrent() const {
        return std::all_of(stamps.begin(), stamps.end(),
                           [](const auto& made) { return stampOf(made.first) == made.second; });
    }
};

/// The last entries, the one used last first. Thread-safe.
class Entries {
  public:
    /// \param make whether a missing entry is made; else it is null
    std::shared_ptr<Entry> find(const std::string& file, bool make) {
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(entries_.begin(), entries_.end(),
                                        [&](const auto& entry) { return entry->file == file; });
        if (found != entries_.end()) {
            std::rotate(entries_.begin(), found, found + 1);
        } else if (make) {
            if (entries_.size() == kMostKeptRooms) entries_.pop_back();
            entries_.insert(entries_.begin(), std::make_shared<Entry>(file));
        } else {
            return nullptr;
        }
        return entries_.front();
    }

  private:
    std::mutex mutex_;
    std::vector<std::shared_ptr<Entry>> entries_;
};

Entries& entries() {
    static Entries entries;
    return entries;
}

std::optional<KeptRoom> roomIn(const std::string& file) {
    ImportReport report;
    ImportOptions import;
    import.report = &report;
    std::optional<Document> document = readGlbFile(file, sceneSchemas());
    if (document) {
        loadFiles(*document, file, import);
    } else {
        const std::string bytes = readAll(file, InputKind::Regular);
        if (mayHoldStoreys(bytes, {})) return std::nullopt;
        document = parseDocument(bytes, file, import, sceneSchemas());
    }
    if (document->kind != DocumentKind::Environment || report.has_storeys) return std::nullopt;
    Scene scene = makeScene(*document, nullptr, devicesFor({&*document, nullptr}));
    return KeptRoom{*std::move(document), std::move(report), std::move(scene)};
}

/// Reads the room of an entry. \pre its mutex is held
void readRoom(Entry& entry) {
    entry.room = nullptr;
    entry.stamps.clear();
    const auto stamp = stampOf(entry.file);
    if (!stamp) return;
    entry.stamps.emplace_back(entry.file, *stamp);
    try {
        const MissedFiles missed;
        std::optional<KeptRoom> room = roomIn(entry.file);
        // One that appears later may belong to the room.
        if (!room || !missed.names().empty()) return;
        for (const std::string& source : room->document.sources) {
            const auto made = stampOf(source);
            if (!made) return;
            entry.stamps.emplace_back(source, *made);
        }
        entry.room = std::make_shared<const KeptRoom>(*std::move(room));
    } catch (const std::exception&) {
        entry.room = nullptr;  // the job reports it
    }
}

void keepRoom(const std::string& file) {
    if (!stampOf(file)) return;
    const std::shared_ptr<Entry> entry = entries().find(file, true);
    const std::lock_guard lock(entry->mutex);
    if (entry->is_read && entry->isCurrent()) return;
    readRoom(*entry);
    entry->is_read = true;
}

}  // namespace

void keepRooms(std::span<const std::string> operands) {
    for (const std::string& file : operands)
        if (!file.empty() && file.front() != '-' && !file.ends_with(".3dm")) keepRoom(file);
}

std::shared_ptr<const KeptRoom> keptRoom(const std::string& file, const SceneRules& rules) {
    if (rules.includes != IncludeFiles::InFolder || rules.max_work || !rules.storeys.isEmpty())
        return nullptr;
    const std::shared_ptr<Entry> entry = entries().find(file, false);
    if (entry == nullptr) return nullptr;
    const std::lock_guard lock(entry->mutex);
    if (!entry->room || !entry->isCurrent()) return nullptr;
    for (const auto& [source, stamp] : entry->stamps) noteInput(source);
    return entry->room;
}

}  // namespace ispace
