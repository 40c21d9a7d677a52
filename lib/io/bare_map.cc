// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bare_map.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/cell_map.h"
#include "io/import_records.h"
#include "raster/occupancy.h"
#include "raster/picture.h"

namespace ispace {

namespace {

/// Pixels with less opacity show what is behind them.
constexpr std::uint8_t kOpaque = 128;
/// What map_server writes for unknown, of 255.
constexpr int kUnknown = 205;

/// Transparent pixels as unknown ones, and no opacity any more.
GreyPicture onUnknown(GreyPicture image) {
    const auto unknown = static_cast<std::uint16_t>(image.max_value * kUnknown / 255);
    for (std::size_t i = 0; i < image.opacity.size(); ++i)
        if (image.opacity[i] < kOpaque) image.samples[i] = unknown;
    image.opacity.clear();
    return image;
}

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

struct GridCells {
    MapCells free, occupied;
};

class GridMapReader {
  public:
    GridMapReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

    GridCells read(ImportRecords& out) {
        if (const std::string_view type = header("type"); type != "octile")
            fail("found type " + excerpt(type) + ", wanted `type octile`");
        const int height = count("height"), width = count("width");
        // Each cell takes a byte, so the file bounds what is allocated.
        if (std::int64_t{width} * height > static_cast<std::int64_t>(rest_.size()))
            fail("truncated: " + std::to_string(rest_.size()) + " bytes do not hold " +
                 std::to_string(width) + " x " + std::to_string(height) + " cells");
        nextLine();
        if (line_text_ != "map") fail("found " + excerpt(line_text_) + ", wanted `map`");
        GridCells cells{MapCells(width, height), MapCells(width, height)};
        for (int y = height - 1; y >= 0; --y) readRow(y, cells);
        nextLine();
        if (!line_text_.empty() || !rest_.empty()) checkTail(height);
        if (cells.free.count() == 0) fail("no cell of ground (. G or S)");
        note(out);
        return cells;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError(Diagnostic{displayName(name_), line_, 1, message});
    }

    void nextLine() {
        ++line_;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line_text_ = trimmed(rest_.substr(0, end));
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
    }

    std::string_view header(std::string_view key) {
        nextLine();
        const std::size_t end = std::min(line_text_.find_first_of(kBlanks), line_text_.size());
        if (line_text_.substr(0, end) != key)
            fail("found " + excerpt(line_text_) + ", wanted `" + std::string(key) + '`');
        return trimmed(line_text_.substr(end));
    }

    int count(std::string_view key) {
        const std::string_view text = header(key);
        const auto value = parseInteger(text);
        if (!value || *value < 1 || *value > INT32_MAX)
            fail("found " + std::string(key) + ' ' + excerpt(text) + ", wanted a number of cells");
        return static_cast<int>(*value);
    }

    void readRow(int y, GridCells& cells) {
        if (rest_.empty())
            fail("truncated: " + std::to_string(cells.free.height() - 1 - y) + " of " +
                 std::to_string(cells.free.height()) + " rows");
        nextLine();
        if (line_text_.size() != static_cast<std::size_t>(cells.free.width()))
            fail("a row of " + countText(line_text_.size(), "cell") + ", wanted " +
                 std::to_string(cells.free.width()));
        for (int x = 0; x < cells.free.width(); ++x) {
            const char c = line_text_[static_cast<std::size_t>(x)];
            if (c == '.' || c == 'G' || c == 'S')
                cells.free.insert(x, y);
            else if (std::string_view("@OTW").find(c) != std::string_view::npos)
                cells.occupied.insert(x, y);
            else
                fail("found " + excerpt(line_text_.substr(static_cast<std::size_t>(x), 1)) +
                     " in a row, wanted one of . G S @ O T W");
            swamp_ += c == 'S' ? 1 : 0;
            water_ += c == 'W' ? 1 : 0;
        }
    }

    void checkTail(int height) const {
        if (!line_text_.empty() || rest_.find_first_not_of(" \t\r\n") != std::string_view::npos)
            fail("more than " + std::to_string(height) + " rows");
    }

    void note(ImportRecords& out) const {
        if (swamp_ > 0) out.note(countText(swamp_, "cell") + " of swamp can be walked: floor");
        if (water_ > 0) out.note(countText(water_, "cell") + " of water count as walls");
    }

    std::string_view rest_, line_text_;
    const std::string& name_;
    int line_ = 0;
    std::size_t swamp_ = 0, water_ = 0;
};

}  // namespace

Document readBarePicture(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas) {
    const auto fail = [&name](const std::string& message) {
        throw FormatError(Diagnostic{displayName(name), 0, 0, message});
    };
    if (!options.resolution)
        fail(
            "a picture does not say how large its pixels are: say it with `envc --resolution M` "
            "(metres a pixel), or name the map.yaml that goes with it");
    const auto read_cells = [&]() -> CellMap {
        const GreyPicture image = onUnknown(parsePicture(bytes, name));
        checkCellMap(image.width, image.height, *options.resolution, name);
        return {freeCells(image, {}), occupiedCells(image, {}), *options.resolution,
                options.origin};
    };
    ImportRecords out(schemas, name, options);
    writeCellMap(read_cells(),
                 {name, "what is white is free; with a map.yaml, `negate: 1` turns that about"},
                 options, out);
    return out.take();
}

bool isGridMap(std::string_view bytes) {
    const std::string_view line =
        trimmed(bytes.substr(0, std::min(bytes.find('\n'), bytes.size())));
    return line.starts_with("type ") && line.find(':') == std::string_view::npos &&
           line.find('=') == std::string_view::npos;
}

Document readGridMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    GridCells cells = GridMapReader(bytes, name).read(out);
    const double resolution = options.resolution.value_or(1);
    checkCellMap(cells.free.width(), cells.free.height(), resolution, name);
    writeCellMap({std::move(cells.free), std::move(cells.occupied), resolution, options.origin},
                 {name, "ground is . G or S"}, options, out);
    return out.take();
}

}  // namespace ispace
