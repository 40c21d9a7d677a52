// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/inputs.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/file.h"
#include "cli/command_line.h"
#include "cli/operands.h"
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

Document readInput(const std::string& input, const InputRequest& request) {
    const std::string bytes = input == "-" ? readStdin() : readAll(input);
    if (input == "-" && request.may_be_empty && isBlank(bytes)) return {};
    Document document = parseDocument(bytes, input, request.import, sceneSchemas());
    checkIds(document.records);
    rebaseFiles(document.records, folderOf(input), "");
    return document;
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
        Document environment = readInput(reference->file, request);
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
    std::vector<Document> documents;
    documents.reserve(request.inputs.size());
    for (const std::string& input : request.inputs) documents.push_back(readInput(input, request));
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
