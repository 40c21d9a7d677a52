// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/kept_rooms.h"

#include <sys/stat.h>
#include <tbb/global_control.h>
#include <algorithm>
#include <cstdint>
#include <exception>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/missed_files.h"
#include "base/run_files.h"
#include "building/storeys.h"
#include "cli/common_options.h"
#include "io/glb/glb_read.h"
#include "scene/placement_schemas.h"

namespace ispace {

namespace {

/// Of a file: another one has another identity or time.
using Stamp = std::tuple<dev_t, ino_t, off_t, std::int64_t, std::int64_t>;

std::optional<Stamp> stampOf(const std::string& file) {
    struct stat info = {};
    if (::stat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
    return Stamp(info.st_dev, info.st_ino, info.st_size, info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
}

struct Entry {
    std::string file;
    std::vector<std::pair<std::string, Stamp>> stamps;
    std::optional<KeptRoom> room;  // empty: not to be kept

    [[nodiscard]] bool isCurrent() const {
        return std::all_of(stamps.begin(), stamps.end(),
                           [](const auto& made) { return stampOf(made.first) == made.second; });
    }
};

/// The last one used comes first.
std::vector<Entry>& entries() {
    static std::vector<Entry> entries;
    return entries;
}

std::optional<KeptRoom> roomIn(const std::string& file) {
    ImportReport report;
    ImportOptions import;
    addModelFolders(import);
    import.report = &report;
    std::optional<Document> document = readGlbFile(file, sceneSchemas());
    if (document) {
        loadFiles(*document, file, import);
    } else {
        const std::string bytes = readAll(file, InputKind::Regular);
        if (isBuilding(bytes)) return std::nullopt;
        document = parseDocument(bytes, file, import, sceneSchemas());
    }
    if (document->kind != DocumentKind::Environment || report.has_storeys) return std::nullopt;
    Scene scene = makeScene(*document, nullptr, devicesFor({&*document, nullptr}));
    return KeptRoom{*std::move(document), std::move(report), std::move(scene)};
}

void keepRoom(const std::string& file) {
    std::vector<Entry>& kept = entries();
    const auto found = std::find_if(kept.begin(), kept.end(),
                                    [&](const Entry& entry) { return entry.file == file; });
    if (found != kept.end() && found->isCurrent()) {
        std::rotate(kept.begin(), found, found + 1);
        return;
    }
    if (found != kept.end()) kept.erase(found);
    const auto stamp = stampOf(file);
    if (!stamp) return;
    Entry entry{file, {{file, *stamp}}, std::nullopt};
    try {
        const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
        const MissedFiles missed;
        entry.room = roomIn(file);
        // One that appears later may belong to the room.
        if (!missed.names().empty()) entry.room = std::nullopt;
    } catch (const std::exception&) {
        entry.room = std::nullopt;
    }
    if (entry.room)
        for (const std::string& source : entry.room->document.sources) {
            if (const auto made = stampOf(source))
                entry.stamps.emplace_back(source, *made);
            else
                entry.room.reset();
            if (!entry.room) break;
        }
    if (kept.size() == kMostKeptRooms) kept.pop_back();
    kept.insert(kept.begin(), std::move(entry));
}

}  // namespace

void keepRooms(std::span<const std::string> operands) {
    for (const std::string& file : operands)
        if (!file.empty() && file.front() != '-' && !file.ends_with(".3dm")) keepRoom(file);
}

const KeptRoom* keptRoom(const std::string& file, const SceneRules& rules) {
    if (entries().empty() || rules.includes != IncludeFiles::InFolder || rules.max_work ||
        !rules.storey.empty())
        return nullptr;
    for (const Entry& entry : entries()) {
        if (entry.file != file || !entry.room || !entry.isCurrent()) continue;
        for (const auto& [source, stamp] : entry.stamps) noteInput(source);
        return &*entry.room;
    }
    return nullptr;
}

}  // namespace ispace
