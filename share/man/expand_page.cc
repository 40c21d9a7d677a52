// SPDX-License-Identifier: GPL-3.0-or-later
// expand_page TEMPLATE PAGE: a page of the manual with the tables in it that the tools use, those
// of records and of envc's formats. Run while the manual is built.
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "cli/run_tool.h"
#include "extensions.h"
#include "io/exporters.h"
#include "record/schema.h"
#include "scene/placement_schemas.h"
#include "site/building_schemas.h"

namespace {

constexpr std::string_view kFormatsMark = "@EXPORT FORMATS@\n";
constexpr std::string_view kBuildingMark = "@BUILDING RECORDS@\n";

/// A paragraph each, with hyphens that can be copied.
std::string formatsText() {
    std::string text;
    for (const ispace::ExportFormat& format : ispace::exportFormats()) {
        text.append(".TP\n.B ").append(format.name).append("\n");
        for (const char c : format.help) {
            if (c == '-') text += '\\';
            text += c;
        }
        text += '\n';
    }
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("expand_page", [&] {
        if (argc != 3) throw ispace::UsageError("wanted a template and a page");
        static_cast<void>(ispace::extensions());  // add records and formats
        std::string page = ispace::expandManual(ispace::readAll(argv[1]), ispace::sceneSchemas());
        if (const std::size_t at = page.find(kFormatsMark); at != std::string::npos)
            page.replace(at, kFormatsMark.size(), formatsText());
        if (const std::size_t at = page.find(kBuildingMark); at != std::string::npos) {
            std::string records;
            for (const ispace::Schema& schema : ispace::buildingSchemas().all())
                records += ispace::manualOf(schema);
            page.replace(at, kBuildingMark.size(), records);
        }
        ispace::writeAll(argv[2], page);
    });
}
