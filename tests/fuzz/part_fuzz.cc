// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of shared jobs and kept results: whole files, or a header and records, with lines `---`
// between, which get their hashes here. A record begins with a line of its name. A part of arrange
// holds a command line, which its merge parses.
#include <algorithm>

#include "arrange/arrange_batch.h"
#include "base/part_file.h"
#include "cli/run_tool.h"
#include "fuzz.h"

namespace {

using namespace ispace;

constexpr std::string_view kMagic = "#part 2\n";

std::string fileOf(std::string_view bytes) {
    if (bytes.starts_with(kMagic)) return std::string(bytes);
    const std::vector<std::string_view> pieces = fuzz::filesOf(bytes);
    std::string file = std::string(kMagic) + std::string(pieces.front()) + "\n\n";
    for (const std::string_view piece : std::span(pieces).subspan(1)) {
        const std::size_t end = std::min(piece.find('\n'), piece.size());
        file += partRecordText(piece.substr(0, end), piece.substr(std::min(end + 1, piece.size())));
    }
    return file;
}

/// The header as the tools write it, and as they read that.
void checkHead(const PartHead& part, const std::string& path) {
    const std::string head = partHeadText(part);
    fuzz::writeFile(path, head);
    const PartHead again = fuzz::readBack([&] { return partHeadOf(path); });
    fuzz::require(partHeadText(again) == head, "another header after writing it");
}

/// Kept results, to which others are added; a part of them has all.
void checkRecords(const std::string& bytes, const PartHead& head, const std::string& path) {
    fuzz::writeFile(JobResults::keptFile(path, head.shard), bytes);
    JobResults results(path, head.job, head.shard, true);
    results.store("added", "bytes");
    results.writePart(path);
    for (const std::string& key : results.keys())
        fuzz::require(results.find(key)->size() <= bytes.size() + 5,
                      "a record longer than its file");
    fuzz::require(isPartOf(path, head), "a part that is not read again");
    results.finish();
}

void tryMerge(const std::string& path) {
    const JobResults parts = mergeParts(std::vector{path}, "arrange", kCommandKey, false);
    try {
        (void)commandOf(parts, {});
    } catch (const UsageError&) {
        // The command is not one of arrange.
    } catch (const TextRequested&) {
        // It asks for help.
    }
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::string path = scratchFolder() + "/a.part", file = fileOf(bytes);
    writeFile(path, file);
    const PartHead head = partHeadOf(path);
    checkHead(head, scratchFolder() + "/head.part");
    checkRecords(file, head, scratchFolder() + "/kept.part");
    tryMerge(path);
}
