// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/inputs.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/file.h"
#include "cli/command_line.h"
#include "cli/operands.h"
#include "env/walls.h"
#include "io/input.h"
#include "layout/scene.h"
#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

bool isBlank(std::string_view bytes) {
    return bytes.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

std::string folderOf(const std::string& operand) {
    return isStream(operand) ? "" : fs::path(operand).parent_path().string();
}

/// Points that are given win over those of records.
void setInside(std::span<const Point2> points, std::vector<Document>& documents) {
    for (Document& document : documents)
        std::erase_if(document.records,
                      [](const Record& record) { return record.keyword() == "inside"; });
    for (const Point2 p : points) {
        Record record(*sceneSchemas().find("inside"));
        record.set("at", Tuple{p.x, p.y});
        documents.front().records.push_back(std::move(record));
    }
}

/// The bytes of an input; an empty stdin may stand for no records.
struct RawInput {
    std::string name, bytes;
    bool is_plan = false;
};

RawInput readRaw(const std::string& input, const ImportOptions& import) {
    RawInput raw{input, input == "-" ? readStdin() : readAll(input)};
    raw.is_plan = isPlan(raw.bytes, input, import, sceneSchemas());
    return raw;
}

Document parseInput(const RawInput& raw, const InputRequest& request, const ImportOptions& import) {
    if (raw.name == "-" && request.may_be_empty && isBlank(raw.bytes)) return {};
    Document document = parseDocument(raw.bytes, raw.name, import, sceneSchemas());
    checkIds(document.records);
    rebaseFiles(document.records, folderOf(raw.name), "");
    return document;
}

/// What an importer has to know of records that others bring: their walls close its gaps, their
/// inside points choose its rooms.
void addKnown(std::span<const Record> records, ImportOptions& import) {
    Diagnostics ignored;  // said where the environment is built
    for (const Record& record : records) {
        if (record.keyword() == "inside" && record.has("at")) {
            const Tuple& at = record.tuple("at");
            import.known_inside.push_back({at[0], at[1]});
        } else if (isWall(record)) {
            for (const WallLine& wall : wallLinesOf(record, ignored))
                import.known_walls.push_back(wall.line);
        }
    }
}

/// All inputs in their order; plans are read last, as they need to know what the others say.
std::vector<Document> parseInputs(const InputRequest& request) {
    std::vector<RawInput> raw;
    for (const std::string& input : request.inputs) raw.push_back(readRaw(input, request.import));
    std::vector<Document> documents(raw.size());
    ImportOptions import = request.import;
    addKnown(request.added, import);
    for (const bool plans : {false, true})
        for (std::size_t i = 0; i < raw.size(); ++i) {
            if (raw[i].is_plan != plans) continue;
            documents[i] = parseInput(raw[i], request, import);
            if (!plans) addKnown(documents[i].records, import);
        }
    const bool any_plan =
        std::any_of(raw.begin(), raw.end(), [](const RawInput& input) { return input.is_plan; });
    if (!any_plan && !import.inside.empty()) setInside(import.inside, documents);
    return documents;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Layouts alone: the first that names its environment brings it along.
void addEnvironment(std::vector<Document>& documents, const InputRequest& request) {
    for (const Document& document : documents)
        if (document.kind == DocumentKind::Environment) return;
    for (const Document& document : documents) {
        const auto reference = environmentReference(document);
        if (!reference || reference->file.empty()) continue;
        // Names are relative to the current folder by now.
        const RawInput raw{reference->file, bytesReferenced(*reference, reference->file)};
        Document environment = parseInput(raw, request, request.import);
        if (environment.kind != DocumentKind::Environment)
            throw FormatError(reference->record.finding(
                "file", reference->file + " is a layout, not an environment"));
        environment.sources.insert(environment.sources.begin(), reference->file);
        documents.push_back(std::move(environment));
        return;
    }
}

}  // namespace

void rebaseFiles(std::vector<Record>& records, const std::string& from, const std::string& to) {
    if (fs::path(from).lexically_normal() == fs::path(to).lexically_normal()) return;
    const auto canonical = [](const std::string& folder) {
        return fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder));
    };
    const fs::path old_base = canonical(from), new_base = canonical(to);
    if (old_base == new_base) return;
    for (Record& record : records)
        for (const KeySpec& key : record.schema().keys) {
            if (key.role != Role::File || !record.has(key.name)) continue;
            const std::string& name = record.text(key.name);
            if (fs::path(name).is_absolute() || name.empty()) continue;
            record.set(key.name,
                       (old_base / name).lexically_normal().lexically_relative(new_base).string(),
                       record.keyPlace(key.name));
        }
}

Document readInputs(const InputRequest& request) {
    std::vector<Document> documents = parseInputs(request);
    if (request.compiles) addEnvironment(documents, request);
    std::stable_sort(documents.begin(), documents.end(), [](const Document& a, const Document& b) {
        return a.kind == DocumentKind::Environment && b.kind == DocumentKind::Layout;
    });
    Document joined;
    joined.kind = documents.front().kind;
    std::vector<Record> environment;  // before layouts are applied
    for (Document& document : documents) {
        append(joined.history, document.history);
        append(joined.notes, document.notes);
        append(joined.warnings, document.warnings);
        append(joined.sources, document.sources);
        if (document.kind == DocumentKind::Layout) {
            if (request.compiles && !environment.empty() && !request.any_environment)
                checkDigest(document, environment, "the environment given");
            joined.records = joinRecords(joined.records, document.records);
        } else {
            append(joined.records, document.records);
            environment = joined.records;
        }
    }
    checkIds(joined.records);
    return joined;
}

}  // namespace ispace
