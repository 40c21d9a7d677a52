// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms and layouts into a model, checks, converts, edits and draws them.
#include <filesystem>
#include <string_view>
#include <utility>

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
#include "io/glb.h"
#include "io/mesh_file.h"
#include "layout/check_scene.h"
#include "layout/schemas.h"
#include "plan/plan.h"
#include "record/text.h"
#include "record/yaml.h"

namespace {

using namespace ispace;
namespace fs = std::filesystem;

/// Metres a cell of a ROS map, unless --resolution says otherwise.
constexpr double kMapResolution = 0.05;

/// Records become records without a look at what they describe.
bool isRecordFormat(const std::string& format) {
    return format == "env" || format == "3dm" || format == "yaml";
}

/// What no terminal shows, and how messages call it.
constexpr std::pair<std::string_view, const char*> kBinary[] = {
    {"glb", "a GLB"}, {"stl", "an STL"}, {"png", "a PNG"}};

/// The file that stands beside the product; "" for none.
std::string besideOf(const EnvcOptions& options) {
    if (options.format == "ros") return withSuffix(options.common.output, ".pgm");
    if (options.format == "obj" && !isStream(options.common.output))
        return withSuffix(options.common.output, ".mtl");
    return "";
}

Document readModel(const EnvcOptions& options) {
    InputRequest request;
    request.inputs = options.inputs;
    request.import = options.import;
    request.compiles = !isRecordFormat(options.format);
    request.import.load_meshes = request.compiles;
    request.added = addedRecords(options.edits, sceneSchemas());
    request.any_environment = options.any_environment;
    request.may_be_empty = !options.edits.empty();
    Document document = readInputs(request);
    document.records = edited(std::move(document.records), options.edits, sceneSchemas());
    if (request.compiles) loadMeshes(document, "");
    document.history.push_back(options.history_line);
    if (!options.check) warn(options.common, "envc", document.warnings);
    for (const std::string& note : document.notes) talk(options.common, "envc", note);
    return document;
}

std::string drawing(const EnvcOptions& options, const Scene& scene) {
    PlanOptions plan;
    plan.format = options.format == "svg" ? PictureFormat::Svg : PictureFormat::Png;
    plan.slice = options.slice;
    plan.width = options.width;
    if (!isStream(options.inputs.front())) plan.title = baseName(options.inputs.front());
    return drawPlan(scene, plan);
}

void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document) {
    const std::string& format = options.format;
    const std::string& output = options.common.output;
    const std::string beside = besideOf(options);
    if (format == "obj" && !beside.empty()) {
        const ObjFiles files = writeObj(scene, fs::path(beside).filename().string());
        writeTogether(std::vector<NamedBytes>{{beside, files.mtl}, {output, files.obj}});
    } else if (format == "obj") {
        writeAll(output, writeObj(scene, "").obj);
    } else if (format == "ros") {
        const RosMapFiles files = writeRosMap(scene, options.slice.value_or(kScanHeight),
                                              options.import.resolution.value_or(kMapResolution),
                                              fs::path(beside).filename().string());
        writeTogether(std::vector<NamedBytes>{{beside, files.pgm}, {output, files.yaml}});
    } else if (format == "stl") {
        writeAll(output, writeStl(scene));
    } else if (format == "geojson") {
        writeAll(output, writeGeoJson(scene, options.slice));
    } else if (format == "svg" || format == "png") {
        writeAll(output, drawing(options, scene));
    } else {
        writeAll(output, writeGlb(scene, document));
    }
}

/// Names of files in a product are relative to its folder.
void rebaseTo(const std::string& output, Document& document) {
    rebaseFiles(document.records, "",
                isStream(output) ? "" : fs::path(output).parent_path().string());
}

/// What an import doubts and what is wrong with the scene, together; the first counts all the more
/// where no scene can be made of it. \throws FormatError with all findings
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

void compile(const EnvcOptions& options, Document document) {
    // The model holds its environment: a way to another would only go stale.
    std::erase_if(document.records,
                  [](const Record& record) { return record.keyword() == "environment"; });
    document.kind = DocumentKind::Environment;
    if (options.format == "glb") rebaseTo(options.common.output, document);
    const DeviceCatalogue devices = loadDevices(shareFolder() + "/devices");
    if (options.check) {
        check(document, devices);
        talk(options.common, "envc", "nothing found");
        return;
    }
    const Scene scene = makeScene(document, nullptr, devices);
    const std::string& output = options.common.output;
    if (options.info) {
        const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest);
        writeAll(output, options.json ? infoJson(info) : infoText(info));
    } else {
        writeProduct(options, scene, document);
        talk(options.common, "envc",
             std::to_string(scene.records.size()) + " records compiled, indoor area " +
                 formatFixed(scene.environment.indoor().area(), 2) + " m2");
    }
}

void convert(const EnvcOptions& options, Document document) {
    const std::string& output = options.common.output;
    rebaseTo(output, document);
    if (options.format != "yaml")
        document.kind = options.format == "env" ? DocumentKind::Environment : DocumentKind::Layout;
    writeAll(output, options.format == "yaml" ? writeYaml(document) : writeRecordText(document));
}

void envc(const EnvcOptions& options) {
    for (const auto& [format, name] : kBinary)
        if (options.format == format) refuseTerminal(options.common.output, name);
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    claimOutput(besideOf(options),
                options.format == "ros" ? "the picture of the map" : "materials");
    const Document document = readModel(options);
    if (isRecordFormat(options.format))
        convert(options, document);
    else
        compile(options, document);
    std::vector<std::string> files = options.inputs;
    files.insert(files.end(), document.sources.begin(), document.sources.end());
    writeDependencies(options.common, files);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("envc", [&] { envc(ispace::parseEnvcOptions(argc, argv)); });
}
