// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses storeys by words: ids, names, globs, in any case if none fits as written. The rest of a
// building is made anew by makeBuilding(), so that its indices, order and checks are those of a
// file without the others.
#include "site/chosen_storeys.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "io/plan/layer_names.h"
#include "record/text.h"
#include "site/building_imports.h"
#include "site/site_scene.h"

namespace ispace {

namespace {

/// Returns the storeys that a word fits: exactly, else in any case. \throws UsageError for none
std::vector<std::size_t> storeysCalled(const StoreyedDocument& building, const std::string& word) {
    const auto matching = [&](const auto& fold) {
        const Glob wanted(StoreyChoice::isAll(word) ? "*" : fold(word));
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < building.storeys.size(); ++i) {
            const Storey& storey = building.storeys[i];
            if (wanted.matches(fold(storey.id)) ||
                (storey.record.has("name") && wanted.matches(fold(storey.record.text("name")))))
                found.push_back(i);
        }
        return found;
    };
    std::vector<std::size_t> found = matching([](const std::string& text) { return text; });
    if (found.empty()) found = matching([](const std::string& text) { return lowerCased(text); });
    if (found.empty()) static_cast<void>(building.storey(word));  // throws
    return found;
}

std::vector<BuildingImporter>& addedImporters() {
    static std::vector<BuildingImporter> importers;
    return importers;
}

}  // namespace

void addBuildingImporters(std::span<const BuildingImporter> importers) {
    addedImporters().insert(addedImporters().end(), importers.begin(), importers.end());
}

const BuildingImporter* buildingImporter(std::string_view bytes) {
    const std::vector<BuildingImporter>& importers = addedImporters();
    const auto found = std::find_if(importers.begin(), importers.end(),
                                    [bytes](const auto& row) { return row.recognises(bytes); });
    return found == importers.end() ? nullptr : &*found;
}

StoreyedDocument chosenStoreys(StoreyedDocument building, const StoreyChoice& choice,
                               const std::string& operand) {
    std::vector<bool> is_chosen(building.storeys.size(), choice.isEmpty());
    for (const std::string& word : choice.words)
        for (const std::size_t storey : storeysCalled(building, word)) is_chosen[storey] = true;
    if (std::find(is_chosen.begin(), is_chosen.end(), false) == is_chosen.end()) return building;
    std::vector<StoreyInput> inputs;
    std::string others;
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        Storey& storey = building.storeys[i];
        if (!is_chosen[i]) {
            others.append(others.empty() ? "" : ", ").append(storey.id);
            continue;
        }
        inputs.push_back({std::move(storey.record), std::move(storey.room)});
    }
    std::vector<Record> passages;
    for (StoreyPassage& passage : building.passages) {
        std::string left;
        std::size_t count = 0;
        for (const std::size_t storey : passage.storeys) {
            if (!is_chosen[storey]) continue;
            left.append(left.empty() ? "" : ",").append(building.storeys[storey].id);
            ++count;
        }
        if (count < 2) continue;
        if (count < passage.storeys.size()) passage.record.set("storeys", left);
        passages.push_back(std::move(passage.record));
    }
    StoreyedDocument chosen = makeBuilding(std::move(inputs), std::move(passages), operand);
    chosen.history = std::move(building.history);
    chosen.sources = std::move(building.sources);
    chosen.notes.push_back("left out by --storey: " + others);
    return chosen;
}

bool mayHoldStoreys(std::string_view bytes, const StoreyChoice& choice) {
    if (choice.isOne()) return false;
    if (isBuilding(bytes)) return true;
    const BuildingImporter* const importer = buildingImporter(bytes);
    return importer != nullptr && (!choice.isEmpty() || importer->may_have_storeys(bytes));
}

std::optional<StoreyedDocument> readStoreys(std::string_view bytes, const std::string& operand,
                                            const ImportOptions& options,
                                            const StoreyChoice& choice) {
    const BuildingImporter* const importer = buildingImporter(bytes);
    if (importer == nullptr) return readBuilding(bytes, operand, options);
    ImportReport report;
    ImportOptions own = options;
    own.report = &report;
    StoreyedDocument building = importer->read(bytes, operand, own);
    if (choice.isEmpty() && building.storeys.size() == 1) return std::nullopt;
    if (!choice.isEmpty()) {  // the user knows the storeys
        for (const Diagnostic& told : report.choices) building.notes.push_back(told.message);
        report.choices.clear();
    }
    if (options.report != nullptr) options.report->add(std::move(report));
    return building;
}

Document layoutOfStoreys(Document layout, const StoreyedDocument& whole,
                         const StoreyedDocument& chosen, std::vector<Diagnostic>& told) {
    if (whole.storeys.size() == chosen.storeys.size()) return layout;
    const auto is_of = [](const StoreyedDocument& building, const std::string& id) {
        return std::any_of(building.storeys.begin(), building.storeys.end(),
                           [&](const Storey& storey) { return id.starts_with(storey.id + '/'); });
    };
    const std::size_t left_out = std::erase_if(layout.records, [&](const Record& record) {
        if (record.schema().type == RecordType::Meta) return false;
        const std::string id = record.writtenId();
        return is_of(whole, id) && !is_of(chosen, id);
    });
    if (left_out > 0) {
        Diagnostic note;
        note.message = std::to_string(left_out) +
                       (left_out == 1 ? " record of another storey is left out of the layout"
                                      : " records of other storeys are left out of the layout");
        note.severity = Severity::Note;
        told.push_back(std::move(note));
    }
    for (Record& record : layout.records)
        if (record.keyword() == "environment" && record.has("digest") &&
            record.text("digest") == whole.digest())
            record.set("digest", chosen.digest());
    return layout;
}

}  // namespace ispace
