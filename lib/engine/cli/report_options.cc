// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report_options.h"

#include "base/error.h"
#include "base/file.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "drawing/drawing.h"
#include "report/page/cables.h"

namespace ispace {

namespace {

/// Reads the bytes of a PNG file and checks them.
std::string logoOf(const std::string& file) {
    std::string bytes = readAll(file);
    try {
        static_cast<void>(decodePng(bytes));
    } catch (const FormatError&) {
        throw FormatError({file, 0, 0, "no PNG picture, which --logo takes"});
    }
    return bytes;
}

}  // namespace

void addReportOptions(CommandLine& line, ReportWords& words) {
    line.text("--title", "TEXT", words.cover.title, "title of --report, in place of ENV's name",
              Enters::Nothing);
    line.text("--project", "TEXT", words.cover.project, "project on the cover of --report",
              Enters::Nothing);
    line.text("--client", "TEXT", words.cover.client,
              "client on the cover of --report; with a cover each camera has a sheet",
              Enters::Nothing);
    line.text("--author", "TEXT", words.cover.author, "author on the cover of --report",
              Enters::Nothing);
    line.file("--logo", "FILE", words.cover.logo, "logo on the cover of --report, a PNG picture",
              Enters::Nothing);
    line.choice("--paper", words.paper, {"a4", "letter"}, "sheets of --report (default a4)",
                Enters::Nothing);
    line.file(
        "--prices", "FILE", words.prices,
        "prices for the material of --report and --material, lines ITEM,PRICE (CSV): devices, "
        "ceiling mount, wall mount, stand, cable",
        Enters::Nothing);
    line.file("--material", "FILE", words.material,
              "write devices, mounts and cables there, with prices and sums, as CSV",
              Enters::Nothing);
}

void checkReportOptions(const ReportWords& words, const std::string& report) {
    const bool is_page = !report.empty() && suffixOf(report) != "json";
    if (words.isForPage() && !is_page)
        throw UsageError(
            "--title, --project, --client, --author, --logo and --paper are about a page: give "
            "--report FILE.html or FILE.pdf");
    if (!words.prices.empty() && !is_page && words.material.empty())
        throw UsageError("--prices are for the material: give --material FILE.csv or --report");
    if (isStdout(words.material))
        throw UsageError("--material: stdout is for another product; give it a file");
    if (!words.material.empty())
        static_cast<void>(outputFormat({}, words.material, {"csv"}));  // rejects another suffix
    // Files that cannot be read are told before the work, not behind it.
    static_cast<void>(coverOf(words));
    static_cast<void>(pricesOf(words));
}

PriceList pricesOf(const ReportWords& words) {
    return words.prices.empty() ? PriceList() : readPrices(readAll(words.prices), words.prices);
}

PageCover coverOf(const ReportWords& words) {
    PageCover cover = words.cover;
    if (!cover.logo.empty()) cover.logo = logoOf(cover.logo);
    return cover;
}

Paper paperOf(const ReportWords& words) {
    return words.paper == "letter" ? Paper::Letter : Paper::A4;
}

std::string writeMaterialOf(const ReportWords& words,
                            std::span<const std::shared_ptr<const Scene>> scenes) {
    if (words.material.empty() && words.prices.empty()) return "";
    std::vector<CabledRoom> rooms;
    rooms.reserve(scenes.size());
    for (const auto& scene : scenes) rooms.push_back({*scene, cablesOf(*scene)});
    const PriceList prices = pricesOf(words);
    const std::vector<MaterialItem> material = materialOf(rooms, prices);
    if (!words.material.empty()) writeAll(words.material, materialCsv(material, prices.currency));
    const std::string unused = unusedPrices(prices, material);
    return unused.empty() ? "" : words.prices + ": " + unused;
}

}  // namespace ispace
