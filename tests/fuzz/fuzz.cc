// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <variant>

#include "env/level.h"
#include "env/slice.h"
#include "io/glb/glb_read.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"

namespace ispace::fuzz {

namespace {

/// Scenes of more records or numbers are left out, and all but one in this many of the others.
constexpr std::size_t kMaxRecords = 12, kMaxNumbers = 200, kEvery = 16;

/// The largest number of a value that is one, or a tuple of them (pixels), else 0.
double largest(const Value& value) {
    if (const auto* const number = std::get_if<double>(&value)) return *number;
    const auto* const tuple = std::get_if<Tuple>(&value);
    return tuple == nullptr || tuple->empty() ? 0 : *std::max_element(tuple->begin(), tuple->end());
}

/// Numbers of all lists, which create vertices and repetitions.
std::size_t numbersOf(const Record& record) {
    std::size_t count = 0;
    for (const KeySpec& key : record.schema().keys) {
        if (!record.has(key.name)) continue;
        const Value* const value = record.find(key.name);
        if (const auto* list = std::get_if<TupleList>(value)) count += list->size();
        // Counts and sizes up to a hundred: ten thousand boxes find no more defects than fifty.
        if (key.whole && largest(*value) > 100) count += kMaxNumbers + 1;
    }
    return count;
}

bool isSmallScene(const Document& document) {
    if (document.records.size() > kMaxRecords) return false;
    std::size_t numbers = 0;
    for (const Record& record : document.records) numbers += numbersOf(record);
    return numbers <= kMaxNumbers;
}

/// FNV-1a
std::uint64_t hashOf(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

}  // namespace

bool isSmall(const Record& record) { return numbersOf(record) <= kMaxNumbers; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        tryInput({reinterpret_cast<const char*>(data), size});
    } catch (const FormatError&) {
        // The input is refused.
    }
    return 0;
}

void require(bool condition, const char* message) {
    if (condition) return;
    std::fprintf(stderr, "fuzz: %s\n", message);
    std::abort();
}

void tryPlan(PlanReader read, std::string_view bytes, const std::string& name,
             const ImportOptions& options) {
    const Document document = read(bytes, name, options, sceneSchemas());
    checkText(document);
    tryScene(document, bytes);
}

ImportOptions drawingOptions() {
    ImportOptions options;
    options.units = "m";
    options.door_layers = {"D*"};
    options.window_layers = {"*WIN*"};
    options.max_work.max = 2000;
    return options;
}

void checkText(const Document& document) {
    const std::string text = writeRecordText(document);
    const Document again = readBack([&] { return readRecordText(text, "again", sceneSchemas()); });
    require(again.kind == document.kind, "another kind after writing and reading");
    require(again.records == document.records, "other records after writing and reading");
    require(writeRecordText(again) == text, "another text after writing and reading");
}

void tryScene(const Document& document, std::string_view bytes) {
    if (hashOf(bytes) % kEvery != 0 || !isSmallScene(document)) return;
    const Scene scene = makeScene(document, nullptr, DeviceCatalogue());
    const Environment& room = scene.environment;
    require(room.indoor().area() > 0, "an indoor region without area");
    (void)room.level(kScanHeight)->freeFloor();
    (void)room.band(0, room.height());
    const Document compiled = readGlb(writeGlb(scene, document), "scene.glb", sceneSchemas());
    require(compiled.records == document.records, "other records in the compiled file");
}

void writeFile(const std::string& path, std::string_view bytes) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    require(file != nullptr, "no file in the scratch folder");
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    require(std::fclose(file) == 0 && whole, "the scratch folder is full");
}

std::vector<std::string_view> filesOf(std::string_view bytes) {
    std::vector<std::string_view> files;
    for (;;) {
        const std::size_t end = bytes.find(kSeparator);
        files.push_back(bytes.substr(0, end));
        if (end == std::string_view::npos) return files;
        bytes.remove_prefix(end + kSeparator.size());
    }
}

std::size_t takePieceSize(std::string_view& bytes) {
    if (bytes.empty()) return 1;
    const std::size_t size = 1 + static_cast<unsigned char>(bytes.front()) % 32;
    bytes.remove_prefix(1);
    return size;
}

std::function<bool(std::string& buffer)> streamOf(std::string_view bytes, std::size_t piece) {
    return [bytes, piece](std::string& buffer) mutable {
        buffer += bytes.substr(0, piece);
        const bool has_more = !bytes.empty();
        bytes.remove_prefix(std::min(piece, bytes.size()));
        return has_more;
    };
}

const std::string& scratchFolder() {
    struct Folder {
        std::string name;
        Folder() {
            const bool in_memory = std::filesystem::is_directory("/dev/shm");
            name = in_memory ? "/dev/shm" : std::filesystem::temp_directory_path().string();
            name += "/ispace-fuzz-XXXXXX";
            require(mkdtemp(name.data()) != nullptr, "no scratch folder");
        }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(name, ignored);
        }
    };
    static const Folder folder;
    return folder.name;
}

}  // namespace ispace::fuzz
