// SPDX-License-Identifier: GPL-3.0-or-later
// Operands are told apart by content: an environment, a layout, or a building of which the rules
// choose a storey. Order: stdin is read once at most, each operand becomes a document, an
// environment that is not given is that of the layout's record, and the digest that the layout
// names is compared with it. All findings of a file come in one FormatError; a file outside the
// layout's folder is not quoted in messages, as its content may be another user's.
#include "cli/operands.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/kept_rooms.h"
#include "cli/outputs.h"
#include "cli/storey_operands.h"
#include "env/walls.h"
#include "env/zone.h"
#include "io/exporters.h"
#include "io/glb/glb_read.h"
#include "io/importers.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "site/building_imports.h"
#include "site/chosen_storeys.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

ImportOptions defaultImport(const SceneRules& rules, ImportReport* report) {
    ImportOptions options;
    options.includes = rules.includes;
    options.max_work.max = rules.max_work;
    options.storey = rules.storeys.one();
    options.report = report;
    return options;
}

Document parse(std::string_view bytes, const std::string& operand, const SceneRules& rules,
               ImportReport* report = nullptr) {
    return parseDocument(bytes, operand, defaultImport(rules, report), sceneSchemas());
}

Document read(const std::string& operand, const SceneRules& rules, ImportReport* report = nullptr) {
    return operand == "-" ? parse(readStdin(), operand, rules, report)
                          : readDocument(operand, defaultImport(rules, report), sceneSchemas());
}

/// Reads an operand that may be a building, of which it takes the storey of the rules.
/// \param building receives the building
Document readStorey(const std::string& operand, std::string_view bytes, const SceneRules& rules,
                    ImportReport& report, std::optional<StoreyedDocument>& building) {
    const ImportOptions import = defaultImport(rules, &report);
    std::optional<StoreyedDocument> read;
    if (isBuilding(bytes))
        read = readBuilding(bytes, operand, import);
    else if (mayHoldStoreys(bytes, rules.storeys))
        read = readStoreys(bytes, operand, import, rules.storeys);
    if (!read) return parse(bytes, operand, rules, &report);
    building = std::move(read);
    return chosenStorey(*building, operand, rules.storeys.one());
}

/// Returns the whole building of a file that is read as the room of one storey; empty for others.
std::optional<StoreyedDocument> wholeBuilding(std::string_view bytes, const std::string& operand,
                                              const ImportOptions& import) {
    if (buildingImporter(bytes) == nullptr) return std::nullopt;
    ImportReport ignored;
    ImportOptions whole = import;
    whole.storey.clear();
    whole.report = &ignored;
    return readStoreys(bytes, operand, whole, {});
}

bool hasPlaced(const Document& document, bool (*is_meant)(const SensorKind&)) {
    return std::any_of(document.records.begin(), document.records.end(), [&](const Record& r) {
        const SensorKind* const kind = sensorKind(r.keyword());
        return kind != nullptr && is_meant(*kind) &&
               (r.has("at") || r.has("on") || kind->place != nullptr);
    });
}

/// The environment against which layouts are validated.
struct Reference {
    std::span<const Record> records;
    std::string operand;
    bool is_operand = true;  ///< false: a layout's record names it
};

/// Compares the digest that `layout` records with that of `environment`.
/// \throws FormatError if they differ and SceneRules::same_environment requires equality
void checkDigest(const Document& layout, const Reference& environment,
                 std::optional<bool> same_environment, std::vector<Diagnostic>& warnings) {
    if (!same_environment.value_or(true)) return;
    const auto recorded = environmentReference(layout);
    if (!recorded || recorded->digest.empty()) return;
    const std::string digest = environmentDigest(environment.records);
    if (digest == recorded->digest) return;
    const auto shortened = [](const std::string& whole) { return whole.substr(0, 15) + "…"; };
    const std::string file = recorded->file.empty() ? "" : baseName(recorded->file) + ", ";
    Diagnostic finding = recorded->record.finding(
        "digest", "the layout was made for another environment (" + file +
                      shortened(recorded->digest) + ") than " + displayName(environment.operand) +
                      " (" + shortened(digest) +
                      "): arrange again, or accept it with --any-environment");
    if (same_environment || !environment.is_operand) throw FormatError(std::move(finding));
    finding.severity = Severity::Warning;
    warnings.push_back(std::move(finding));
}

/// Reads the environment that a layout names. \param layout the operand \param parse converts its
/// bytes to a document \throws FormatError at the layout's line if it cannot be opened or is no
/// regular file; if `parse` throws, without quoting a file that is neither in the layout's folder
/// nor begins as records do
template <typename Parse>
Document documentReferenced(const EnvironmentReference& reference, const std::string& file,
                            const std::string& layout, const Parse& parse) {
    const auto refuse = [&](const std::string& reason) {
        throw FormatError(
            reference.record.finding("file", "environment " + excerpt(file) + reason));
    };
    std::string bytes;
    try {
        bytes = readAll(file, InputKind::Regular);
    } catch (const std::system_error& error) {
        refuse(" cannot be opened: " + error.code().message() +
               "; names are relative to the folder of the layout: if it was moved, give the "
               "environment, too");
    } catch (const FormatError& error) {
        refuse(": " + error.diagnostics().front().message);
    }
    Document document;
    try {
        document = parse(bytes);
    } catch (const FormatError& error) {
        const std::string folder = layout == "-" ? "." : sideFilePath(layout, ".");
        if (isRecordText(bytes) || liesOpenlyIn(folder, file)) throw;
        Diagnostic finding = error.diagnostics().front();
        finding.message =
            "no environment, and not quoted, as it lies outside the folder of the layout: `envc "
            "--check` says more";
        throw FormatError(std::move(finding));
    }
    if (document.kind != DocumentKind::Environment) refuse(" is a layout, not an environment");
    return document;
}

/// Makes names of textures relative to the current folder, where pictures are drawn.
void rebaseTextures(std::vector<Record>& records, const std::string& operand) {
    constexpr const char* kKey = "texture";
    for (Record& record : records)
        if (record.schema().find(kKey) != nullptr && record.has(kKey))
            record.set(kKey, sideFilePath(operand, record.text(kKey)), record.keyPlace(kKey));
}

/// Finds the operands before they are joined.
class OperandReader {
  public:
    explicit OperandReader(const SceneRequest& request) : request_(request) {}

    SceneInput read() {
        mustReadStdinOnce(request_.operands);
        named_ = request_.operands;
        for (const std::string& operand : request_.operands) take(operand, readOperand(operand));
        if (wantsStdin()) {
            named_.emplace_back("-");
            takeLayoutFromStdin();
        }
        const bool is_operand = environment_.has_value();
        if (!is_operand) findEnvironment();
        if (!request_.is_further && !request_.rules.storeys.isEmpty() && !building_ &&
            !report_.has_storeys)
            throw UsageError("--storey is about buildings, and " +
                             displayName(environment_operand_) + " is one room");
        if (layout_ && namesStoreys(*layout_) && !foreign_building_.empty())
            if (const auto whole = wholeBuilding(foreign_building_, environment_operand_,
                                                 defaultImport(request_.rules, nullptr)))
                layout_ = layoutOfRoom(*layout_, *whole, environment_->records);
        if (layout_ && building_)
            layout_ = layoutOfStorey(*layout_, *building_, request_.rules.storeys.one());
        if (layout_)
            checkDigest(*layout_, {environment_->records, environment_operand_, is_operand},
                        request_.rules.same_environment, environment_->warnings);
        const Document* const layout = layout_ ? &*layout_ : nullptr;
        Scene scene = makeScene(*environment_, layout, devicesFor({&*environment_, layout}),
                                kept_ == nullptr ? nullptr : &kept_->scene);
        return {std::move(scene),
                std::move(*environment_),
                std::move(layout_),
                std::move(environment_operand_),
                std::move(layout_operand_),
                std::move(named_),
                std::move(report_.choices),
                storeyId(),
                storeyName()};
    }

  private:
    [[nodiscard]] std::string storeyId() const {
        std::string called = request_.rules.storeys.one();
        if (!building_) return called;
        return called.empty() ? building_->storeys.front().id : building_->storey(called).id;
    }

    /// Returns the name of the storey; "" without one, or if it calls another.
    [[nodiscard]] std::string storeyName() const {
        if (!building_) return "";
        const Storey& own = building_->storey(storeyId());
        if (!own.record.has("name")) return "";
        std::string name = own.record.text("name");
        return !name.empty() && &building_->storey(name) == &own ? name : "";
    }

    Document readOperand(const std::string& operand) {
        if (const auto kept = keptRoom(operand, request_.rules)) {
            kept_ = kept;
            report_.choices.insert(report_.choices.end(), kept->report.choices.begin(),
                                   kept->report.choices.end());
            return kept->document;
        }
        // A compiled room is read in parts.
        if (operand != "-")
            if (auto room = readGlbFile(operand, sceneSchemas())) {
                loadFiles(*room, operand, defaultImport(request_.rules, &report_));
                return *std::move(room);
            }
        return readBytes(operand, ispace::readOperand(operand));
    }

    Document readBytes(const std::string& operand, std::string bytes) {
        Document document = readStorey(operand, bytes, request_.rules, report_, building_);
        if (buildingImporter(bytes) != nullptr) foreign_building_ = std::move(bytes);
        return document;
    }

    void take(const std::string& operand, Document document) {
        rebaseTextures(document.records, operand);
        if (document.kind == DocumentKind::Layout) {
            if (layout_) throw UsageError("two layouts given, one is wanted: " + operand);
            layout_ = std::move(document);
            layout_operand_ = operand;
        } else {
            if (environment_) throw UsageError("two environments given, one is wanted: " + operand);
            environment_ = std::move(document);
            environment_operand_ = operand;
        }
    }

    [[nodiscard]] bool wantsStdin() const {
        if (layout_) return false;
        if (!environment_ && !request_.layout_from_stdin)
            throw UsageError(
                "no environment given: the first operand is a room, such as room.env, or - for "
                "stdin");
        return request_.layout_from_stdin &&
               !(environment_ && hasPlaced(*environment_, request_.is_meant));
    }

    void takeLayoutFromStdin() {
        if (environment_operand_ == "-")
            throw UsageError("the environment on stdin holds no placed sensor: give a LAYOUT");
        const std::string bytes = readStdin();
        if (bytes.empty())
            throw FormatError({"stdin", 0, 0,
                               "empty, where a layout (`#3dm 1`) is wanted" +
                                   (environment_ ? ": " + displayName(environment_operand_) +
                                                       " holds no placed sensor"
                                                 : "")});
        Document document = parse(bytes, "-", request_.rules);
        if (document.kind != DocumentKind::Layout)
            throw FormatError(
                {"stdin", 0, 0, "an environment, where a layout (`#3dm 1`) is wanted"});
        take("-", std::move(document));
    }

    /// ENV is missing: LAYOUT's `environment file=` names it.
    void findEnvironment() {
        const auto reference = environmentReference(*layout_);
        if (!reference || reference->file.empty())
            throw UsageError(displayName(layout_operand_) +
                             " names no environment (`environment file=…`): give ENV");
        if (reference->file == "-")
            throw FormatError(reference->record.finding("file", "stdin cannot be named here"));
        const fs::path folder =
            layout_operand_ == "-" ? fs::path() : fs::path(layout_operand_).parent_path();
        const std::string operand = (folder / reference->file).string();
        take(operand,
             documentReferenced(*reference, operand, layout_operand_, [&](std::string_view bytes) {
                 return readBytes(operand, std::string(bytes));
             }));
    }

    const SceneRequest& request_;
    std::optional<Document> environment_, layout_;
    std::string environment_operand_, layout_operand_;
    std::vector<std::string> named_;
    ImportReport report_;
    std::optional<StoreyedDocument> building_;   // of which the environment is a storey
    std::string foreign_building_;               // bytes of the environment, see buildingImporter()
    std::shared_ptr<const KeptRoom> kept_ = {};  // the environment, if it was read before
};

}  // namespace

SceneInput readScene(const SceneRequest& request) { return OperandReader(request).read(); }

void warnOfImport(const CommonOptions& options, const std::string& tool, const SceneInput& input) {
    warn(options, tool, input.choices);
    warn(options, tool, input.environment.warnings);
}

std::pair<std::string, double> splitWeight(const std::string& text) {
    const auto equals = text.rfind('=');
    const auto weight =
        equals == std::string::npos ? std::nullopt : parseDouble(text.substr(equals + 1));
    if (!weight || equals == 0 || !(*weight >= 0 && *weight <= 1e6))
        throw UsageError("--weight: `" + text + "` is not ZONE=W with a number from 0 on");
    return {text.substr(0, equals), *weight};
}

void addZones(std::span<const std::string> zones, SceneInput& input) {
    if (zones.empty()) return;
    std::vector<Record> records = input.scene.records;
    for (Record& zone : zoneRecords(zones, input.scene.environment, sceneSchemas()))
        records.push_back(std::move(zone));
    const Document* const layout = input.layout ? &*input.layout : nullptr;
    input.scene =
        makeScene(std::move(records), input.scene, devicesFor({&input.environment, layout}));
}

OtherLayout readOtherLayout(const LaidRoom& room, const std::string& operand,
                            const SceneRules& rules) {
    std::vector<std::string> operands = room.named;
    operands.push_back(operand);
    mustReadStdinOnce(operands);
    const Document layout = read(operand, rules);
    if (layout.kind != DocumentKind::Layout)
        throw FormatError(
            {displayName(operand), 0, 0, "an environment, where a layout (`#3dm 1`) is wanted"});
    std::vector<Diagnostic> warnings;
    const bool is_operand = std::find(room.named.begin(), room.named.end(),
                                      room.environment_operand) != room.named.end();
    checkDigest(layout, {room.environment.records, room.environment_operand, is_operand},
                rules.same_environment, warnings);
    std::vector<std::string> files = {operand};
    files.insert(files.end(), layout.sources.begin(), layout.sources.end());
    return {
        makeScene(room.environment, &layout, devicesFor({&room.environment, &layout}), &room.scene),
        std::move(files), std::move(warnings)};
}

namespace {

std::string folderOf(const std::string& operand) {
    return isStream(operand) ? "" : fs::path(operand).parent_path().string();
}

/// Points on the command line override those of records.
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

/// Reads a room, a layout, or the storey of a building that the options name.
/// \param building receives the building
Document parseInput(const RawInput& raw, const InputRequest& request, const ImportOptions& import,
                    std::optional<StoreyedDocument>& building) {
    const bool is_blank = raw.bytes.find_first_not_of(" \t\r\n") == std::string::npos;
    if (raw.name == "-" && request.may_be_empty && is_blank) return {};
    Document document;
    if (isBuilding(raw.bytes)) {
        building = readBuilding(raw.bytes, raw.name, import);
        document = chosenStorey(*building, raw.name, import.storey);
    } else {
        document = parseDocument(raw.bytes, raw.name, import, sceneSchemas());
    }
    if (!isRecordText(raw.bytes)) checkIds(document.records);  // text records are checked when read
    rebaseFiles(document.records, folderOf(raw.name), "");
    return document;
}

/// Passes the records of other inputs to an importer: their walls close its gaps, their inside
/// points choose its rooms.
void addKnown(std::span<const Record> records, ImportOptions& import) {
    Diagnostics ignored;  // reported when the environment is built
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

/// Parses all inputs in their order; plans last, as they require the records of the others.
std::vector<Document> parseInputs(const std::vector<RawInput>& raw, const InputRequest& request) {
    std::vector<Document> documents(raw.size());
    std::optional<StoreyedDocument> building;
    ImportOptions import = request.import;
    const bool any_plan =
        std::any_of(raw.begin(), raw.end(), [](const RawInput& input) { return input.is_plan; });
    addKnown(request.added, import);
    for (const bool plans : {false, true})
        for (std::size_t i = 0; i < raw.size(); ++i) {
            if (raw[i].is_plan != plans) continue;
            documents[i] = parseInput(raw[i], request, import, building);
            if (!plans && any_plan) addKnown(documents[i].records, import);
        }
    if (!any_plan && !import.inside.empty()) setInside(import.inside, documents);
    if (std::any_of(documents.begin(), documents.end(), [](const Document& document) {
            return document.kind == DocumentKind::Layout && namesStoreys(document);
        }))
        for (std::size_t i = 0; i < raw.size(); ++i)
            if (const auto whole = wholeBuilding(raw[i].bytes, raw[i].name, import))
                for (Document& document : documents)
                    if (document.kind == DocumentKind::Layout)
                        document = layoutOfRoom(document, *whole, documents[i].records);
    if (building) {
        if (import.report != nullptr) import.report->has_storeys = true;
        for (Document& document : documents)
            if (document.kind == DocumentKind::Layout)
                document = layoutOfStorey(document, *building, import.storey);
    }
    return documents;
}

template <typename T>
void append(std::vector<T>& to, std::vector<T>&& from) {
    if (to.empty())
        to = std::move(from);
    else
        to.insert(to.end(), std::move_iterator(from.begin()), std::move_iterator(from.end()));
}

/// Layouts alone: reads the environment of the first that names one. Returns the file's name.
std::string addEnvironment(std::vector<Document>& documents, const InputRequest& request) {
    for (std::size_t i = 0; i < documents.size(); ++i) {
        const auto reference = environmentReference(documents[i]);
        if (!reference || reference->file.empty()) continue;
        std::optional<StoreyedDocument> building;
        // Names are relative to the current folder by now.
        Document environment = documentReferenced(
            *reference, reference->file, request.inputs[i], [&](const std::string& bytes) {
                Document room =
                    parseInput({reference->file, bytes}, request, request.import, building);
                if (namesStoreys(documents[i]))
                    if (const auto whole = wholeBuilding(bytes, reference->file, request.import))
                        documents[i] = layoutOfRoom(documents[i], *whole, room.records);
                return room;
            });
        environment.sources.insert(environment.sources.begin(), reference->file);
        if (building) {
            if (request.import.report != nullptr) request.import.report->has_storeys = true;
            documents[i] = layoutOfStorey(documents[i], *building, request.import.storey);
        }
        documents.push_back(std::move(environment));
        return reference->file;
    }
    return "";
}

/// Finds the environment among the documents, or reads it from the layouts' records; its records
/// come later.
Reference environmentAmong(std::vector<Document>& documents, const InputRequest& request) {
    Reference environment;
    for (std::size_t i = 0; i < documents.size(); ++i)
        if (documents[i].kind == DocumentKind::Environment)
            environment.operand +=
                (environment.operand.empty() ? "" : " + ") + displayName(request.inputs[i]);
    environment.is_operand = !environment.operand.empty();
    if (!environment.is_operand) environment.operand = addEnvironment(documents, request);
    return environment;
}

}  // namespace

std::vector<RawInput> readRawInputs(const InputRequest& request) {
    std::vector<RawInput> raw;
    for (const std::string& input : request.inputs) {
        raw.push_back({input, input == "-" ? readStdin() : readAll(input)});
        raw.back().is_plan = isPlan(raw.back().bytes, input, request.import, sceneSchemas());
    }
    return raw;
}

Document readInputs(const std::vector<RawInput>& raw, const InputRequest& request,
                    std::vector<Diagnostic>& other_rooms) {
    std::vector<Document> documents = parseInputs(raw, request);
    Reference environment;
    if (request.compiles) environment = environmentAmong(documents, request);
    std::stable_sort(documents.begin(), documents.end(), [](const Document& a, const Document& b) {
        return a.kind == DocumentKind::Environment && b.kind == DocumentKind::Layout;
    });
    Document joined;
    joined.kind = documents.front().kind;
    const bool checks_digests = request.compiles && request.same_environment.value_or(true) &&
                                documents.back().kind == DocumentKind::Layout;
    std::vector<Record> records;  // of the environment, before layouts are applied
    for (Document& document : documents) {
        append(joined.history, std::move(document.history));
        append(joined.notes, std::move(document.notes));
        append(joined.warnings, std::move(document.warnings));
        append(joined.sources, std::move(document.sources));
        if (document.kind == DocumentKind::Layout) {
            if (checks_digests && !environment.records.empty())
                checkDigest(document, environment, request.same_environment, other_rooms);
            joined.records = joinRecords(joined.records, document.records);
        } else {
            append(joined.records, std::move(document.records));
            if (checks_digests) environment.records = records = joined.records;
        }
    }
    if (documents.size() > 1) checkIds(joined.records);
    return joined;
}

RunChanges changesOfRun(const std::string& folder, const Scene& start,
                        std::optional<std::uint64_t> max_work) {
    return {folder, start, shippedDevices(),
            [max_work](const std::string& file) {
                SceneRules rules;
                rules.same_environment = true;
                rules.max_work = max_work;
                return readScene({{file}, rules, false}).scene;
            },
            max_work};
}

}  // namespace ispace
