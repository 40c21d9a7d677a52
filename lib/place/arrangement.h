// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/history.h"
#include "base/progress.h"
#include "layout/scene.h"
#include "place/candidates.h"

namespace ispace {

/// The keywords of what can be placed.
constexpr std::string_view kArrangedKinds[] = {"laser"};

struct ArrangeOptions {
    std::optional<int> x, y;        ///< interior grid lines; default by eq. (4.1) and (4.2)
    int headings = 8;               ///< directions per place
    int columns = 100, rows = 100;  ///< cells over the limits while searching
};

/// All sensors to be placed: those the scene has without place, then `added`, which get the next
/// free ids of their kind.
/// \throws UsageError if an added record has a place or an id that is taken, FormatError as laserOf
std::vector<PendingLaser> sensorsToPlace(const Scene& scene, const std::vector<Record>& added,
                                         const DeviceCatalogue& devices);

/// Where the sensors stand and what that is worth.
struct Arrangement {
    std::vector<PlacedLaser> placed;  ///< in the order of the sensors given
    double coverage = 0;              ///< as `coverage` reports coverage.grid for the whole layout
    double area = 0;                  ///< total effective area by cells, m2, eq. (4.6)
    /// No choice of the same candidates covers a greater share; 1 where the search had another grid
    /// than the report, as a bound holds for its grid only.
    double bound = 0;
};

/// Ordinary Grid of the thesis (section 4.4.2), sensor after sensor, beside the lasers that the
/// scene has placed already.
/// \throws UnmetError if a sensor has no valid place, UsageError if the candidates do not fit in
///         memory
Arrangement arrangeOnGrid(const Scene& scene, const std::vector<PendingLaser>& sensors,
                          const ArrangeOptions& options, Progress& progress);

/// The record of a pending sensor at its place: `id`, `at` with z and `heading` set.
Record placedRecord(const PendingLaser& sensor, const PlacedLaser& placed);

/// What the layout to be written is made of.
struct LayoutParts {
    History history;
    std::string environment_file;  ///< "" if there is none to name
    std::string environment_digest;
    std::string strategy;
};

/// A `.3dm`: the `environment` record, what `before` (or nothing) holds with its pending sensors
/// placed, the other new sensors, the `result`.
Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<PendingLaser>& sensors, const Arrangement& arrangement);

}  // namespace ispace
