// SPDX-License-Identifier: GPL-3.0-or-later
// lib/coverage: cells, areas, coverage and its map. Uses sense, draw and below; TBB inside.
// Covered floor as regions, for formats of areas: exact where that is known (see withArcAreas()),
// else outlines of cells.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coverage/target.h"
#include "geom/overlay/overlay.h"
#include "raster/grid.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// When a cell counts as seen by a laser.
enum class CellRule {
    Region,  ///< its centre lies in what the laser sees, as exactly as doubles are
    Beams,   ///< in the polygon through the ends of its beams (thesis, section 4.5.2)
};

/// Floor that so many cameras see whose axes are pairwise so far apart, for stereo and tracking.
struct ParallaxChoice {
    Angle least = Angle::degrees(30);
    int cameras = 2;
};

struct CoverageOptions {
    CellChoice cells = RoomCells();
    double height = kScanHeight;  ///< at which the floor is free or not
    double plane = 0;             ///< height of what rangers, cameras and ultrasound cover
    double density = 0;  ///< cameras cover where they have so many pixels a metre; 0: all in view
    CellRule cells_by = CellRule::Region;
    bool exact = true;  ///< closed forms beside the cells
    /// Keep in Coverage::overlay by how many sensors and by which floor is seen; else whether any
    /// does (count 0 or 1), which takes much less memory where many look at the same floor.
    bool keep_depths = true;
    std::optional<ParallaxChoice> parallax = {};
};

/// A metric by cells and in closed form; one that is not known is empty (null in JSON), as a share
/// by cells of what holds no centre of any.
struct Metric {
    std::optional<double> grid, exact;
};

/// What a camera makes of the plane.
struct PictureMetrics {
    /// With at least the pixels of each of pixelDensities(), m2; of its whole field of view,
    /// whatever density is asked for.
    std::vector<Metric> areas;
    /// Of what it covers, along the plane from the place below or above it; none if it covers
    /// nothing.
    std::optional<double> nearest = {}, farthest = {};
    Metric mean_density = {};  ///< over what it covers, pixels a metre
};

struct SensorMetrics {
    std::string id, model;  ///< model "" for a bare sensor
    const SensorKind* kind = &kLaserKind;
    std::optional<double> slice_area = {};       ///< eq. (4.4), m2; of lasers
    Metric area = {};                            ///< of its region, m2; what a receiver hears
    Metric marginal = {};                        ///< lost if this sensor is removed, m2
    Metric overlap = {};                         ///< that others see, too, m2; not of receivers
    std::optional<PictureMetrics> picture = {};  ///< of cameras
};

struct ZoneMetrics {
    std::string id;
    double area = 0;                     ///< of its indoor part, exact, m2
    Metric coverage = {};                ///< of that part; exact is 0 where there is none
    std::vector<Metric> densities = {};  ///< as DensityMetrics::indoor, of that part
};

/// Shares of the floor that some camera sees with at least the pixels of each of pixelDensities(),
/// whatever density is asked for. Empty without cameras.
struct DensityMetrics {
    Metric seen;  ///< of the indoor region: by any camera, at the density that is asked for
    std::vector<Metric> indoor, free;
};

/// A connected piece of floor that no sensor sees.
struct UncoveredSpot {
    Point2 place;  ///< inside, well away from the rim where it can be
    double area = 0;
};

/// Pieces of less m2 are left out: what rounding cuts off.
constexpr double kMinPiece = 1e-4;

/// What another layout of the same room sees, beside this one.
struct Comparison {
    std::string name;
    Metric coverage;  ///< of the other one
    Metric gained = {},
           lost = {};  ///< indoor area seen by this layout alone, by the other alone, m2
};

/// The metrics of DESIGN's `coverage --json`, and more.
struct CoverageReport {
    std::string digest;
    Box2 limits;  ///< of the room; square cells may reach beyond
    Grid grid;
    double height = 0, plane = 0;
    double density = 0;                     ///< as asked for; 0: none
    double indoor_area = 0, free_area = 0;  ///< exact, m2
    std::vector<SensorMetrics> sensors;     ///< by kind
    Metric total_effective_area;            ///< eq. (4.6), m2; all cells, indoor or not
    Metric overlap;                         ///< seen by two and more, m2; indoor or not
    Metric coverage;                        ///< eq. (4.7), fraction of the indoor region
    Metric free_coverage;                   ///< fraction of the free floor
    std::vector<double> redundancy;  ///< [k]: share of indoor cells seen by exactly k sensors (all
                                     ///< ultrasonic receivers count as one); all 0 where no cell
                                     ///< is indoor
    std::optional<std::vector<double>> redundancy_exact;
    std::vector<ZoneMetrics> zones;  ///< in the order of their records
    /// Connected pieces of the covered indoor floor (thesis 4.1 f) and the share of the largest in
    /// it, 0 without any; walls part them. Where that is not known exactly, of cells, which walls
    /// do not part.
    std::size_t pieces = 0;
    double largest_piece = 0;
    /// Pieces of the free floor that no sensor sees, the largest first. Likewise.
    std::vector<UncoveredSpot> unseen;
    std::optional<Comparison> comparison;
    DensityMetrics densities;
    std::optional<ParallaxChoice> parallax;
    Metric parallax_coverage;  ///< share of the indoor region
    /// Why exact metrics of all together are missing; "" where they are there or nobody asked.
    std::string exact_missing;
};

/// Floor that counts as seen by one: what a laser or a ranger sees, or where at least four
/// ultrasonic receivers hear.
struct CoveredSet {
    CellSet cells = CellSet();
    std::optional<std::vector<Curve>> region = {};
};

/// What one sensor sees.
struct SensorView {
    const SensorKind* kind = &kLaserKind;
    std::size_t index = 0;  ///< in Scene::sensors
    std::string id, model;
    Pose3 pose;
    double max_range = 0;
    CellSet cells = CellSet();
    /// Its exact region: disjoint curves, what is seen on their left; nothing if not known.
    std::optional<std::vector<Curve>> region = {};
    std::vector<float> beams = {};  ///< of a laser, as of castBeams
    /// Of a camera: what has the pixels of each of pixelDensities().
    std::vector<CoveredSet> classes = {};

    /// It covers floor only together with others.
    [[nodiscard]] bool isPartial() const { return kind->together > 1; }
};

/// Bits of LayerLabel::marks in Coverage::overlay.
constexpr std::uint64_t kIndoorMark = 1, kFreeMark = 2;

/// Report and what is behind it, for maps.
struct Coverage {
    CoverageReport report;
    Target target;
    std::vector<SensorView> sensors;  ///< as report.sensors
    /// One for each laser and ranger, in order, then one for all receivers if there are any.
    std::vector<CoveredSet> sets;
    /// The regions of all sets (count, number i + 1 of set i; see CoverageOptions::keep_depths)
    /// over indoor region and free floor (marks). Nothing where a region is not known or nobody
    /// asked.
    std::optional<Overlay> overlay;
    /// Indoor region and free floor (marks as above), what cameras see at all (kCameraMark) and
    /// with the pixels of each of pixelDensities() (classMark), and some zones each
    /// (densityZoneMark). Empty without cameras and where the region of one is not known.
    std::vector<Overlay> density_overlays;
};

/// Marks in Coverage::density_overlays: of a class, by its index; of a zone, in the overlay with
/// the index zone / kDensityZones.
constexpr std::uint64_t kCameraMark = 4;
constexpr std::uint64_t classMark(std::size_t index) { return std::uint64_t{8} << index; }
constexpr std::size_t kDensityZones = 48;
constexpr std::uint64_t densityZoneMark(std::size_t zone) {
    return std::uint64_t{1} << (16 + zone % kDensityZones);
}

/// Measures all placed lasers, rangers, cameras and ultrasonic receivers of a scene. Deterministic
/// for any number of threads. \throws UsageError as makeTarget
Coverage measureCoverage(const Scene& scene, Worlds& worlds, const CoverageOptions& options);

/// Sets report.comparison of `coverage`. \pre both were measured with the same options in the room
/// that has this indoor region
void compare(Coverage& coverage, const Coverage& other, const Regions& indoor,
             const std::string& name);

/// By how many sets each cell of the grid is seen: the redundancy of a cell.
std::vector<std::uint32_t> timesSeen(const Coverage& coverage);
/// Cells seen by any.
CellSet coveredCells(const Coverage& coverage);

/// Cells that some camera sees with the pixels of a class, by its index.
CellSet cellsOfClass(const Coverage& coverage, std::size_t index);

/// Share of target cells that a union covers: eq. (4.7) on cells; nothing where the target has
/// none.
std::optional<double> coveredShare(const CellSet& covered, const CellSet& target);

/// The most sensors that see one place. \param cell_times timesSeen()
std::uint32_t maxMultiplicity(const Coverage& coverage,
                              const std::vector<std::uint32_t>& cell_times);

/// What one sensor sees.
std::vector<Region> viewRegions(const SensorView& view, const Grid& grid);

/// Indoor floor seen by exactly so many sensors; 0: the unseen. \param cell_times timesSeen()
std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times);

}  // namespace ispace
