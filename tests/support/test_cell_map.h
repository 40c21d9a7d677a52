// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of maps of cells: drawings in metres, and the results of their import.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/map/cell_map.h"
#include "scene/placement_schemas.h"

namespace ispace::testing {

/// The result of importing cells.
struct Imported {
    std::vector<Polygon> fences;
    std::vector<Point2> inside;
    std::vector<std::string> notes, warnings;

    /// Returns the area of all fences less their holes, which run clockwise.
    [[nodiscard]] double area() const {
        double sum = 0;
        for (const Polygon& fence : fences) sum += signedArea(fence);
        return sum;
    }
    [[nodiscard]] std::size_t vertices() const {
        std::size_t count = 0;
        for (const Polygon& fence : fences) count += fence.size();
        return count;
    }
    [[nodiscard]] bool warns(const std::string& what) const {
        for (const std::string& warning : warnings)
            if (warning.find(what) != std::string::npos) return true;
        return false;
    }
};

inline Imported import(const CellMap& map, const ImportOptions& options = {}) {
    ImportRecords out(sceneSchemas(), "map", options);
    writeCellMap(map, {"map.png", "no hint"}, options, out);
    const Document document = out.take();
    Imported result;
    for (const Record& record : document.records) {
        if (record.keyword() == "inside") {
            const Tuple& at = record.tuple("at");
            result.inside.push_back({at[0], at[1]});
            continue;
        }
        Polygon& fence = result.fences.emplace_back();
        for (const Tuple& p : record.list("path")) fence.push_back({p[0], p[1]});
    }
    result.notes = document.notes;
    for (const Diagnostic& warning : document.warnings) result.warnings.push_back(warning.message);
    return result;
}

inline std::string errorOf(const CellMap& map, const ImportOptions& options) {
    try {
        import(map, options);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

/// A picture of free cells of 0.05 m, origin in its lower left corner, with drawing functions in
/// metres.
class Drawing {
  public:
    Drawing(double width, double height)
        : map_{MapCells(cells(width), cells(height)),
               MapCells(cells(width), cells(height)),
               kCell,
               {}} {
        fill(0, 0, width, height, true);
    }
    /// Rooms are free, walls occupied.
    void fill(double left, double low, double right, double high, bool is_free) {
        for (int y = cells(low); y < cells(high); ++y)
            for (int x = cells(left); x < cells(right); ++x) {
                map_.free.erase(x, y);
                map_.occupied.erase(x, y);
                (is_free ? map_.free : map_.occupied).insert(x, y);
            }
    }
    /// A room with walls of 0.1 m around it.
    void room(double left, double low, double right, double high) {
        fill(left - 0.1, low - 0.1, right + 0.1, high + 0.1, false);
        fill(left, low, right, high, true);
    }
    void unknown() { map_.free = MapCells(map_.free.width(), map_.free.height()); }
    [[nodiscard]] const CellMap& map() const { return map_; }
    [[nodiscard]] CellMap& map() { return map_; }

  private:
    static constexpr double kCell = 0.05;
    static int cells(double metres) { return static_cast<int>(std::lround(metres / kCell)); }
    CellMap map_;
};

}  // namespace ispace::testing
