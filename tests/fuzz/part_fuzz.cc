// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of shared jobs and checkpoints: whole files, or a header and records, with lines `---`
// between, which get their hashes here. A record begins with a line of its name. A part of arrange
// holds a command line, which its merge parses.
#include <algorithm>

#include "arrange/batch.h"
#include "base/part_file.h"
#include "cli/run_tool.h"
#include "fuzz.h"

namespace {

using namespace ispace;

constexpr std::string_view kMagic = "#part 1\n";

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
void checkHead(const PartFile& part, const std::string& path) {
    const std::string head = partHeadText(part.head());
    fuzz::writeFile(path, head);
    const PartFile again = fuzz::readBack([&] { return PartFile(path); });
    fuzz::require(partHeadText(again.head()) == head, "another header after writing it");
}

void checkRecords(const std::string& path) {
    PartFile part(path);
    part.dropDamaged();
    for (std::size_t i = 0; i < part.records(); ++i)
        fuzz::require(part.bytes(i).size() <= part.end(), "a record longer than its file");
    fuzz::require(part.liveBytes() <= part.end(), "more live bytes than the file has");
}

void tryMerge(const std::string& path) {
    const std::vector<PartFile> parts = openParts(std::vector{path}, "arrange");
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
    const std::string path = scratchFolder() + "/a.part";
    writeFile(path, fileOf(bytes));
    checkHead(PartFile(path), scratchFolder() + "/head.part");
    checkRecords(path);
    tryMerge(path);
}
