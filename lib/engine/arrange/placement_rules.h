// SPDX-License-Identifier: GPL-3.0-or-later
// Sites of candidates: positions that the strategies propose, and the rules that they must pass.
//
// Strategies propose sites without regard to bodies; SiteValidity then decides, exactly for inside
// and outside, to within kWeldDistance for distances. Counts of sites along lines have tolerances,
// so that a plan that is moved has as many, in spite of rounding. Functions are pure and
// thread-safe; positions are metres in the frame of the room.
//
// The thesis' strategies follow its section 4.4, the medial axis Dey and Zhao.
//
//     const SiteValidity validity(environment, {.height = 0.15, .clearance = 0.3});
//     bool is_complete = true;
//     std::vector<Site> sites = sitesAt(latticePlaces(environment.limits(), 0.25),
//                                       headingsAround(16));
//     sites = validSites(validity, std::move(sites), progress, is_complete);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "env/environment.h"
#include "geom/pose.h"

namespace ispace {

/// A position with the headings to try there: distinct; among equal views the first wins. Height
/// and tilt are those of the mount.
struct Site {
    Point2 place;
    std::vector<Angle> headings;
    friend bool operator==(const Site&, const Site&) = default;
};

/// Creates a site with these headings at each position.
std::vector<Site> sitesAt(const std::vector<Point2>& places, const std::vector<Angle>& headings);

/// Returns `count` headings 360 / count apart, the first 0; empty for no count.
std::vector<Angle> headingsAround(int count);

/// Maximum number of sites that a strategy proposes at one height.
constexpr double kMaxSites = 1e6;

// ---- Strategies of the thesis

/// "seg" of eq. (4.1) and (4.2): grid lines within the greatest range.
constexpr double kSegments = 5;

/// Density of the thesis' Ordinary Grid (section 4.4.2).
struct GridSearch {
    int x = 1, y = 1;  ///< interior grid lines along x and y
};

/// Computes eq. (4.1) and (4.2), rounded down, at least 1.
GridSearch defaultGridSearch(const Box2& limits, double max_range);

/// Returns the x * y crossings x_i = xmin + i (xmax - xmin) / (X + 1), i = 1..X, likewise y; y runs
/// slowest. \pre both numbers are positive, and their product is at most kMaxSites
std::vector<Point2> gridPlaces(const Box2& limits, const GridSearch& search);

/// Along Wall (section 4.4.5): returns `times` sites on every wall that reaches this height, k /
/// (times + 1) of the way along it, k = 1..times, `dist` from it along the inner normal, which is
/// their heading. Table 5.2 fits these interior points, which eq. (4.1) has on the grid as well.
/// Walls are the lines of the indoor region's outline and holes, from corner to corner: collinear
/// pieces, as where another wall ends, are one wall. Walls within the indoor region, as between
/// rooms joined by open doors, count on both sides, thick ones with their faces. Open doors count
/// only where they lead out.
///
/// "At the end of the wall line vector, concavity environment may ask for more candidates of
/// orientation", says the thesis, but neither the orientations nor the length of an end. Here the
/// first and the last third of a wall's sites (rounded down, at least one) have two more headings:
/// halfway to the neighbouring wall's normal, and that normal. Behind a corner that juts into the
/// room, part of it lies beyond the wall's line, out of view of a sensor of 180 degrees that faces
/// the normal; in a corner of the room a sensor of less than 180 degrees sees more when it faces
/// across. The third follows from the thesis' times, at its 320 beams a second and 181 beams a
/// scan: 21 sites on each of four walls then have 196 headings, 2.3 per site, and take 111 s (table
/// 4.1: 1 min 50 s), 11 on each of five 115 and 65 s (table 5.2: 1 min 10 s). The normals alone
/// would take 48 s and 31 s, three headings at each site 143 s and 93 s. Table 5.2's poses are
/// found with all three.
///
/// Sites are not validated: one may lie beyond another wall. O(n (log n + times)) for n lines
/// \pre times >= 0
/// \throws UsageError for more than kMaxSites
std::vector<Site> wallSites(const Environment& environment, double height, double dist, int times);

/// Identifies a sequence of random points: one for each sensor of a kind.
struct RandomSequence {
    std::uint64_t seed = 0;
    std::string id;            ///< of the kind
    std::uint64_t sensor = 0;  ///< < 2^31
};
/// Hierarchical Random (section 4.4.3): returns point k of a sequence, anywhere within limits, or
/// in the disc of radius `scope` about `center`, both uniform over the area. Independent of the
/// number of threads. After an invalid point the caller draws again with the next k. A coordinate
/// has 48 random bits. Points about a centre may lie outside the limits.
/// \pre k < 2^54
Point2 randomPlace(const Box2& limits, const RandomSequence& sequence, std::uint64_t k);
Point2 randomPlaceAbout(Point2 center, double scope, const RandomSequence& sequence,
                        std::uint64_t k);

// ---- Denser candidates

/// Returns the points of a lattice with this step that begins step / 2 inside the limits' lower
/// corner, below the upper one; y runs slowest.
/// \pre step > 0
/// \throws UsageError for more than kMaxSites
std::vector<Point2> latticePlaces(const Box2& limits, double step);

/// Returns points about every `step` along the walls of the indoor region and the objects that
/// touch or stand in it at this height, `off` from them on the free side: outline and holes of the
/// free floor, edges in order. Points are spread evenly over lines of at least `step`, half a
/// distance from the ends; consecutive shorter lines, of round and ragged objects, share theirs.
/// Points may lie beyond another wall. Also returns points on both sides of those `sheets` that
/// stand in the free floor and are not part of its boundary: walls without thickness, as between
/// rooms joined by open doors.
/// \pre step > 0
/// \throws UsageError for more than kMaxSites
std::vector<Point2> placesAlong(const std::vector<Region>& free_floor, double step, double off,
                                std::span<const Segment2> sheets = {});

/// Returns points along the medial axis of the free floor, about one every `step`: where the
/// nearest walls lie on different sides, seen at least about 90 degrees apart (a right-angled
/// corner of a room still counts), and no nearer than step / 3.
///
/// Samples the boundary every step / 3 and computes the Voronoi vertices of the samples; those
/// whose samples are seen at a wide angle are near the axis (Dey and Zhao, Approximating the medial
/// axis from the Voronoi diagram with a convergence guarantee, 2004). Keeps one vertex in each
/// square of a lattice of `step`, the farthest from all walls; `sheets` in the free floor are walls
/// too. Sorts by squares, row by row from the lower left. A moved plan has the same points, moved.
/// O(n log n) for n samples.
/// \pre step > 0
/// \throws UsageError for more than some million samples
std::vector<Point2> medialPlaces(const std::vector<Region>& free_floor, double step,
                                 std::span<const Segment2> sheets = {});

/// Distance of sensors below the bar that carries them, metres: bars are solid.
constexpr double kUnderBar = 0.01;
/// Returns points under the bars of all `infra` frames, about every `step` along each bar,
/// kUnderBar below it. In the order of the records, rows before columns.
/// \pre step > 0
/// \throws UsageError for more than kMaxSites
std::vector<Point3> framePlaces(const Environment& environment, double step);

// ---- Valid sites

/// Where sensors may stand. Distances hold to within a micrometre (kWeldDistance), in favour of the
/// site: a site at exactly the required distance is valid.
struct SiteRules {
    double height = kScanHeight;
    bool indoor_only = true;        ///< the thesis' Insider Judge: indoors only
    double clearance = 0;           ///< least distance from walls and objects at this height
    std::vector<Polygon> keep_out;  ///< closed
    std::vector<Polygon> keep_in;   ///< closed; if any: a site lies in one of them or on its edge
    /// Maximum distance from a wall that reaches this height (to which the sensor is mounted).
    std::optional<double> wall_within;
};

/// The validity test for sites. Thread-safe once built. O(log n) typically, for n lines of the
/// plan; building it takes O(n log n).
class SiteValidity {
  public:
    SiteValidity(const Environment& environment, SiteRules rules);
    ~SiteValidity();
    SiteValidity(const SiteValidity&) = delete;
    SiteValidity& operator=(const SiteValidity&) = delete;
    /// Returns true for points that are strictly indoors (the thesis' Insider Judge) unless the
    /// rules say otherwise, in no solid and on no wall at the height, and within the rules. Exact,
    /// except for distances.
    [[nodiscard]] bool isValid(Point2 place) const;

  private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

/// Returns the valid sites, in order; tests them in parallel. Merges sites at the same point: it
/// occurs where it came first, with the headings of all. Once progress says stop, tests only a
/// sample of the other sites, some hundreds spread over the plan, and sets `is_complete` to false.
std::vector<Site> validSites(const SiteValidity& validity, std::vector<Site> sites,
                             Progress& progress, bool& is_complete);

/// Reads a list of sites from CSV text: `x,y` or `x,y,heading` per line, in metres and degrees; `#`
/// begins a comment; skips a header line `x,y…`. Lines without heading get `headings`; lines with
/// the same point are merged into one site, where it came first.
/// Numbers are at most a million. A byte order mark is skipped.
/// \throws FormatError with line and column of all errors, at most Diagnostics::kMax
std::vector<Site> readSites(const std::string& text, const std::string& name,
                            const std::vector<Angle>& headings);

/// The rooms of a site, as a list of places names them.
struct PlaceRooms {
    std::vector<std::string> ids;
    /// Returns the rooms with this name or glob. \throws UsageError without any
    std::function<std::vector<std::size_t>(const std::string& name)> find;
};

/// The same for several rooms: `ROOM/` stands before each x. Returns the sites by room.
std::vector<std::vector<Site>> readSites(const std::string& text, const std::string& name,
                                         const std::vector<Angle>& headings,
                                         const PlaceRooms& rooms);

/// Returns `count` of the sites from `first` on, spread over the plan in any order of the list,
/// ascending: the middle of each of `count` equal stretches of a Morton curve. O(n log n)
/// \pre count <= sites.size() - first
std::vector<std::size_t> sitesSpreadOver(std::span<const Site> sites, std::size_t first,
                                         std::size_t count);

}  // namespace ispace
