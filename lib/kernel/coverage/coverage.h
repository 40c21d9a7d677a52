// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/coverage: cells, areas and coverage of sensors. Uses sense and below; TBB inside.
//
// Each figure is known twice where it can be: in closed form by an overlay of the views' exact
// regions (the reference; error bounds of geom/overlay/overlay.h, some 1e-7 of an area), and by
// cells of a grid with their centre in view (the thesis' way; error of the order of a cell's edge
// times the boundary). coverage_exact_test checks that cells converge to the closed form.
//
// Figures and bytes are the same for any number of threads. Views are computed in parallel; the
// union of n views costs one overlay of their outlines. docs/performance.md has measured times.
//
//     RayScenes worlds(scene.environment);
//     const Coverage coverage = measureCoverage(scene, worlds, {.plane = 1.2});
//     const Metric share = coverage.report.coverage;  // of the indoor floor
//     const double covered = share.exact.value_or(share.grid.value_or(0));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "coverage/target.h"
#include "geom/overlay/overlay.h"
#include "raster/grid.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// Decides whether a laser sees a cell.
enum class CellRule {
    Region,  ///< the cell centre lies in the exact view, up to rounding
    Beams,   ///< the centre lies in the polygon through the ends of the beams (thesis,
             ///< section 4.5.2)
};

/// Area seen by at least K cameras with axes that differ pairwise by at least an angle, for stereo
/// and tracking.
struct ParallaxChoice {
    Angle least = Angle::degrees(30);
    int cameras = 2;
};

/// Plane, cells and products of a measurement. Metres.
struct CoverageOptions {
    CellChoice cells = RoomCells();
    double height = kScanHeight;  ///< height at which the free floor is computed
    double plane = 0;             ///< height of the plane that all sensors but level lasers cover
    double density = 0;           ///< pixels a metre that a camera requires to cover floor; 0: any
    CellRule cells_by = CellRule::Region;
    bool exact = true;  ///< computes closed forms, too
    /// Stores the number of sensors in Coverage::overlay; else only whether any sensor sees the
    /// floor (count 0 or 1), which takes much less memory where many views overlap.
    bool keep_depths = true;
    /// Coverage::density_overlays hold the floor away from all cameras, too, in which requirements
    /// of densities find the largest gap.
    bool whole_densities = true;
    std::optional<ParallaxChoice> parallax = {};
    /// Crossings of outlines that exact figures may take; by default half a million, and some for
    /// each sensor and line of the room. With more, figures are known by cells.
    std::optional<std::uint64_t> max_work = {};
};

/// A metric by cells and in closed form. Empty (null in JSON) if unknown, e.g. a share by cells of
/// an area without cell centres.
struct Metric {
    std::optional<double> grid, exact;
};

/// Metrics of a camera's view of the plane.
struct PictureMetrics {
    /// Area with at least the pixels of each of densityClasses(), m2, of the whole field of view,
    /// independent of the requested density.
    std::vector<Metric> areas;
    /// Distances in the plane from the sensor's foot to the nearest and farthest covered point;
    /// empty if the sensor covers no floor.
    std::optional<double> nearest = {}, farthest = {};
    Metric mean_density = {};  ///< mean over the covered area, pixels a metre
};

/// Metrics of one sensor, alone and beside the others.
struct SensorMetrics {
    std::string id, model;  ///< model is "" for a sensor without one
    const SensorKind* kind = &Laser::kKind;
    std::optional<double> slice_area = {};  ///< eq. (4.4), m2; of lasers
    /// Of its region within the limits, m2; of a receiver the region that it hears.
    Metric area = {};
    std::optional<double> outside = {};  ///< area beyond the limits, exact, m2
    Metric marginal = {};                ///< area lost if this sensor is removed, m2
    Metric overlap = {};                 ///< area that other sensors see, too, m2; not of receivers
    std::optional<PictureMetrics> picture = {};  ///< of cameras
};

/// Metrics of one zone of the room.
struct ZoneMetrics {
    std::string id;
    double area = 0;                     ///< of its indoor part, exact, m2
    Metric coverage = {};                ///< of the indoor part; exact is 0 if that is empty
    std::vector<Metric> densities = {};  ///< as DensityMetrics::indoor, of the indoor part
};

/// Shares of the floor seen by cameras with at least the pixels of each of densityClasses(),
/// independent of the requested density. Empty without cameras.
struct DensityMetrics {
    Metric seen;  ///< share of the indoor region seen by any camera at the requested density
    std::vector<Metric> indoor, free;
};

/// A connected piece of floor that no sensor sees.
struct UncoveredSpot {
    Point2 place;  ///< an inner point, away from the boundary if the piece is wide enough
    double area = 0;
    std::string room = {};  ///< id of the room of a site where it lies; "" in a room alone
};

/// Smaller pieces, m2, are skipped as rounding errors.
constexpr double kMinPiece = 1e-4;

/// Compares this layout with another one of the same room.
struct Comparison {
    std::string name;
    Metric coverage;  ///< of the other layout
    /// Indoor area that only this layout sees, and that only the other one sees, m2.
    Metric gained = {}, lost = {};
};

/// The metrics that `coverage` reports as text and JSON.
struct CoverageReport {
    std::string digest;
    Box2 limits;  ///< of the room; square cells may reach beyond
    Grid grid;
    double height = 0, plane = 0;
    double density = 0;                     ///< requested pixels a metre; 0: not requested
    double indoor_area = 0, free_area = 0;  ///< exact, m2
    std::vector<SensorMetrics> sensors;     ///< by kind
    /// Eq. (4.6), m2: within the limits, indoor or not.
    Metric total_effective_area;
    /// Area beyond the limits (through windows and open doors) that any sensor sees, exact, m2.
    std::optional<double> outside;
    Metric overlap;   ///< area seen by two sensors or more, m2; within the limits, indoor or not
    Metric coverage;  ///< eq. (4.7), fraction of the indoor region
    Metric free_coverage;  ///< share of the free floor
    /// [k]: share of indoor cells seen by exactly k sensors (all ultrasonic receivers count as
    /// one); all 0 without indoor cells.
    std::vector<double> redundancy;
    std::optional<std::vector<double>> redundancy_exact;
    std::vector<ZoneMetrics> zones;  ///< in the order of the zones' records
    /// Number of connected pieces of the covered indoor floor (thesis 4.1 f) and the share of the
    /// largest in it, 0 without covered floor; walls separate pieces. If the exact region is
    /// unknown, pieces of cells, which walls do not separate.
    std::size_t pieces = 0;
    double largest_piece = 0;
    /// Pieces of the free floor that no sensor sees, sorted by size, the largest first; by cells if
    /// the exact region is unknown.
    std::vector<UncoveredSpot> unseen;
    std::optional<Comparison> comparison;
    DensityMetrics densities;
    std::optional<ParallaxChoice> parallax;
    Metric parallax_coverage;  ///< share of the indoor region
    /// Reason why exact metrics of all sensors are missing; "" if they were computed or not
    /// requested.
    std::string exact_missing;
};

/// A set that covers floor: the view of a laser or a ranger, or the floor where at least four
/// ultrasonic receivers hear a tag.
struct CoveredSet {
    CellSet cells = CellSet();
    std::optional<SharedCurves> region = {};
};

/// The view of one sensor.
struct SensorView {
    const SensorKind* kind = &Laser::kKind;
    std::size_t index = 0;  ///< in Scene::sensors
    std::string id, model;
    Pose3 pose;
    double max_range = 0;
    CellSet cells = CellSet();
    /// Exact region within the limits: disjoint curves with the seen floor on their left, up to
    /// edges that cancel out (cutAlong()); empty if unknown.
    std::optional<SharedCurves> region = {};
    SharedCurves beyond = {};       ///< the rest of the exact region
    std::vector<float> beams = {};  ///< of a laser, as castBeams returns them
    /// Of a camera: the floor within the limits seen with the pixels of each of densityClasses().
    std::vector<CoveredSet> classes = {};

    /// True for a sensor that covers floor only together with others.
    [[nodiscard]] bool isPartial() const { return kind->together > 1; }
};

/// Bits of LayerLabel::marks in Coverage::overlay. Holes of the free floor beyond all views
/// (FarHoles) are marked free, too.
constexpr std::uint64_t kIndoorMark = 1, kFreeMark = 2;

/// The report, with the regions and cells that maps require.
struct Coverage {
    CoverageReport report;
    Target target;
    std::vector<SensorView> sensors;  ///< as report.sensors
    /// One set for each laser and ranger, in order, then one for all receivers if there are any.
    std::vector<CoveredSet> sets;
    /// Overlay of all regions (count, number i + 1 of set i; see CoverageOptions::keep_depths) on
    /// indoor region and free floor (marks). Empty if a region is unknown or exact metrics were not
    /// requested.
    std::optional<Overlay> overlay;
    /// Overlays of indoor region and free floor (marks as above), the cameras' views (kCameraMark),
    /// the floor with the pixels of each of densityClasses() (classMark), and some zones each
    /// (densityZoneMark). Empty without cameras, or if the region of one is unknown.
    std::vector<Overlay> density_overlays;
    bool are_densities_whole = false;  ///< see CoverageOptions::whole_densities
};

/// Marks in Coverage::density_overlays: of a class, by its index; of a zone, in the overlay with
/// the index zone / kDensityZones.
constexpr std::uint64_t kCameraMark = 4;
constexpr std::uint64_t classMark(std::size_t index) { return std::uint64_t{8} << index; }
constexpr std::size_t kDensityZones = 48;
constexpr std::uint64_t densityZoneMark(std::size_t zone) {
    return std::uint64_t{1} << (16 + zone % kDensityZones);
}

/// Computes the coverage of all placed lasers, rangers, cameras and ultrasonic receivers of a
/// scene. Deterministic for any number of threads. \throws UsageError as makeTarget
/// \param progress receives the views, then steps of the areas; null: none
Coverage measureCoverage(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                         Progress* progress = nullptr);

/// Sets report.comparison of `coverage`. \pre both were measured with the same options in the room
/// with this indoor region
void compare(Coverage& coverage, const Coverage& other, const Regions& indoor,
             const std::string& name);

/// Returns the redundancy of each cell: the number of sets that see it.
std::vector<std::uint32_t> timesSeen(const Coverage& coverage);
/// Returns the cells that any set covers.
CellSet coveredCells(const Coverage& coverage);

/// Returns the cells that cameras see with the pixels of a class, by its index.
CellSet cellsOfClass(const Coverage& coverage, std::size_t index);

/// Returns the share of target cells in a union, eq. (4.7) on cells; empty if the target has no
/// cells.
std::optional<double> coveredShare(const CellSet& covered, const CellSet& target);

/// Returns the largest redundancy of a cell. \param cell_times timesSeen()
std::uint32_t maxMultiplicity(const Coverage& coverage,
                              const std::vector<std::uint32_t>& cell_times);

/// Returns the view of one sensor as regions for vector formats: exact if known (see
/// withArcAreas()), else outlines of cells.
std::vector<Region> viewRegions(const SensorView& view, const Grid& grid);

/// Returns the indoor floor seen by exactly `times` sensors, as viewRegions() does; 0: the unseen.
/// \param cell_times timesSeen()
std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times);

}  // namespace ispace
