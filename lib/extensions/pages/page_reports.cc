// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/page_reports.h"

#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/outputs.h"
#include "drawing/drawing.h"
#include "extensions/pages/cables.h"
#include "extensions/pages/material.h"
#include "extensions/pages/page_writer.h"
#include "extensions/pages/room_page.h"
#include "extensions/pages/site_page.h"

namespace ispace::pages {

namespace {

constexpr std::string_view kFormats[] = {"html", "pdf"};

bool isPdf(const std::string& file) { return suffixOf(file) == "pdf"; }

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

class PageReports : public ReportGroup {
  public:
    [[nodiscard]] std::span<const std::string_view> formats() const override { return kFormats; }
    void declare(CommandLine& line) override;
    void take(const std::string& report) override;
    [[nodiscard]] std::vector<SideFile> files() const override {
        return {{"--material", &material_}};
    }
    [[nodiscard]] bool isAsked() const override { return !(material_.empty() && prices_.empty()); }
    [[nodiscard]] std::string writeFiles(
        std::span<const std::shared_ptr<const Scene>> scenes) const override;
    [[nodiscard]] ReportPage page(const SiteReport& report, const std::string& file) const override;
    [[nodiscard]] ReportPage page(const RoomReport& report) const override {
        return pageOf(report);
    }
    [[nodiscard]] std::string bytesOf(const ReportPage& page,
                                      const std::string& file) const override {
        return isPdf(file) ? pdfOf(page) : htmlOf(page);
    }

  private:
    PageCover cover_;  // with the logo from take() on
    std::string logo_, paper_ = "a4", prices_, material_;
    PriceList price_list_;
};

void PageReports::declare(CommandLine& line) {
    line.text("--title", "TEXT", cover_.title, "title of --report, in place of ENV's name",
              Enters::Nothing);
    line.text("--project", "TEXT", cover_.project, "project on the cover of --report",
              Enters::Nothing);
    line.text("--client", "TEXT", cover_.client,
              "client on the cover of --report; with a cover each camera has a sheet",
              Enters::Nothing);
    line.text("--author", "TEXT", cover_.author, "author on the cover of --report",
              Enters::Nothing);
    line.file("--logo", "FILE", logo_, "logo on the cover of --report, a PNG picture",
              Enters::Nothing);
    line.choice("--paper", paper_, {"a4", "letter"}, "sheets of --report (default a4)",
                Enters::Nothing);
    line.file(
        "--prices", "FILE", prices_,
        "prices for the material of --report and --material, lines ITEM,PRICE (CSV): devices, "
        "ceiling mount, wall mount, stand, cable",
        Enters::Nothing);
    line.file("--material", "FILE", material_,
              "write devices, mounts and cables there, with prices and sums, as CSV",
              Enters::Nothing);
}

void PageReports::take(const std::string& report) {
    const bool is_page = !report.empty() && suffixOf(report) != "json";
    if ((cover_.isGiven() || !logo_.empty() || paper_ != "a4") && !is_page)
        throw UsageError(
            "--title, --project, --client, --author, --logo and --paper are about a page: give "
            "--report FILE.html or FILE.pdf");
    if (!prices_.empty() && !is_page && material_.empty())
        throw UsageError("--prices are for the material: give --material FILE.csv or --report");
    if (isStdout(material_))
        throw UsageError("--material: stdout is for another product; give it a file");
    if (!material_.empty())
        static_cast<void>(outputFormat({}, material_, {"csv"}));  // rejects another suffix
    if (!logo_.empty()) cover_.logo = logoOf(logo_);
    if (!prices_.empty()) price_list_ = readPrices(readAll(prices_), prices_);
}

std::string PageReports::writeFiles(std::span<const std::shared_ptr<const Scene>> scenes) const {
    std::vector<CabledRoom> rooms;
    rooms.reserve(scenes.size());
    for (const auto& scene : scenes) rooms.push_back({*scene, cablesOf(*scene)});
    const std::vector<MaterialItem> material = materialOf(rooms, price_list_);
    if (!material_.empty()) writeAll(material_, materialCsv(material, price_list_.currency));
    const std::string unused = unusedPrices(price_list_, material);
    return unused.empty() ? "" : prices_ + ": " + unused;
}

ReportPage PageReports::page(const SiteReport& report, const std::string& file) const {
    using Media = CoveragePageInput::Media;
    return sitePage(report, {isPdf(file) ? Media::Paper : Media::Screen, cover_,
                             paper_ == "letter" ? Paper::Letter : Paper::A4, price_list_});
}

}  // namespace

std::unique_ptr<ReportGroup> makePageReports() { return std::make_unique<PageReports>(); }

}  // namespace ispace::pages
