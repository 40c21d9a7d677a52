// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "env/environment.h"
#include "geom/pose.h"

namespace ispace {

/// A place with the headings to try there: distinct, the preferred first among equals.
struct Site {
    Point2 place;
    std::vector<Angle> headings;
    friend bool operator==(const Site&, const Site&) = default;
};

/// A site with these headings at each place.
std::vector<Site> sitesAt(const std::vector<Point2>& places, const std::vector<Angle>& headings);

/// `count` headings 360 / count apart, the first 0.
std::vector<Angle> headingsAround(int count);

/// Limit of the places that a strategy proposes at one height.
constexpr double kMaxSites = 1e6;

// ---- Strategies of the thesis

/// "seg" of eq. (4.1) and (4.2): grid lines within the greatest range.
constexpr double kSegments = 5;

/// Density of the thesis' Ordinary Grid (section 4.4.2).
struct GridSearch {
    int x = 1, y = 1;  ///< interior grid lines along x and y
};

/// Eq. (4.1) and (4.2), rounded down, at least 1.
GridSearch defaultGridSearch(const Box2& limits, double max_range);

/// The x * y crossings x_i = xmin + i (xmax - xmin) / (X + 1), i = 1..X, likewise y; y runs
/// slowest.
std::vector<Point2> gridPlaces(const Box2& limits, const GridSearch& search);

/// Along Wall (section 4.4.5): on every wall that reaches this height the `times` places k / (times
/// + 1) of the way along it, k = 1..times, `dist` from it along the inner normal, which is their
/// heading. Table 5.2 fits these interior points, which eq. (4.1) has on the grid as well. Walls
/// are the lines of the indoor region's outline and holes, from corner to corner: collinear pieces,
/// as where another wall ends, are one wall. Walls within the indoor region, as between rooms
/// joined by open doors, count on both sides, thick ones with their faces. Open doors count only
/// where they lead out.
///
/// "At the end of the wall line vector, concavity environment may ask for more candidates of
/// orientation", says the thesis, and not which, nor how far an end goes. Here the first and the
/// last third of a wall's places (rounded down, at least one) have two more headings: halfway to
/// the neighbouring wall's normal, and that normal. Behind a corner that juts into the room, part
/// of it lies beyond the wall's line, out of view of a sensor of 180 degrees that faces the normal;
/// in a corner of the room a sensor of less than 180 degrees sees more when it faces across. That
/// an end is a third is read off the thesis' times, at its 320 beams a second and 181 beams a scan:
/// 21 places on each of four walls then have 196 headings, 2.3 a place, and take 111 s (table 4.1:
/// 1 min 50 s), 11 on each of five 115 and 65 s (table 5.2: 1 min 10 s). The normals alone would
/// take 48 s and 31 s, three headings at each place 143 s and 93 s. Table 5.2's poses come out of
/// all three.
///
/// Not tested for validity: a place may lie beyond another wall. O(n (log n + times)) for n lines
/// \pre times >= 0 \throws UsageError for more than kMaxSites
std::vector<Site> wallSites(const Environment& environment, double height, double dist, int times);

/// A sequence of random places of its own: for a kind of sensor, and its n-th sensor.
struct RandomSequence {
    std::uint64_t seed = 0;
    std::string id;            ///< of the kind
    std::uint64_t sensor = 0;  ///< < 2^31
};
/// Hierarchical Random (section 4.4.3): place k of a sequence, anywhere within limits, or in the
/// disc of radius `scope` about `center`, both evenly over the area. The same for any number of
/// threads. For places that are not valid the caller draws again with the next k. \pre k < 2^54
Point2 randomPlace(const Box2& limits, const RandomSequence& sequence, std::uint64_t k);
Point2 randomPlaceAbout(Point2 center, double scope, const RandomSequence& sequence,
                        std::uint64_t k);

// ---- Denser candidates

/// Points of a lattice with this step that begins step / 2 inside the limits' lower corner, below
/// the upper one; y runs slowest. \pre step > 0 \throws UsageError for more than kMaxSites
std::vector<Point2> latticePlaces(const Box2& limits, double step);

/// About every `step` along the walls of the indoor region and the objects that touch or stand in
/// it at this height, `off` from them on the free side: outline and holes of the free floor, edges
/// in order. Places are spread evenly over lines of at least `step`, half a distance from the ends;
/// consecutive shorter ones, of round and ragged objects, share theirs. Places may lie beyond
/// another wall. Also on both sides of those `sheets` that stand in the free floor and are not part
/// of its boundary: walls without thickness, as between rooms joined by open doors.
/// \pre step > 0 \throws UsageError for more than kMaxSites
std::vector<Point2> placesAlong(const std::vector<Region>& free_floor, double step, double off,
                                std::span<const Segment2> sheets = {});

/// Along the medial axis of the free floor, one about every `step`: where the nearest walls lie on
/// different sides, seen at least about 90 degrees apart (a right-angled corner of a room still
/// counts), and no nearer than step / 3.
///
/// Voronoi vertices of samples of the boundary, step / 3 apart, of which those whose samples are
/// seen at a wide angle are near the axis (Dey and Zhao, Approximating the medial axis from the
/// Voronoi diagram with a convergence guarantee, 2004); one in each square of a lattice of `step`,
/// the farthest from all walls; `sheets` in the free floor are walls too. The squares row by row
/// from the lower left. A moved plan has the same places, moved. O(n log n) for n samples.
/// \pre step > 0 \throws UsageError for more than some million samples
std::vector<Point2> medialPlaces(const std::vector<Region>& free_floor, double step,
                                 std::span<const Segment2> sheets = {});

/// Sensors under a bar hang this far below it, in metres: bars are closed.
constexpr double kUnderBar = 0.01;
/// Under the bars of all `infra` frames, about every `step` along each bar, kUnderBar below it. In
/// the order of the records, rows before columns. \pre step > 0 \throws UsageError for more than
/// kMaxSites
std::vector<Point3> framePlaces(const Environment& environment, double step);

// ---- Which places are valid

/// Where sensors may stand. Distances hold to within a micrometre (kWeldDistance), in the place's
/// favour: a place at exactly the required distance is valid.
struct SiteRules {
    double height = kScanHeight;
    bool judges_inside = true;      ///< the thesis' Insider Judge: indoors only
    double clearance = 0;           ///< least distance from walls and objects at this height
    std::vector<Polygon> keep_out;  ///< closed
    std::vector<Polygon> keep_in;   ///< closed; if any: in one of them
    /// Maximum distance from a wall that reaches this height (mounted on it).
    std::optional<double> wall_within;
};

/// The validity test for places. Thread-safe once built. O(log n) typically.
class SiteValidity {
  public:
    SiteValidity(const Environment& environment, SiteRules rules);
    ~SiteValidity();
    SiteValidity(const SiteValidity&) = delete;
    SiteValidity& operator=(const SiteValidity&) = delete;
    /// Strictly indoors (the thesis' Insider Judge) unless the rules say otherwise, in no solid and
    /// on no wall at the height, and within the rules. Exact, except for distances.
    [[nodiscard]] bool isValid(Point2 place) const;

  private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

/// The valid sites, in order; tested in parallel. Each place occurs once, where it came first, with
/// the headings of all its sites.
std::vector<Site> validSites(const SiteValidity& validity, const std::vector<Site>& sites,
                             Progress& progress);

/// A list of candidates from a CSV text: `x,y` or `x,y,heading` a line, in metres and degrees; `#`
/// begins a comment; a header line `x,y…` is skipped. Lines without heading get `headings`; lines
/// with the same place are one site, where it came first.
/// \throws FormatError with line and column of all errors
std::vector<Site> readSites(const std::string& text, const std::string& name,
                            const std::vector<Angle>& headings);

}  // namespace ispace
