// SPDX-License-Identifier: GPL-3.0-or-later
// Reads grid maps of MovingAI (N. Sturtevant, Benchmarks for grid-based pathfinding, 2012), y
// upwards from the last row.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "extensions/maps/maps.h"
#include "io/import_records.h"
#include "io/map/cell_map.h"
#include "record/text.h"

namespace ispace::maps {

namespace {

struct GridCells {
    MapCells free, occupied;
};

class GridMapReader {
  public:
    GridMapReader(std::string_view bytes, const std::string& name)
        : size_(bytes.size()), lines_(bytes), name_(name) {}

    GridCells read(ImportRecords& out) {
        if (const std::string_view type = header("type"); type != "octile")
            fail("found type " + excerpt(type) + ", wanted `type octile`");
        const int height = count("height"), width = count("width");
        // Each cell takes a byte, so the file size bounds the allocation.
        if (std::int64_t{width} * height > static_cast<std::int64_t>(size_))
            fail("truncated: " + std::to_string(size_) + " bytes do not hold " +
                 std::to_string(width) + " x " + std::to_string(height) + " cells");
        if (nextLine(); text_ != "map") fail("found " + excerpt(text_) + ", wanted `map`");
        GridCells cells{MapCells(width, height), MapCells(width, height)};
        for (int y = height - 1; y >= 0; --y) readRow(y, cells);
        while (nextLine())
            if (!text_.empty()) fail("more than " + std::to_string(height) + " rows");
        if (cells.free.count() == 0) fail("no cell of ground (. G or S)");
        note(out);
        return cells;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        failFile(name_, message, lines_.number());
    }

    bool nextLine() {
        const auto line = lines_.next();
        text_ = trimmed(line.value_or(""));
        return line.has_value();
    }

    std::string_view header(std::string_view key) {
        nextLine();
        const std::size_t end = std::min(text_.find_first_of(" \t"), text_.size());
        if (text_.substr(0, end) != key)
            fail("found " + excerpt(text_) + ", wanted `" + std::string(key) + '`');
        return trimmed(text_.substr(end));
    }

    int count(std::string_view key) {
        const std::string_view text = header(key);
        const auto value = parseInteger(text);
        if (!value || *value < 1 || *value > INT32_MAX)
            fail("found " + std::string(key) + ' ' + excerpt(text) + ", wanted a number of cells");
        return static_cast<int>(*value);
    }

    void readRow(int y, GridCells& cells) {
        if (!nextLine())
            fail("truncated: " + std::to_string(cells.free.height() - 1 - y) + " of " +
                 std::to_string(cells.free.height()) + " rows");
        if (text_.size() != static_cast<std::size_t>(cells.free.width()))
            fail("a row of " + countText(text_.size(), "cell") + ", wanted " +
                 std::to_string(cells.free.width()));
        for (int x = 0; x < cells.free.width(); ++x) {
            const char c = text_[static_cast<std::size_t>(x)];
            if (c == '.' || c == 'G' || c == 'S')
                cells.free.insert(x, y);
            else if (std::string_view("@OTW").find(c) != std::string_view::npos)
                cells.occupied.insert(x, y);
            else
                fail("found " + excerpt(text_.substr(static_cast<std::size_t>(x), 1)) +
                     " in a row, wanted one of . G S @ O T W");
            swamp_ += c == 'S' ? 1 : 0;
            water_ += c == 'W' ? 1 : 0;
        }
    }

    void note(ImportRecords& out) const {
        if (swamp_ > 0) out.note(countText(swamp_, "cell") + " of swamp can be walked: floor");
        if (water_ > 0) out.note(countText(water_, "cell") + " of water count as walls");
    }

    std::size_t size_;
    LineReader lines_;
    std::string_view text_;  // of the line
    const std::string& name_;
    std::size_t swamp_ = 0, water_ = 0;
};

}  // namespace

bool isGridMap(std::string_view bytes) {
    const std::string_view line = trimmed(bytes.substr(0, bytes.find('\n')));
    return line.starts_with("type ") && line.find(':') == std::string_view::npos &&
           line.find('=') == std::string_view::npos;
}

Document readGridMap(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    GridCells cells = GridMapReader(bytes, name).read(out);
    const double resolution = options.resolution.value_or(1);
    checkCellMap(cells.free.width(), cells.free.height(), resolution, name, options.max_work);
    ImportOptions exact = options;  // the cells are a game map, not noisy measurements
    exact.simplify = options.simplify.value_or(0);
    writeCellMap({std::move(cells.free), std::move(cells.occupied), resolution, options.origin},
                 {name, "ground is . G or S"}, exact, out);
    return out.take();
}

std::span<const Importer> mapImporters() {
    static constexpr Importer kRows[] = {
        importer<isAriaMap, readAriaMap>("an ARIA map"),
        importer<isGridMap, readGridMap>("a MovingAI map"),
    };
    return kRows;
}

}  // namespace ispace::maps
