// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"
#include "base/number.h"
#include "cover/coverage_files.h"

namespace ispace {

namespace {

constexpr char kFree = static_cast<char>(254), kUnknown = static_cast<char>(205), kOccupied = 0;

}  // namespace

CoverageRosMap coverageRosMap(const Coverage& coverage, double cell,
                              const std::string& image_name) {
    const Target& target = coverage.target;
    const Grid& grid = target.grid;
    const CellSet covered = coveredCells(coverage);
    CoverageRosMap map;
    JsonWriter name;  // JSON's strings are YAML's
    name.value(image_name);
    map.yaml = "image: " + name.take() + "\nmode: trinary\nresolution: " + formatDouble(cell) +
               "\norigin: [" + formatDouble(grid.limits.low.x) + ", " +
               formatDouble(grid.limits.low.y) +
               ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    map.pgm = "P5\n" + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n";
    map.pgm.reserve(map.pgm.size() + grid.size());
    for (int row = grid.rows; row-- > 0;)
        for (int column = 0; column < grid.columns; ++column) {
            const std::size_t at = grid.cell(column, row);
            map.pgm += !target.free.test(at) ? kOccupied : covered.test(at) ? kFree : kUnknown;
        }
    return map;
}

}  // namespace ispace
