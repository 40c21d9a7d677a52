// SPDX-License-Identifier: GPL-3.0-or-later
// Lists: jobs of `coverage --batch` and sites of `arrange --places`.
#include "arrange/placement_rules.h"
#include "cli/batch.h"
#include "fuzz.h"

namespace {

using namespace ispace;

void tryJobs(std::string_view bytes) {
    int line = 0;
    for (const BatchJob& job : readBatchList(bytes, "jobs.txt")) {
        fuzz::require(job.line > line, "jobs are not in the order of their lines");
        fuzz::require(job.operands.empty() != job.wrong.empty(),
                      "a job is neither right nor wrong");
        line = job.line;
    }
}

void tryPlaces(const std::string& text) {
    for (const Site& site : readSites(text, "places.csv", headingsAround(4)))
        fuzz::require(!site.headings.empty(), "a place without a heading");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    try {
        tryJobs(bytes);
    } catch (const FormatError&) {
        // It may be a list of sites.
    }
    tryPlaces(std::string(bytes));
}
