// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/page_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/test_pdf.h"

namespace ispace::pages {
namespace page_test {

bool holds(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

Picture pictureOf(double width, double height, PageUnit unit = PageUnit::Pixel) {
    Picture picture(width, height, unit);
    picture.pushLayer("views");
    picture.pushGroup("view-l1", "field of view of l1");
    picture.area(Polygon{{0, 0}, {10, 0}, {10, 10}}, {palette::kInk});
    picture.pop();
    picture.pop();
    return picture;
}

ReportPage samplePage() {
    ReportPage page{"a <room> & more", "two sensors", {}};
    page.sections.push_back({"summary", "Summary", {PageText{"met & told", Tone::Good}}});
    page.sections.push_back(
        {"sheet",
         "Sheet",
         {PageTable{"in metres", "lr", {"sensor", "x"}, {{"l1", "1.25"}, {"l2", "-3"}}},
          PageCode{"laser id=l1\nlaser id=l2\n"}, PageFigure{"a figure", pictureOf(40, 30)},
          PageFigure{"another", pictureOf(40, 30), 0.3}}});
    return page;
}

TEST(Page, HtmlEscapesTextAndNumbersIds) {
    const std::string html = htmlOf(samplePage());
    EXPECT_TRUE(holds(html, "<h1>a &lt;room&gt; &amp; more</h1>"));
    EXPECT_TRUE(holds(html, "<p class=\"good\">met &amp; told</p>"));
    EXPECT_TRUE(holds(html, "<th scope=\"row\">l1</th><td class=\"r\">1.25</td>"));
    EXPECT_TRUE(holds(html, "laser id=l1\nlaser id=l2"));
    // The ids of two pictures differ.
    EXPECT_TRUE(holds(html, "id=\"f1-layer-views\""));
    EXPECT_TRUE(holds(html, "id=\"f2-layer-views\""));
    EXPECT_TRUE(holds(html, "data-layer=\"views\""));
    EXPECT_FALSE(holds(html, "inkscape:"));
    EXPECT_EQ(html, htmlOf(samplePage()));
}

TEST(Page, HasACoverAndItsPaper) {
    ReportPage page = samplePage();
    page.cover.client = "A & B";
    page.cover.project = "Door 7";
    const Image dot{2, 1, {0xFF0000, 0x0000FF}};
    page.cover.logo = encodePng(dot);
    const std::string html = htmlOf(page);
    EXPECT_TRUE(holds(html, "<p class=\"cover\">Client: <b>A &amp; B</b></p>"));
    EXPECT_TRUE(holds(html, "<p class=\"cover\">Project: <b>Door 7</b></p>"));
    EXPECT_FALSE(holds(html, "Author"));
    EXPECT_TRUE(holds(html, "src=\"data:image/png;base64,iVBOR"));
    EXPECT_FALSE(holds(html, "size: letter"));
    const std::vector<Picture> sheets = sheetsOf(page);
    EXPECT_EQ(sheets.front().width(), 210);
    EXPECT_EQ(sheets.front().list().images.size(), 1U);
    page.paper = Paper::Letter;
    EXPECT_TRUE(holds(htmlOf(page), "@page { size: letter; }"));
    EXPECT_EQ(sheetsOf(page).front().width(), 215.9);
    EXPECT_EQ(sheetsOf(page).front().height(), 279.4);
    // A section that begins a sheet.
    page.sections[1].blocks.resize(1);
    EXPECT_EQ(sheetsOf(page).size(), 1U);
    page.sections[1].begins_sheet = true;
    EXPECT_EQ(sheetsOf(page).size(), 2U);
    EXPECT_TRUE(holds(htmlOf(page), "<section class=\"sheet-top\" id=\"sheet\""));
}

/// Returns the share of a sheet down to its last line above the margin.
double filledOf(const Picture& sheet) {
    double last = 0;
    for (const auto& text : sheet.list().texts)
        if (text.anchor.y < sheet.height() - 15) last = std::max(last, text.anchor.y);
    return last / sheet.height();
}

TEST(Page, SheetsArePulledTogether) {
    const std::string line = "A sentence that takes a line of a sheet, from its left to its right.";
    ReportPage page{"report", "", {}};
    const auto add = [&](int lines, bool begins_sheet) {
        PageSection& section = page.sections.emplace_back(
            PageSection{"s" + std::to_string(page.sections.size()), "Section", {}});
        section.begins_sheet = begins_sheet;
        for (int i = 0; i < lines; ++i) section.blocks.push_back(PageText{line});
    };
    // Alone, the second section leaves some lines to a sheet before the third, and the fourth some
    // to the last one.
    for (const int more : {24, 28, 32, 36}) {
        page.sections.clear();
        add(24, false);
        add(more, false);
        add(24, true);
        add(more, false);
        for (const Picture& sheet : sheetsOf(page)) EXPECT_GT(filledOf(sheet), 0.3) << more;
    }
    // The third section is too short to fill a sheet: the second goes with it.
    for (const int last : {8, 10, 12, 14}) {
        page.sections.clear();
        add(26, false);
        add(14, false);
        add(last, false);
        add(30, true);
        for (const Picture& sheet : sheetsOf(page)) EXPECT_GT(filledOf(sheet), 0.3) << last;
    }
}

TEST(Page, MapTellsTheScriptItsSensors) {
    ReportPage page{"map", "", {}};
    MapIndex index{{10, {0, 0}, {5, 5}}, {{"c1", "camera", {{1, 2, 2.5}, {}, {}, {}}, 0}}, {}};
    index.sensors[0].resolution = {500, 510.26, 600};
    index.sensors[0].widest = Angle::radians(0.5);
    page.sections.push_back(
        {"map", "Map", {PageMap{{"", pictureOf(40, 30)}, pictureOf(40, 30), index}}});
    EXPECT_TRUE(holds(htmlOf(page),
                      "data-index=\"{&quot;view&quot;:[10,0,0,5,5],&quot;hidden&quot;:[],"
                      "&quot;sensors&quot;:[{&quot;id&quot;:&quot;c1&quot;,&quot;noun&quot;:"
                      "&quot;camera&quot;,&quot;at&quot;:[1,2,2.5],&quot;plane&quot;:0,&quot;color&"
                      "quot;:&quot;#b3261e&quot;,"
                      "&quot;axis&quot;:[1,0,0],&quot;left&quot;:[0,1,0],&quot;up&quot;:[0,0,1],"
                      "&quot;widest&quot;:0.5,&quot;bearings&quot;:1,"
                      "&quot;resolution&quot;:[500,510.3,600]}]}\""));
}

std::size_t pagesOf(const std::string& bytes) {
    const std::string pdf = objectsOf(bytes);
    std::size_t count = 0;
    for (std::size_t at = pdf.find("/Type /Page %"); at != std::string::npos;
         at = pdf.find("/Type /Page %", at + 1))
        ++count;
    return count;
}

TEST(Page, UnitsAreTypesetInTextsAndTables) {
    ReportPage page{"m2", "12.00 m2 · 3 rooms", {}};
    page.sections.push_back({"s",
                             "Section",
                             {PageText{"It has 1.00 m2, 2 m2 of it free; cam2 and m2x stay."},
                              PageTable{"in m2", "lr", {"zone", "indoor m2"}, {{"m2b", "(3 m2)"}}},
                              PageCode{"coverage --require 3 m2\n"}}});
    const ReportPage typed = typeset(page);
    EXPECT_EQ(typed.subtitle, "12.00 m² · 3 rooms");
    const std::vector<PageBlock>& blocks = typed.sections[0].blocks;
    EXPECT_EQ(std::get<PageText>(blocks[0]).text,
              "It has 1.00 m², 2 m² of it free; cam2 and m2x stay.");
    const PageTable& table = std::get<PageTable>(blocks[1]);
    EXPECT_EQ(table.caption, "in m²");
    EXPECT_EQ(table.heads[1], "indoor m²");
    EXPECT_EQ(table.rows[0], (TextRow{"m2b", "(3 m²)"}));
    EXPECT_EQ(std::get<PageCode>(blocks[2]).text, "coverage --require 3 m2\n");
}

TEST(Page, PdfKeepsTheColumnsOfText) {
    ReportPage page{"text", "", {}};
    page.sections.push_back({"s",
                             "Storey",
                             {PageCode{"sensor  model     by cells\n"
                                       "l1      urg-04lx   3.25 m2\n"
                                       "camera  x         12.00 m2\n\n"
                                       "one line that is no table\n"}}});
    const std::vector<Picture> sheets = sheetsOf(page);
    ASSERT_EQ(sheets.size(), 1U);
    std::map<std::string, DisplayList::Text> texts;
    for (const DisplayList::Text& text : sheets[0].list().texts) texts[text.text] = text;
    for (const char* row : {"l1", "camera"}) {
        EXPECT_EQ(texts.at(row).style.align, Align::Left);
        EXPECT_EQ(texts.at(row).anchor.x, texts.at("sensor").anchor.x);
    }
    EXPECT_EQ(texts.at("urg-04lx").anchor.x, texts.at("model").anchor.x);
    EXPECT_EQ(texts.at("x").anchor.x, texts.at("model").anchor.x);
    for (const char* row : {"3.25 m2", "12.00 m2"}) {
        EXPECT_EQ(texts.at(row).style.align, Align::Right);
        EXPECT_EQ(texts.at(row).anchor.x, texts.at("by cells").anchor.x);
    }
    EXPECT_EQ(texts.count("one line that is no table"), 1U);
}

TEST(Page, PdfFillsSheets) {
    ReportPage page = samplePage();
    const std::string one = pdfOf(page);
    EXPECT_EQ(one.substr(0, 5), "%PDF-");
    EXPECT_EQ(pagesOf(one), 1U);
    EXPECT_EQ(one, pdfOf(page));
    PageTable table{"rows", "lr", {"row", "number"}, {}};
    for (int i = 0; i < 200; ++i) table.rows.push_back({"row", std::to_string(i)});
    page.sections.push_back({"rows", "Rows", {table}});
    EXPECT_EQ(pagesOf(pdfOf(page)), 5U);
    // A word wider than the sheet breaks; a figure higher than it shrinks.
    page.sections.push_back({"odd",
                             "Odd",
                             {PageText{std::string(2000, 'x')}, PageText{""},
                              PageFigure{"high", pictureOf(100, 4000, PageUnit::Millimetre)}}});
    EXPECT_EQ(pagesOf(pdfOf(page)), 6U);
}

TEST(Page, PdfShrinksAFigureWithoutScaleToTheRestOfASheet) {
    const auto with = [](int height, PageUnit unit) {
        ReportPage page{"map", "", {}};
        page.sections.push_back({"sums", "Sums", std::vector<PageBlock>(11, PageText{"a line"})});
        page.sections.push_back({"map", "Map", {PageFigure{"", pictureOf(180, height, unit)}}});
        return pagesOf(pdfOf(page));
    };
    EXPECT_EQ(with(150, PageUnit::Pixel), 1U);
    EXPECT_EQ(with(170, PageUnit::Pixel), 1U);
    EXPECT_EQ(with(170, PageUnit::Millimetre), 2U);
    EXPECT_EQ(with(400, PageUnit::Pixel), 2U);
}

TEST(Page, PdfSetsTablesBeforeAFigureThatNeedsTheNextSheet) {
    const auto sheets_with = [](std::size_t texts) {
        ReportPage page{"map", "", {}};
        std::vector<PageBlock> blocks(texts, PageText{"a line"});
        blocks.emplace_back(PageFigure{"the figure", pictureOf(178, 240, PageUnit::Millimetre)});
        blocks.emplace_back(PageTable{"the table", "lr", {"zone", "area"}, {{"a", "1"}}});
        page.sections.push_back({"map", "Map", std::move(blocks)});
        return sheetsOf(page);
    };
    const auto sheet_of = [](const std::vector<Picture>& sheets, std::string_view text) {
        for (std::size_t i = 0; i < sheets.size(); ++i)
            for (const DisplayList::Text& one : sheets[i].list().texts)
                if (one.text == text) return i;
        return sheets.size();
    };
    const std::vector<Picture> sheets = sheets_with(8);
    ASSERT_EQ(sheets.size(), 2U);
    EXPECT_EQ(sheet_of(sheets, "the table"), 0U);
    EXPECT_EQ(sheet_of(sheets, "the figure"), 1U);
    // A sheet that is filled keeps the order.
    const std::vector<Picture> full = sheets_with(38);
    EXPECT_EQ(sheet_of(full, "the figure"), 1U);
    EXPECT_EQ(sheet_of(full, "the table"), full.size() - 1);
}

TEST(Page, WideTablesShowThatTheyContinue) {
    const std::string html = htmlOf(samplePage());
    EXPECT_TRUE(holds(html, "<div class=\"wide\" role=\"region\" tabindex=\"0\""));
    EXPECT_TRUE(holds(html, "background-attachment: local, local, scroll, scroll"));
    EXPECT_TRUE(holds(html, "width: max-content; max-width: min("));  // captions
}

TEST(Page, PdfSplitsTablesThatAreTooWide) {
    const auto with = [](std::vector<PageBlock> blocks) {
        ReportPage page{"wide", "", {}};
        page.sections.push_back({"sheet", "Sheet", std::move(blocks)});
        return pdfOf(page);
    };
    const std::string cell = "a cell of two lines or more, as it is wide";
    PageTable whole{"a caption", "lr", {"id"}, {{"c1"}, {"c2"}}, {Tone::Good}};
    PageTable first = whole, second = whole;
    second.caption.clear();
    for (int i = 0; i < 8; ++i) {
        PageTable& part = i < 4 ? first : second;
        for (PageTable* table : {&whole, &part}) {
            table->heads.push_back("head " + std::to_string(i));
            for (TextRow& row : table->rows) row.push_back(cell + std::to_string(i));
        }
    }
    EXPECT_EQ(with({whole}), with({first, second}));
    // One that fits stays whole.
    EXPECT_NE(with({first}), with({second}));
    EXPECT_EQ(pagesOf(with({whole})), 1U);
    // Tables without heads have no columns.
    EXPECT_EQ(pagesOf(with({PageTable{"a caption", "l", {}, {}}})), 1U);
}

TEST(Page, PicturesInPicturesKeepTheirShapes) {
    Picture page(100, 100);
    page.circle({50, 50}, 5, {palette::kInk});
    page.inset(pictureOf(40, 30), {20, 10}, 2);
    const DisplayList& list = page.list();
    ASSERT_EQ(list.shapes.size(), 6U);
    EXPECT_EQ(list.shapes[1].kind, DisplayList::Kind::Group);
    ASSERT_EQ(list.shapes[3].kind, DisplayList::Kind::Area);
    const auto curve = list.curve(list.shapes[3].first);
    ASSERT_EQ(curve.size(), 3U);
    EXPECT_EQ(curve[2], (Point2{40, 30}));
}

}  // namespace page_test
}  // namespace ispace::pages
