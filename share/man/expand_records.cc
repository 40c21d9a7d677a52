// SPDX-License-Identifier: GPL-3.0-or-later
// expand_records TEMPLATE PAGE: a page of the manual with the tables of the records in it. Run while
// the manual is built.
#include "base/error.h"
#include "base/file.h"
#include "cli/run_tool.h"
#include "layout/schemas.h"
#include "record/schema.h"

int main(int argc, char** argv) {
    return ispace::runTool("expand_records", [&] {
        if (argc != 3) throw ispace::UsageError("wanted a template and a page");
        const std::string page = ispace::readAll(argv[1]);
        ispace::writeAll(argv[2], ispace::expandManual(page, ispace::sceneSchemas()));
    });
}
