// SPDX-License-Identifier: GPL-3.0-or-later
// The cells as arrays of NumPy.
#include <vector>

#include "base/numpy_file.h"
#include "cover/coverage_formats.h"

namespace ispace {

namespace {

std::vector<std::uint64_t> shapeOf(const Grid& grid) {
    return {static_cast<std::uint64_t>(grid.rows), static_cast<std::uint64_t>(grid.columns)};
}

std::string flags(const Grid& grid, const CellSet& cells) {
    std::string bytes(grid.size(), '\0');
    cells.forEach([&bytes](std::size_t cell) { bytes[cell] = 1; });
    return npyHeader("|b1", shapeOf(grid)) + bytes;
}

template <typename Center>
std::string centers(int count, Center center) {
    std::string bytes = npyHeader("<f8", std::vector{static_cast<std::uint64_t>(count)});
    for (int i = 0; i < count; ++i) appendLittle(bytes, center(i));
    return bytes;
}

}  // namespace

std::string coverageNpy(const Coverage& coverage) {
    const Target& target = coverage.target;
    std::string bytes = npyHeader("<i4", shapeOf(target.grid));
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    for (std::size_t cell = 0; cell < times.size(); ++cell)
        appendLittle(bytes, target.indoor.test(cell) ? static_cast<std::int32_t>(times[cell]) : -1);
    return bytes;
}

std::string coverageNpz(const Coverage& coverage) {
    const Target& target = coverage.target;
    const Grid& grid = target.grid;
    std::string out;
    ZipWriter zip([&out](std::string_view bytes) { out += bytes; });
    std::string seen = npyHeader("<u4", shapeOf(grid));
    for (const std::uint32_t count : timesSeen(coverage)) appendLittle(seen, count);
    zip.add("seen.npy", seen);
    zip.add("indoor.npy", flags(grid, target.indoor));
    zip.add("free.npy", flags(grid, target.free));
    zip.add("x.npy", centers(grid.columns, [&](int i) { return grid.columnCenter(i); }));
    zip.add("y.npy", centers(grid.rows, [&](int i) { return grid.rowCenter(i); }));
    if (!coverage.report.densities.indoor.empty()) {
        std::vector<double> densities(grid.size());
        for (std::size_t i = 0; i < pixelDensities().size(); ++i)
            cellsOfClass(coverage, i).forEach([&](std::size_t cell) {
                densities[cell] = pixelDensities()[i].pixels_per_metre;
            });
        std::string bytes = npyHeader("<f8", shapeOf(grid));
        for (const double density : densities) appendLittle(bytes, density);
        zip.add("density.npy", bytes);
    }
    zip.finish();
    return out;
}

}  // namespace ispace
