// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms and layouts into a model, checks, converts, edits and draws them.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/left_to_exit.h"
#include "base/number.h"
#include "base/program.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "env/info.h"
#include "envc/options.h"
#include "envc/product.h"
#include "io/exporters.h"
#include "io/input.h"
#include "layout/check_scene.h"
#include "layout/schemas.h"

namespace {

using namespace ispace;
namespace fs = std::filesystem;

Document readModel(const EnvcOptions& options) {
    InputRequest request;
    request.inputs = options.inputs;
    request.import = options.import;
    request.compiles = options.format == nullptr || options.format->write != nullptr;
    request.import.load_files = request.compiles;
    request.added = addedRecords(options.edits, sceneSchemas());
    request.any_environment = options.any_environment;
    request.may_be_empty = !options.edits.empty();
    Document document = readInputs(request);
    document.records = edited(std::move(document.records), options.edits, sceneSchemas());
    if (request.compiles) loadFiles(document, "");
    document.history.push_back(options.history_line);
    if (!options.check) warn(options.common, "envc", document.warnings);
    for (const std::string& note : document.notes) talk(options.common, "envc", note);
    return document;
}

/// Names of files in a product are relative to its folder.
void rebaseTo(const std::string& output, Document& document) {
    rebaseFiles(document.records, "",
                isStream(output) ? "" : fs::path(output).parent_path().string());
}

/// The warnings of an import and what is wrong with the scene, together; the first count all the
/// more where no scene can be made of it. \throws FormatError with all findings
void check(const Document& document, const DeviceCatalogue& devices) {
    Diagnostics findings;
    for (const Diagnostic& warning : document.warnings) findings.add(warning);
    try {
        checkScene(makeScene(document, nullptr, devices)).throwIfAny();
    } catch (const FormatError& error) {
        findings.add(error);
    }
    findings.throwIfAny();
}

/// What is compiled.
struct Room {
    Document document;
    Scene scene;
};

Room makeRoom(Document document, const DeviceCatalogue& devices) {
    Scene scene = makeScene(document, nullptr, devices);
    return {std::move(document), std::move(scene)};
}

void compile(const EnvcOptions& options, Document document) {
    // The model holds its environment: a way to another would only go stale.
    std::erase_if(document.records,
                  [](const Record& record) { return record.keyword() == "environment"; });
    document.kind = DocumentKind::Environment;
    if (options.format != nullptr) rebaseTo(options.common.output, document);
    const DeviceCatalogue& devices = devicesFor({&document});
    if (options.check) {
        check(document, devices);
        talk(options.common, "envc", "nothing found");
        return;
    }
    const auto& [compiled, scene] = leftToExit(makeRoom(std::move(document), devices));
    const std::string& output = options.common.output;
    if (options.info) {
        const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest());
        writeAll(output, options.json ? infoJson(info) : infoText(info));
    } else {
        writeProduct(options, scene, compiled);
        talk(options.common, "envc",
             std::to_string(scene.records.size()) + " records compiled, indoor area " +
                 formatFixed(scene.environment.indoor().area(), 2) + " m2");
    }
}

void convert(const EnvcOptions& options, Document document) {
    const std::string& output = options.common.output;
    rebaseTo(output, document);
    writeAll(output, options.format->write_records(std::move(document)));
}

void envc(const EnvcOptions& options) {
    const ExportFormat* const format = options.format;
    if (format != nullptr && !format->binary.empty())
        refuseTerminal(options.common.output, std::string(format->binary));
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    if (format != nullptr) claimOutput(besideOf(options), std::string(format->beside_role));
    keepMemory(options.inputs);
    Document document = readModel(options);
    std::vector<std::string> files = options.inputs;
    files.insert(files.end(), document.sources.begin(), document.sources.end());
    if (format != nullptr && format->write_records != nullptr)
        convert(options, std::move(document));
    else
        compile(options, std::move(document));
    writeDependencies(options.common, files);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("envc", [&] { envc(ispace::parseEnvcOptions(argc, argv)); });
}
