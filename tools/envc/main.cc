// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms and layouts into a model, checks, converts, edits and draws them.
#include <malloc.h>

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/number.h"
#include "base/program.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "env/info.h"
#include "envc/options.h"
#include "io/exporters.h"
#include "io/input.h"
#include "layout/check_scene.h"
#include "layout/schemas.h"

namespace {

using namespace ispace;
namespace fs = std::filesystem;

/// The file that stands beside the product; "" for none.
std::string besideOf(const EnvcOptions& options) {
    const ExportFormat& format = *options.format;
    const bool is_none =
        format.beside_suffix.empty() || (isStream(options.common.output) && !format.needs_beside);
    return is_none ? "" : withSuffix(options.common.output, format.beside_suffix.data());
}

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

void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document) {
    if (options.format->write_to != nullptr) {
        OutputFile file(options.common.output);
        options.format->write_to(scene, document,
                                 [&file](std::string_view bytes) { file.write(bytes); });
        file.commit();
        return;
    }
    const std::string beside = besideOf(options);
    ExportOptions how{options.slice,
                      options.import.resolution,
                      options.width,
                      "",
                      fs::path(beside).filename().string(),
                      options.zones};
    if (!isStream(options.inputs.front())) how.title = baseName(options.inputs.front());
    const ExportedFiles files = options.format->write(scene, document, how);
    if (!files.left_out.empty()) warn(options.common, "envc", files.left_out);
    if (beside.empty() || files.beside.empty())
        writeAll(options.common.output, files.product);
    else
        writeTogether(std::vector<NamedBytes>{{beside, files.beside},
                                              {options.common.output, files.product}});
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

/// What is compiled. It is left to the end of the process: to take a large room apart takes long.
struct Room {
    Document document;
    Scene scene;
};

const Room& makeRoom(Document document, const DeviceCatalogue& devices) {
    static const Room* room = nullptr;
    Scene scene = makeScene(document, nullptr, devices);
    room = new Room{std::move(document), std::move(scene)};
    return *room;
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
    const auto& [compiled, scene] = makeRoom(std::move(document), devices);
    const std::string& output = options.common.output;
    if (options.info) {
        const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest);
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
    Document document = readModel(options);
    std::vector<std::string> files = options.inputs;
    files.insert(files.end(), document.sources.begin(), document.sources.end());
    if (format != nullptr && format->write_records != nullptr)
        convert(options, std::move(document));
    else
        compile(options, std::move(document));
    writeDependencies(options.common, files);
}

/// Large rooms come and go through a few hundred megabytes: what is let go of is used again, and
/// not given back to the system, which would have to clear it anew.
void keepMemory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keepMemory();
    return ispace::runTool("envc", [&] { envc(ispace::parseEnvcOptions(argc, argv)); });
}
