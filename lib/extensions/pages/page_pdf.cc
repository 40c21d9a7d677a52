// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "extensions/pages/page_writer.h"
#include "raster/module/decoded_picture.h"
#include "raster/picture.h"

namespace ispace::pages {

namespace {

// Margins, the column on any paper and the sizes of text, in millimetres; the smallest is above 8
// points.
constexpr double kMargin = 16, kColumn = 178;
constexpr double kBody = 3.5, kSmall = 3, kTitle = 6.2, kHeading = 4.7, kMinSize = 2.9;
constexpr double kLine = 1.42;  // of a text's size

constexpr TextStyle kCaption{kSmall, false, Align::Left, palette::kFaintInk, {}};
constexpr Color kGood = Color::rgb(0x116329), kBad = Color::rgb(0xA40E26);

/// Breaks text into lines of this width, at blanks, or within words that are wider.
std::vector<std::string> brokenLines(std::string_view text, double width, const TextStyle& style) {
    std::vector<std::string> lines;
    std::string line;
    const auto fits = [&](const std::string& some) { return textWidth(some, style) <= width; };
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        std::string word(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        std::string longer = line;
        longer.append(" ").append(word);
        if (!line.empty() && fits(longer)) {
            line = std::move(longer);
            continue;
        }
        if (!line.empty()) lines.push_back(std::exchange(line, {}));
        while (!fits(word)) {
            std::size_t count = word.size();
            while (count > 1 && !fits(word.substr(0, count))) count = count * 9 / 10;
            // Not within a character of several bytes.
            while (count > 1 && count < word.size() &&
                   (static_cast<unsigned char>(word[count]) & 0xC0U) == 0x80U)
                --count;
            if (count == word.size()) break;
            lines.push_back(word.substr(0, count));
            word.erase(0, count);
        }
        line = std::move(word);
    }
    if (!line.empty() || lines.empty()) lines.push_back(std::move(line));
    return lines;
}

struct PaperSize {
    double width = 210, height = 297;  // millimetres
};

PaperSize sizeOf(Paper paper) {
    return paper == Paper::Letter ? PaperSize{215.9, 279.4} : PaperSize{};
}

/// Decodes a logo on white.
Image imageOfLogo(const std::string& bytes) {
    const DecodedPicture decoded = decodePng(bytes, "");
    Image image{decoded.width, decoded.height, {}};
    const auto channels = static_cast<std::size_t>(decoded.channels);
    for (std::size_t i = 0; i < decoded.samples.size(); i += channels) {
        const std::uint8_t* const sample = &decoded.samples[i];
        const std::uint32_t opacity = channels == 4 ? sample[3] : 255;
        std::uint32_t pixel = 0;
        for (std::size_t c = 0; c < 3; ++c)
            pixel = pixel << 8U |
                    (sample[channels < 3 ? 0 : c] * opacity + 255 * (255 - opacity) + 127) / 255;
        image.pixels.push_back(pixel);
    }
    return image;
}

/// Sheets that fill from the top.
class Sheets {
  public:
    Sheets(std::string title, Paper paper) : title_(std::move(title)), size_(sizeOf(paper)) {
        begin();
    }

    /// The left and the lower end of the column.
    [[nodiscard]] double left() const { return (size_.width - kColumn) / 2; }
    [[nodiscard]] double end() const { return size_.height - kMargin; }
    /// Begins a sheet unless the last one is empty.
    void next() {
        if (y_ > kMargin) begin();
    }

    /// Begins a sheet unless this much height is left.
    void need(double height) {
        if (y_ + height > end() && y_ > kMargin) begin();
    }
    void skip(double height) { y_ += height; }
    [[nodiscard]] double y() const { return y_; }
    [[nodiscard]] double maxHeight() const { return end() - kMargin; }
    Picture& sheet() { return sheets_.back(); }
    /// Returns the index of the last sheet.
    [[nodiscard]] std::size_t index() const { return sheets_.size() - 1; }
    /// Returns the share of the last sheet's height that is filled.
    [[nodiscard]] double filled() const { return (y_ - kMargin) / maxHeight(); }
    /// Returns the same of all sheets.
    [[nodiscard]] std::vector<double> allFilled() const {
        std::vector<double> all = filled_;
        all.push_back(filled());
        return all;
    }

    void text(std::string_view text, const TextStyle& style) {
        for (const std::string& line : brokenLines(text, kColumn, style)) {
            need(kLine * style.size);
            sheet().text({left(), y_ + style.size}, line, style);
            y_ += kLine * style.size;
        }
    }

    std::vector<Picture> finish() {
        const TextStyle style{kMinSize, false, Align::Right, palette::kFaintInk, {}};
        for (std::size_t i = 0; i < sheets_.size(); ++i)
            sheets_[i].text({left() + kColumn, size_.height - kMargin / 2},
                            fitText(title_, 0.7 * kColumn, style) + "  ·  " +
                                std::to_string(i + 1) + " / " + std::to_string(sheets_.size()),
                            style);
        return std::move(sheets_);
    }

  private:
    void begin() {
        if (!sheets_.empty()) filled_.push_back(filled());
        sheets_.emplace_back(size_.width, size_.height, PageUnit::Millimetre);
        y_ = kMargin;
    }

    std::string title_;
    PaperSize size_;
    std::vector<Picture> sheets_;
    std::vector<double> filled_;  // of all but the last
    double y_ = 0;
};

/// Columns of a table in millimetres; the widest may be narrower than their text, which breaks.
struct Columns {
    double size = kSmall;  ///< of the text
    double gap = 3;
    std::vector<double> widths = {};
    [[nodiscard]] double total() const {
        double sum = gap * static_cast<double>(widths.size() - 1);
        for (const double width : widths) sum += width;
        return sum;
    }
};

Columns columnsOf(const PageTable& table) {
    Columns columns;
    const auto measure = [&] {
        const TextStyle style{columns.size, false, Align::Left, palette::kInk, {}};
        columns.widths.assign(table.heads.size(), 0);
        const auto add = [&](const TextRow& row) {
            for (std::size_t i = 0; i < std::min(row.size(), columns.widths.size()); ++i)
                columns.widths[i] = std::max(columns.widths[i], textWidth(row[i], style));
        };
        add(table.heads);
        for (const TextRow& row : table.rows) add(row);
    };
    measure();
    if (table.heads.empty() || columns.total() <= kColumn) return columns;
    columns.size = std::max(kMinSize, columns.size * kColumn / columns.total());
    columns.gap = 2;
    measure();
    const double least = 8 * columns.size;
    for (double excess = columns.total() - kColumn; excess > 0;
         excess = columns.total() - kColumn) {
        double& widest = *std::max_element(columns.widths.begin(), columns.widths.end());
        if (widest <= least) break;
        widest = std::max(least, widest - std::min(excess, columns.size));
    }
    return columns;
}

/// Splits a table that is too wide for a sheet, even with broken lines, into tables that each
/// begin with its first column.
std::vector<PageTable> splitTable(const PageTable& table) {
    if (table.heads.size() < 3) return {table};
    constexpr double kMaxWidth = 36, kGap = 2;  // millimetres; wider cells break
    const TextStyle style{kMinSize, false, Align::Left, palette::kInk, {}};
    std::vector<double> widths(table.heads.size());
    const auto add = [&](const TextRow& row) {
        for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i)
            widths[i] = std::max(widths[i], std::min(kMaxWidth, textWidth(row[i], style)) + kGap);
    };
    add(table.heads);
    for (const TextRow& row : table.rows) add(row);
    const double others = std::accumulate(widths.begin() + 1, widths.end(), 0.0);
    const double room = kColumn + kGap - widths.front();
    if (others <= room || room <= kMaxWidth) return {table};
    const double share = others / std::ceil(others / room);  // about as wide as each other
    std::vector<PageTable> parts;
    double width = 0;
    const auto side_of = [&table](std::size_t i) {
        return i < table.sides.size() ? table.sides[i] : table.sides.back();
    };
    for (std::size_t i = 1; i < widths.size(); ++i) {
        if (parts.empty() || width + widths[i] > room || width + widths[i] / 2 > share) {
            parts.push_back({parts.empty() ? table.caption : "",
                             std::string(1, side_of(0)),
                             {table.heads.front()},
                             {},
                             table.tones});
            for (const TextRow& row : table.rows) parts.back().rows.push_back({row.front()});
            width = 0;
        }
        PageTable& part = parts.back();
        part.heads.push_back(table.heads[i]);
        part.sides += side_of(i);
        for (std::size_t k = 0; k < table.rows.size(); ++k)
            part.rows[k].push_back(i < table.rows[k].size() ? table.rows[k][i] : "");
        width += widths[i];
    }
    return parts;
}

/// A part of a line between two blanks or more, with the columns that it takes.
struct Word {
    std::size_t begin = 0, end = 0;
    std::string text;
};

std::vector<Word> wordsOf(std::string_view line) {
    std::vector<Word> words;
    std::size_t column = 0, last = 0;  // last: behind the last character that is no blank
    for (const char c : line) {
        if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) {  // of a character of several bytes
            words.back().text += c;
            continue;
        }
        ++column;
        if (c == ' ') continue;
        if (words.empty() || column - last > 2)
            words.push_back({column - 1, column, ""});
        else if (column - last == 2)
            words.back().text += ' ';
        words.back().text += c;
        words.back().end = last = column;
    }
    return words;
}

/// Returns true if more words of the table's lines end where a word ends than begin where it
/// begins.
bool isRight(const std::vector<std::vector<Word>>& lines, std::size_t line, const Word& word) {
    int begins = 0, ends = 0;
    const auto count = [&](const std::vector<Word>& words) {
        for (const Word& other : words) {
            begins += other.begin == word.begin ? 1 : 0;
            ends += other.end == word.end ? 1 : 0;
        }
    };
    for (std::size_t i = line; i > 0 && !lines[i - 1].empty(); --i) count(lines[i - 1]);
    for (std::size_t i = line; i < lines.size() && !lines[i].empty(); ++i) count(lines[i]);
    return ends > begins;
}

class PdfWriter {
  public:
    /// \param begins_sheet by section: whether it begins a sheet, besides those that always do
    PdfWriter(const ReportPage& page, std::vector<bool> begins_sheet)
        : sheets_(page.title, page.paper), page_(page), begins_sheet_(std::move(begins_sheet)) {}

    /// A sheet that is filled less looks as if something were missing.
    static constexpr double kLeastFilled = 0.3;

    /// Returns the number of sheets that are filled less. \pre sheets() was called
    [[nodiscard]] std::size_t sparseSheets() const {
        return static_cast<std::size_t>(std::count_if(
            filled_.begin(), filled_.end(), [](double filled) { return filled < kLeastFilled; }));
    }
    /// Returns the sections that may fill a sparse sheet if they began it, and would leave enough
    /// on the sheet before, the shortest way first. \pre sheets() was called
    [[nodiscard]] std::vector<std::size_t> sectionsToMove() const {
        std::vector<std::size_t> sections;
        for (std::size_t sheet = 1; sheet < filled_.size(); ++sheet) {
            if (filled_[sheet] >= kLeastFilled) continue;
            for (std::size_t i = begins_.size(); i-- > 0;)
                if (begins_[i].sheet + 1 == sheet && begins_[i].above >= kLeastFilled)
                    sections.push_back(i);
        }
        return sections;
    }

    std::vector<Picture> sheets() {
        addLogo();
        sheets_.text(page_.title, {kTitle, true, Align::Left, palette::kInk, {}});
        sheets_.text(page_.subtitle, kCaption);
        for (const auto& [name, text] : coverLines(page_.cover)) {
            std::string line = name;
            line.append(": ").append(text);
            sheets_.text(line, {kBody, false, Align::Left, palette::kInk, {}});
        }
        for (std::size_t i = 0; i < page_.sections.size(); ++i) {
            const PageSection& section = page_.sections[i];
            // A heading stays with the block below it.
            constexpr double kAbove = 1 + kLine + 0.3;
            if (section.begins_sheet || begins_sheet_[i]) sheets_.next();
            sheets_.need(
                kAbove * kHeading +
                (section.blocks.empty()
                     ? 0
                     : std::visit([this](const auto& one) { return this->leastHeight(one); },
                                  section.blocks.front())));
            begins_.push_back({sheets_.index(), sheets_.filled()});
            sheets_.skip(kHeading);
            sheets_.text(section.title, {kHeading, true, Align::Left, palette::kInk, {}});
            sheets_.skip(0.3 * kHeading);
            addBlocks(section.blocks);
            endRow();
        }
        filled_ = sheets_.allFilled();
        return sheets_.finish();
    }

  private:
    /// Adds blocks in their order, but tables before a figure that leaves much of its sheet empty.
    void addBlocks(const std::vector<PageBlock>& blocks) {
        std::vector<bool> is_added(blocks.size());
        const auto add_one = [&](std::size_t i) {
            std::visit(
                [this](const auto& one) {
                    if constexpr (!std::is_same_v<decltype(one), const PageFigure&>) endRow();
                    add(one);
                },
                blocks[i]);
            is_added[i] = true;
        };
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (is_added[i]) continue;
            for (std::size_t k = i + 1; k < blocks.size() && leavesGap(blocks[i]); ++k) {
                const auto* const table = std::get_if<PageTable>(&blocks[k]);
                if (table != nullptr && !is_added[k] &&
                    sheets_.y() + leastHeight(*table) <= sheets_.end())
                    add_one(k);
            }
            add_one(i);
        }
    }
    /// Returns true for a figure that needs the next sheet though much of this one is empty.
    [[nodiscard]] bool leavesGap(const PageBlock& block) const {
        constexpr double kGap = 0.25;  // of a sheet's height
        const bool is_figure =
            std::holds_alternative<PageFigure>(block) || std::holds_alternative<PageMap>(block);
        if (!is_figure || row_.height > 0) return false;
        const double height =
            std::visit([this](const auto& one) { return this->leastHeight(one); }, block);
        return sheets_.y() + height > sheets_.end() && sheets_.filled() < 1 - kGap;
    }

    /// Draws the logo above the title.
    void addLogo() {
        if (page_.cover.logo.empty()) return;
        constexpr double kMaxWidth = 70, kMaxHeight = 22;
        const Image logo = imageOfLogo(page_.cover.logo);
        const double pixel = std::min(kMaxWidth / logo.width, kMaxHeight / logo.height);
        const double height = pixel * logo.height;
        sheets_.sheet().image({sheets_.left(), sheets_.y()}, logo, pixel, pixel);
        sheets_.skip(height + 3);
    }

    /// The height of the part of a block that must not be broken; at least that part.
    static double leastHeight(const PageTable& whole) {
        const PageTable table = splitTable(whole).front();
        return kLine * (kSmall * static_cast<double>(captionOf(table.caption, kColumn).size()) +
                        4 * columnsOf(table).size);
    }
    static double leastHeight(const PageText& /*text*/) { return 2 * kLine * kBody; }
    static double leastHeight(const PageCode& /*code*/) { return 2 * kLine * kMinSize; }
    [[nodiscard]] double leastHeight(const PageFigure& figure) const {
        if (figure.is_for_screen) return 0;
        const double share = canShrink(figure) ? kMinShare : 1;
        return share * scaleOf(figure) * figure.picture.height() + belowOf(figure);
    }
    [[nodiscard]] double leastHeight(const PageMap& map) const { return leastHeight(map.paper); }

    static std::vector<std::string> captionOf(const std::string& text, double width) {
        return brokenLines(text, width, kCaption);
    }
    /// The height of a figure's caption.
    static double belowOf(const PageFigure& figure) {
        const auto lines = captionOf(figure.caption, figure.width * kColumn).size();
        return kLine * kSmall * static_cast<double>(lines) + 3;
    }
    [[nodiscard]] double scaleOf(const PageFigure& figure) const {
        const Picture& picture = figure.picture;
        const double scale = std::min(figure.width * kColumn / picture.width(),
                                      (sheets_.maxHeight() - belowOf(figure)) / picture.height());
        return picture.unit() == PageUnit::Millimetre ? std::min(1.0, scale) : scale;
    }

    /// Returns true for figures without a scale of their own that fill the column: they shrink to
    /// kMinShare to fit the rest of a sheet.
    static bool canShrink(const PageFigure& figure) {
        return figure.width == 1 && figure.picture.unit() != PageUnit::Millimetre;
    }
    static constexpr double kMinShare = 0.75;

    void add(const PageText& text) {
        const bool is_small = text.tone == Tone::Small;
        sheets_.text(text.text,
                     {is_small ? kSmall : kBody, false, Align::Left, inkOf(text.tone), {}});
        sheets_.skip(1);
    }

    static Color inkOf(Tone tone) {
        switch (tone) {
            case Tone::Good:
                return kGood;
            case Tone::Bad:
                return kBad;
            case Tone::Small:
                return palette::kFaintInk;
            case Tone::Plain:
                break;
        }
        return palette::kInk;
    }

    void add(const PageTable& whole) {
        for (const PageTable& table : splitTable(whole)) addPart(table);
    }
    void addPart(const PageTable& table) {
        const Columns columns = columnsOf(table);
        sheets_.need(leastHeight(table));
        sheets_.text(table.caption, kCaption);
        addRow(table, columns, table.heads, palette::kFaintInk);
        for (std::size_t k = 0; k < table.rows.size(); ++k) {
            if (sheets_.y() + 2 * kLine * columns.size > sheets_.end()) {
                sheets_.next();
                addRow(table, columns, table.heads, palette::kFaintInk);
            }
            addRow(table, columns, table.rows[k],
                   inkOf(k < table.tones.size() ? table.tones[k] : Tone::Plain));
        }
        sheets_.skip(2);
    }

    void addRow(const PageTable& table, const Columns& columns, const TextRow& row, Color ink) {
        TextStyle style{columns.size, false, Align::Left, ink, {}};
        std::vector<std::vector<std::string>> cells;
        std::size_t lines = 1;
        for (std::size_t i = 0; i < std::min(row.size(), columns.widths.size()); ++i) {
            cells.push_back(brokenLines(row[i], columns.widths[i] + 0.01, style));
            lines = std::max(lines, cells.back().size());
        }
        const double height = kLine * columns.size * static_cast<double>(lines);
        sheets_.need(height);
        double x = sheets_.left();
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const char side = i < table.sides.size() ? table.sides[i] : table.sides.back();
            style.align = side == 'r' ? Align::Right : Align::Left;
            double base = sheets_.y() + columns.size;
            for (const std::string& line : cells[i]) {
                sheets_.sheet().text({side == 'r' ? x + columns.widths[i] : x, base}, line, style);
                base += kLine * columns.size;
            }
            x += columns.widths[i] + columns.gap;
        }
        sheets_.skip(height);
        sheets_.sheet().line({sheets_.left(), sheets_.y() - 0.1},
                             {sheets_.left() + kColumn, sheets_.y() - 0.1},
                             {palette::kObjectEdge.faded(0.5), 0.08});
    }

    /// Lines with columns are set in their columns, as narrow as the widest line requires; others
    /// are broken.
    void add(const PageCode& code) {
        TextStyle style{kMinSize, false, Align::Left, palette::kInk, {}};
        std::vector<std::vector<Word>> lines;
        std::size_t longest = 1;
        bool is_table = false;
        for (std::string_view text = code.text; !text.empty();) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            lines.push_back(wordsOf(text.substr(0, end)));
            text.remove_prefix(std::min(end + 1, text.size()));
            if (lines.back().size() < 2) continue;
            is_table = true;
            longest = std::max(longest, lines.back().back().end);
        }
        const double column = textWidth("0", style);
        if (is_table) style.size *= std::min(1.0, kColumn / column / static_cast<double>(longest));
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (lines[i].size() < 2 && (!is_table || lines[i].empty() || lines[i][0].begin == 0)) {
                sheets_.text(lines[i].empty() ? "" : lines[i][0].text, style);
                continue;
            }
            sheets_.need(kLine * style.size);
            for (const Word& word : lines[i]) {
                style.align = isRight(lines, i, word) ? Align::Right : Align::Left;
                const std::size_t at = style.align == Align::Right ? word.end : word.begin;
                sheets_.sheet().text(
                    {sheets_.left() + static_cast<double>(at) * textWidth("0", style),
                     sheets_.y() + style.size},
                    word.text, style);
            }
            style.align = Align::Left;
            sheets_.skip(kLine * style.size);
        }
        sheets_.skip(1.5);
    }

    /// Figures stand beside each other as long as their widths fit.
    void add(const PageFigure& figure) {
        if (figure.is_for_screen) return;
        const double width = figure.width * kColumn;
        const Picture& picture = figure.picture;
        const double least = leastHeight(figure);
        if (row_.right + width > kColumn || sheets_.y() + least > sheets_.end()) endRow();
        if (row_.height == 0) sheets_.need(least);
        double scale = scaleOf(figure);
        if (canShrink(figure))
            scale =
                std::min(scale, (sheets_.end() - sheets_.y() - belowOf(figure)) / picture.height());
        const double height = scale * picture.height() + belowOf(figure);
        const Point2 corner{sheets_.left() + row_.right, sheets_.y()};
        sheets_.sheet().inset(picture, corner, scale);
        double base = corner.y + scale * picture.height() + 1 + kSmall;
        for (const std::string& line : captionOf(figure.caption, width)) {
            sheets_.sheet().text({corner.x, base}, line, kCaption);
            base += kLine * kSmall;
        }
        constexpr double kGap = 3;
        row_ = {row_.right + width + kGap, std::max(row_.height, height)};
    }

    /// Continues below the figures of a row.
    void endRow() {
        sheets_.skip(row_.height);
        row_ = {};
    }

    void add(const PageMap& map) { add(map.paper); }

    /// The figures beside each other at the end of the sheet, in millimetres.
    struct Row {
        double right = 0, height = 0;
    };

    /// Where a section begins.
    struct Begin {
        std::size_t sheet = 0;
        double above = 0;  ///< share of the sheet that is filled above it
    };

    Sheets sheets_;
    const ReportPage& page_;
    std::vector<bool> begins_sheet_;
    Row row_;
    std::vector<Begin> begins_;   // by section
    std::vector<double> filled_;  // by sheet
};

}  // namespace

std::vector<Picture> sheetsOf(const ReportPage& page) {
    std::vector<bool> begins_sheet(page.sections.size());
    auto writer = std::make_unique<PdfWriter>(page, begins_sheet);
    std::vector<Picture> sheets = writer->sheets();
    const auto fill_one = [&] {
        for (const std::size_t moved : writer->sectionsToMove()) {
            std::vector<bool> more = begins_sheet;
            more[moved] = true;
            auto next = std::make_unique<PdfWriter>(page, more);
            std::vector<Picture> others = next->sheets();
            if (next->sparseSheets() >= writer->sparseSheets()) continue;
            begins_sheet = more;
            sheets = std::move(others);
            writer = std::move(next);
            return true;
        }
        return false;
    };
    while (fill_one()) {
    }
    return sheets;
}

std::string pdfOf(const ReportPage& page) { return writePdf(sheetsOf(page)); }

}  // namespace ispace::pages
