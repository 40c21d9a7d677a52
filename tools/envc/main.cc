// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms and layouts into a model, and converts between record formats.
#include <algorithm>

#include "base/file.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/run_tool.h"
#include "env/info.h"
#include "envc/options.h"
#include "io/glb.h"
#include "io/input.h"
#include "layout/schemas.h"
#include "record/text.h"

namespace {

using namespace ispace;

/// All inputs as one file of records: environments in their order, then layouts, whose records
/// take the place of those with the same id.
Document readInputs(const EnvcOptions& options) {
    std::vector<Document> documents;
    for (const std::string& input : options.inputs) {
        const std::string bytes = input == "-" ? readStdin() : readAll(input);
        documents.push_back(parseDocument(bytes, input, options.import, sceneSchemas()));
        checkIds(documents.back().records);
    }
    std::stable_sort(documents.begin(), documents.end(), [](const Document& a, const Document& b) {
        return a.kind == DocumentKind::Environment && b.kind == DocumentKind::Layout;
    });
    Document joined{documents.front().kind, {}, {}};
    std::vector<Record> environment;  // before layouts are applied
    for (const Document& document : documents) {
        joined.history.insert(joined.history.end(), document.history.begin(),
                              document.history.end());
        if (document.kind == DocumentKind::Layout) {
            const bool compiles = options.info || options.format == "glb";
            if (compiles && !environment.empty() && !options.any_environment)
                checkDigest(document, environment, "the environment given");
            joined.records = joinRecords(joined.records, document.records);
        } else {
            joined.records.insert(joined.records.end(), document.records.begin(),
                                  document.records.end());
            environment = joined.records;
        }
    }
    checkIds(joined.records);
    joined.history.push_back(options.history_line);
    return joined;
}

Scene sceneOf(const Document& document) {
    return makeScene(document, nullptr, DeviceCatalogue::load(shareFolder() + "/devices"));
}

void envc(const EnvcOptions& options) {
    const std::string& output = options.common.output;
    if (!options.info && options.format == "glb") refuseTerminal(output, "a GLB");
    const ThreadLimit threads(options.common.threads);
    Document document = readInputs(options);
    if (options.info) {
        const Scene scene = sceneOf(document);
        const EnvironmentInfo info = describe(scene.environment, scene.records, scene.digest);
        writeAll(output, options.json ? infoJson(info) : infoText(info));
    } else if (options.format == "glb") {
        // The model holds its environment: a way to another would only go stale.
        std::erase_if(document.records,
                      [](const Record& record) { return record.keyword() == "environment"; });
        document.kind = DocumentKind::Environment;
        const Scene scene = sceneOf(document);
        writeAll(output, writeGlb(scene, document));
        talk(options.common, "envc",
             std::to_string(scene.records.size()) + " records compiled, indoor area " +
                 formatFixed(scene.environment.indoor().area(), 2) + " m2");
    } else {
        document.kind = options.format == "env" ? DocumentKind::Environment : DocumentKind::Layout;
        writeAll(output, writeRecordText(document));
    }
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("envc", [&] { envc(ispace::parseEnvcOptions(argc, argv)); });
}
