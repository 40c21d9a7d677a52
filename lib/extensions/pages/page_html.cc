// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/pages/page_writer.h"
#include "geom/pose.h"

// The assembler copies the files into the program; CMake passes their folder.
// NOLINTBEGIN(hicpp-no-assembler,bugprone-macro-parentheses)
#define ISPACE_PAGE_FILE(symbol, file)                                                       \
    asm(".pushsection .rodata\n" #symbol ":\n.incbin \"" ISPACE_PAGE "/" file "\"\n" #symbol \
        "End:\n.popsection\n");                                                              \
    extern "C" const char symbol[], symbol##End[]
// NOLINTEND(hicpp-no-assembler,bugprone-macro-parentheses)

ISPACE_PAGE_FILE(kPageStyle, "page.css");
ISPACE_PAGE_FILE(kPageScript, "page.js");

namespace ispace::pages {

namespace {

/// Escapes lines one by one, as control characters within a line are replaced.
std::string escapedLines(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        out += escapedXml(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!text.empty()) out += '\n';
    }
    return out;
}

std::string_view classOf(Tone tone) {
    switch (tone) {
        case Tone::Good:
            return " class=\"good\"";
        case Tone::Bad:
            return " class=\"bad\"";
        case Tone::Small:
            return " class=\"small\"";
        case Tone::Plain:
            break;
    }
    return "";
}

/// Writes what page.js reads.
std::string indexJson(const MapIndex& index) {
    constexpr double kMicro = 1e6;
    const auto micro = [](double value) { return std::round(value * kMicro) / kMicro; };
    JsonWriter json;
    json.beginObject();
    const PageView& view = index.view;
    json.key("view").value(std::vector<double>{micro(view.scale), view.world_anchor.x,
                                               view.world_anchor.y, micro(view.page_anchor.x),
                                               micro(view.page_anchor.y)});
    json.key("hidden").value(index.hidden);
    json.key("sensors").beginArray();
    for (const MapSensor& sensor : index.sensors) {
        const Point3 at = sensor.pose.position;
        json.beginObject();
        json.key("id").value(sensor.id);
        json.key("noun").value(sensor.noun);
        json.key("at").value(std::vector<double>{micro(at.x), micro(at.y), micro(at.z)});
        json.key("plane").value(sensor.plane);
        json.key("color").value(cssColor(sensor.color));
        if (!sensor.resolution.empty()) {
            const Frame3 frame(sensor.pose);
            const auto numbers = [&micro](Vec3 v) {
                return std::vector<double>{micro(v.x), micro(v.y), micro(v.z)};
            };
            json.key("axis").value(numbers(frame.forward));
            json.key("left").value(numbers(frame.left));
            json.key("up").value(numbers(frame.up));
            json.key("widest").value(micro(sensor.widest.radians()));
            json.key("bearings").value(sensor.bearings);
            json.key("resolution").beginArray();
            for (const double pixels : sensor.resolution) json.value(std::round(10 * pixels) / 10);
            json.endArray();
        }
        json.endObject();
    }
    json.endArray();
    json.endObject();
    return json.take();
}

}  // namespace

std::vector<std::pair<std::string, std::string>> coverLines(const PageCover& cover) {
    std::vector<std::pair<std::string, std::string>> lines;
    const auto add = [&lines](const char* name, const std::string& text) {
        if (!text.empty()) lines.emplace_back(name, text);
    };
    add("Project", cover.project);
    add("Client", cover.client);
    add("Author", cover.author);
    return lines;
}

namespace {

class HtmlWriter {
  public:
    std::string write(const ReportPage& page) {
        const auto between = [](const char* begin, const char* end) {
            return std::string_view(begin, static_cast<std::size_t>(end - begin));
        };
        out_ =
            "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
            "<meta charset=\"utf-8\" />\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n"
            "<meta name=\"color-scheme\" content=\"light dark\" />\n<title>";
        out_.append(escapedXml(page.title)).append("</title>\n<style>\n");
        out_.append(between(kPageStyle, kPageStyleEnd));
        if (page.paper == Paper::Letter) out_ += "@media print { @page { size: letter; } }\n";
        out_ += "</style>\n</head>\n<body>\n<header>\n";
        if (!page.cover.logo.empty())
            out_.append("<img class=\"logo\" alt=\"\" src=\"data:image/png;base64,")
                .append(base64(page.cover.logo))
                .append("\" />\n");
        out_.append("<h1>").append(escapedXml(page.title)).append("</h1>\n<p>");
        out_.append(escapedXml(page.subtitle)).append("</p>\n");
        for (const auto& [name, text] : coverLines(page.cover))
            out_.append("<p class=\"cover\">" + name + ": <b>" + escapedXml(text) + "</b></p>\n");
        out_.append("<nav aria-label=\"sections\">");
        for (const PageSection& section : page.sections)
            out_.append("<a href=\"#" + section.id + "\">" + escapedXml(section.title) + "</a> ");
        out_ += "</nav>\n</header>\n<main>\n";
        for (const PageSection& section : page.sections) add(section);
        out_.append("</main>\n<script>\n//<![CDATA[\n");
        out_.append(between(kPageScript, kPageScriptEnd)).append("//]]>\n</script>\n");
        out_ += "</body>\n</html>\n";
        return joined();
    }

  private:
    void add(const PageSection& section) {
        out_.append(section.begins_sheet ? "<section class=\"sheet-top\" id=\"" : "<section id=\"");
        out_.append(section.id + "\" aria-labelledby=\"" + section.id + "-title\">\n<h2 id=\"" +
                    section.id + "-title\">");
        out_.append(escapedXml(section.title)).append("</h2>\n");
        for (const PageBlock& block : section.blocks)
            std::visit([this](const auto& one) { add(one); }, block);
        out_ += "</section>\n";
    }

    void add(const PageText& text) {
        out_.append("<p").append(classOf(text.tone)).append(">");
        out_.append(escapedXml(text.text)).append("</p>\n");
    }

    void add(const PageTable& table) {
        const std::string caption = escapedXml(table.caption);
        out_.append("<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"" + caption +
                    "\">\n<table>\n<caption>" + caption + "</caption>\n<thead><tr>");
        for (std::size_t i = 0; i < table.heads.size(); ++i)
            out_.append("<th scope=\"col\"")
                .append(sideOf(table, i))
                .append(">")
                .append(escapedXml(table.heads[i]) + "</th>");
        out_ += "</tr></thead>\n<tbody>\n";
        for (std::size_t k = 0; k < table.rows.size(); ++k) {
            out_.append("<tr").append(
                classOf(k < table.tones.size() ? table.tones[k] : Tone::Plain));
            out_ += '>';
            const TextRow& row = table.rows[k];
            for (std::size_t i = 0; i < row.size(); ++i) {
                out_.append(i == 0 ? "<th scope=\"row\"" : "<td").append(sideOf(table, i));
                out_.append(">").append(escapedXml(row[i])).append(i == 0 ? "</th>" : "</td>");
            }
            out_ += "</tr>\n";
        }
        out_ += "</tbody>\n</table>\n</div>\n";
    }

    static std::string_view sideOf(const PageTable& table, std::size_t column) {
        const char side = column < table.sides.size() ? table.sides[column] : table.sides.back();
        return side == 'r' ? " class=\"r\"" : "";
    }

    void add(const PageCode& code) {
        out_.append("<pre tabindex=\"0\">").append(escapedLines(code.text)).append("</pre>\n");
    }

    void add(const PageFigure& figure) {
        out_ += "<figure";
        const bool is_photo = !figure.picture.list().images.empty();
        const bool is_sheet = figure.picture.unit() == PageUnit::Millimetre;
        if (is_photo || is_sheet || figure.is_for_screen)
            out_.append(" class=\"")
                .append(is_photo   ? "photo"
                        : is_sheet ? "sheet"
                                   : "legend")
                .append("\"");
        if (figure.width < 1)
            out_.append(" style=\"width:").append(formatDouble(100 * figure.width)).append("%\"");
        out_ += ">\n";
        addPicture(figure.picture);
        out_.append("<figcaption>").append(escapedXml(figure.caption));
        out_ += "</figcaption>\n</figure>\n";
    }

    void add(const PageMap& map) {
        out_.append("<figure class=\"map\" data-index=\"").append(escapedXml(indexJson(map.index)));
        out_ += "\">\n";
        addPicture(map.screen);
        out_.append("<figcaption>").append(escapedXml(map.paper.caption));
        out_ += "</figcaption>\n</figure>\n";
    }

    /// Pictures are most of a page, megabytes each: they are not copied while it grows.
    void addPicture(const Picture& picture) {
        parts_.push_back(std::move(out_));
        parts_.push_back(svgElement(picture, "f" + std::to_string(++figures_) + "-"));
        out_.clear();
    }

    /// Joins all parts, and frees each with its copy.
    std::string joined() {
        parts_.push_back(std::move(out_));
        std::size_t size = 0;
        for (const std::string& part : parts_) size += part.size();
        std::string text;
        text.reserve(size);
        for (std::string& part : parts_) text += std::exchange(part, {});
        return text;
    }

    std::vector<std::string> parts_;  // before out_
    std::string out_;
    int figures_ = 0;
};

}  // namespace

std::string htmlOf(const ReportPage& page) { return HtmlWriter().write(page); }

}  // namespace ispace::pages
