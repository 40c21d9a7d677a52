// SPDX-License-Identifier: GPL-3.0-or-later
// Plans from point clouds: cells with points between two heights are walls.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/number.h"
#include "env/environment.h"
#include "extensions/meshes/cloud_file.h"
#include "extensions/meshes/meshes.h"
#include "geom/polygon.h"
#include "io/import_records.h"
#include "io/map/cell_map.h"
#include "io/map/map_rooms.h"
#include "raster/cells.h"

namespace ispace::meshes {

namespace {

constexpr double kCell = 0.05;        // metres, unless the user says otherwise
constexpr double kMaxCells = 25e6;    // of the grid in which points are counted
constexpr double kCellsPerUnit = 4;   // of Budget
constexpr int kRim = 3;               // cells around, so that the outside is connected
constexpr int kManyPoints = 10;       // in half of the cells: then a single one is a stray
constexpr int kMinThing = 3;          // cells; smaller ones are noise
constexpr double kBelowTop = 0.15;    // metres: islands that end this far below the top are no wall
constexpr double kFloorNoise = 0.1;   // metres above the floor
constexpr double kStands = 0.25;      // metres: islands with lower points stand on the floor
constexpr double kFloorShare = 0.01;  // of all points lie lower than the floor
constexpr double kRoundShare = 0.92;  // of its rectangle that a round thing fills at most
constexpr int kHeadings = 90;         // rectangle headings that are tried
/// Widths of gaps between points, tried in this order; wider ones are doors.
constexpr std::array kGaps{0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.2};
constexpr double kGapOfPoints = 0.3;

/// Some points of a cloud lie kilometres away: reflections, and slips of a digit.
constexpr double kStrayShare = 0.001;  // of all points, beyond each end of their bulk
constexpr double kBeside = 1;          // width of the bulk, in which points beside it belong to it

/// Lowest and highest of some points.
struct PointBox {
    Point3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

    void add(const Point3& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

/// The points of one cell.
struct CountedCell {
    std::uint8_t in_band = 0;  ///< saturated
    float lowest = HUGE_VALF;  ///< height of the lowest one above the floor's noise
    float highest = -HUGE_VALF;
};

/// An island of points in a room, seen from above.
struct CloudThing {
    Point2 middle;
    Angle heading;
    double length = 0, width = 0;
    double bottom = 0, top = 0;  ///< above the floor
    bool is_round = false;
};

class CloudPlan {
  public:
    CloudPlan(std::string_view bytes, const std::string& name, const ImportOptions& options,
              ImportRecords& out)
        : file_(bytes, name),
          name_(name),
          options_(options),
          budget_(bytes.size(), options.max_work),
          out_(out) {
        const auto* const unit =
            std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                         [&](const LengthUnit& known) { return known.name == options.units; });
        const std::string& up = options.own.get<UpAxis>().name;
        file_.setFrame(unit == kLengthUnits.end() ? 1 : unit->metres,
                       up == "auto" ? 'z' : up.front());
    }

    void write() {
        measure();
        count();
        MapCells occupied = occupiedCells();
        takeThings(occupied);
        ImportOptions how = options_;
        if (!options_.close_gaps)
            if (const double gap = gapsToClose(occupied); gap > 0) how.close_gaps = gap;
        writeCellMap(fineMap(occupied), {name_, "are the heights of --slice-walls right?"}, how,
                     out_);
    }

    /// Adds the islands with their centre in one of the imported rooms.
    void addThings(const std::vector<Polygon>& rooms, ImportRecords& out) const {
        for (const CloudThing& thing : things_)
            if (std::any_of(rooms.begin(), rooms.end(), [&](const Polygon& room) {
                    return locate(room, thing.middle) == Side::Inside;
                }))
                add(thing, out);
    }

  private:
    void measure() {
        PointBox all, band;
        std::size_t in_band = 0;
        cell_ = options_.resolution.value_or(kCell);
        file_.forEach([&](const Point3& p) {
            all.add(p);
            if (!isInBand(p)) return;
            band.add(p);
            ++in_band;
        });
        PointBox bulk = band;
        if (in_band > 0 && cellsOver(band) > kMaxCells) bulk = bulkOf(band, in_band);
        const std::string reach = "its points reach from " + formatFixed(all.low.z, 2) + " m to " +
                                  formatFixed(all.high.z, 2) + " m in height";
        if (!options_.slice_top)
            failFile(name_,
                     "a point cloud: say between which heights its points are walls, and how wide "
                     "the cells are in which they are counted, for example with --slice-walls "
                     "0.5..1.8 --resolution 5cm; " +
                         reach);
        if (in_band == 0)
            failFile(name_, "no point lies between the heights of --slice-walls: " + reach +
                                "; are --units and --up right?");
        // The outermost walls lie in the middle of their cells.
        // A disc as wide as a gap must fit outside.
        const double rim = kRim + std::ceil(options_.close_gaps.value_or(kGaps.back()) / cell_);
        if (bulk.high.x < band.high.x || bulk.high.y < band.high.y || bulk.low.x > band.low.x ||
            bulk.low.y > band.low.y)
            band = withoutStrays(bulk);
        const Point2 low{band.low.x, band.low.y};
        if (const auto way = wayFromSurvey(low)) {
            survey_ = *way;
            out_.report(surveyText(survey_, "cloud"));
        }
        corner_ = low - survey_ - Vec2{(rim + 0.5) * cell_, (rim + 0.5) * cell_};
        const double columns = std::ceil((band.high.x - survey_.x - corner_.x) / cell_) + rim;
        const double rows = std::ceil((band.high.y - survey_.y - corner_.y) / cell_) + rim;
        const bool is_huge = columns * rows > kMaxCells;
        const double units = std::min(columns * rows, kMaxCells) / kCellsPerUnit;
        if (is_huge || !budget_.take(static_cast<std::uint64_t>(units)))
            failFile(name_, "its points reach over " + formatFixed(band.high.x - band.low.x, 1) +
                                " x " + formatFixed(band.high.y - band.low.y, 1) + " m, cells of " +
                                formatDouble(cell_) + " m make " +
                                (is_huge ? "more than 25 million" : budget_.excess()) +
                                "; take larger ones with --resolution");
        columns_ = static_cast<int>(columns);
        rows_ = static_cast<int>(rows);
        checkCellMap(columns_, rows_, cell_, name_);
        floor_ = floorHeight(all);
    }

    [[nodiscard]] double cellsOver(const PointBox& box) const {
        return (box.high.x - box.low.x) / cell_ * ((box.high.y - box.low.y) / cell_);
    }

    /// Finds the box of most points: narrows each axis to the steps that hold all but few at its
    /// ends, and as much beside them, until it stays.
    [[nodiscard]] PointBox bulkOf(PointBox box, std::size_t points) const {
        constexpr std::size_t kSteps = 4096;
        constexpr int kMaxRounds = 8;
        const double few = kStrayShare * static_cast<double>(points);
        for (int round = 0; round < kMaxRounds; ++round) {
            const double x0 = box.low.x, y0 = box.low.y;
            const double width = box.high.x - x0, depth = box.high.y - y0;
            std::array<std::vector<std::size_t>, 2> counts;
            for (auto& axis : counts) axis.assign(kSteps, 0);
            const auto add = [&](std::vector<std::size_t>& axis, double offset, double extent) {
                const double step = kSteps * offset / std::max(extent, 1e-9);
                if (step >= 0 && step <= kSteps)
                    ++axis[std::min(kSteps - 1, static_cast<std::size_t>(step))];
            };
            file_.forEach([&](const Point3& p) {
                if (!isInBand(p)) return;
                add(counts[0], p.x - x0, width);
                add(counts[1], p.y - y0, depth);
            });
            const auto narrow = [&](const std::vector<std::size_t>& axis, double& low,
                                    double& high) {
                std::size_t first = 0, last = kSteps - 1;
                for (std::size_t sum = axis[0]; first < last && static_cast<double>(sum) <= few;)
                    sum += axis[++first];
                for (std::size_t sum = axis[last]; first < last && static_cast<double>(sum) <= few;)
                    sum += axis[--last];
                const double step = (high - low) / kSteps;
                const double from = low + step * static_cast<double>(first);
                const double to = low + step * static_cast<double>(last + 1);
                low = std::max(low, from - kBeside * (to - from));
                high = std::min(high, to + kBeside * (to - from));
            };
            narrow(counts[0], box.low.x, box.high.x);
            narrow(counts[1], box.low.y, box.high.y);
            if (box.high.x - box.low.x > width / 2 && box.high.y - box.low.y > depth / 2) break;
        }
        return box;
    }

    /// Returns the box of the points in `bulk`; warns of all others.
    PointBox withoutStrays(const PointBox& bulk) {
        PointBox band;
        std::size_t strays = 0;
        Point2 one;
        file_.forEach([&](const Point3& p) {
            if (!isInBand(p)) return;
            if (p.x >= bulk.low.x && p.x <= bulk.high.x && p.y >= bulk.low.y && p.y <= bulk.high.y)
                return band.add(p);
            if (strays++ == 0) one = {p.x, p.y};
        });
        out_.warn(countText(strays, "point") + (strays == 1 ? " lies" : " lie") +
                  " far from all others, at " + placeText(one) +
                  (strays == 1 ? "" : " and others") + ": left out");
        return band;
    }

    [[nodiscard]] bool isInBand(const Point3& p) const {
        return p.z >= options_.slice_walls.value_or(0) && p.z <= options_.slice_top.value_or(0);
    }

    /// Some points lie below it: reflections, and those of other storeys.
    [[nodiscard]] double floorHeight(const PointBox& all) const {
        constexpr std::size_t kSteps = 1000;
        // Exact, and kSteps times the height of any finite points stays finite.
        constexpr double kScale = 1.0 / 2048;
        const double low = kScale * all.low.z, height = kScale * all.high.z - low;
        std::array<std::size_t, kSteps + 1> below{};
        std::size_t points = 0;
        file_.forEach([&](const Point3& p) {
            const double above = kScale * p.z - low;
            ++below[static_cast<std::size_t>(kSteps * above / std::max(height, kScale * 1e-9))];
            ++points;
        });
        std::size_t step = 0;
        const double least = kFloorShare * static_cast<double>(points);
        for (std::size_t sum = below[0]; static_cast<double>(sum) < least;) sum += below[++step];
        return (low + height * static_cast<double>(step) / kSteps) / kScale;
    }

    [[nodiscard]] std::optional<std::size_t> cellOf(const Point3& p) const {
        const double x = std::floor((p.x - survey_.x - corner_.x) / cell_);
        const double y = std::floor((p.y - survey_.y - corner_.y) / cell_);
        if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return std::nullopt;
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(x);
    }

    void count() {
        cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        file_.forEach([&](const Point3& p) {
            const auto index = cellOf(p);
            if (!index) return;
            CountedCell& cell = cells_[*index];
            const auto z = static_cast<float>(p.z);
            cell.highest = std::max(cell.highest, z);
            if (p.z > floor_ + kFloorNoise) cell.lowest = std::min(cell.lowest, z);
            if (isInBand(p) && cell.in_band < UINT8_MAX) ++cell.in_band;
        });
    }

    [[nodiscard]] const CountedCell& at(int x, int y) const {
        return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(x)];
    }

    [[nodiscard]] MapCells occupiedCells() const {
        std::array<std::size_t, UINT8_MAX + 1> with{};
        for (const CountedCell& cell : cells_) ++with[cell.in_band];
        const std::size_t hit = cells_.size() - with[0];
        std::size_t many = 0;
        for (std::size_t points = kManyPoints; points < with.size(); ++points) many += with[points];
        const int least = 2 * many >= hit ? 2 : 1;
        MapCells occupied(columns_, rows_);
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                if (at(x, y).in_band >= least) occupied.insert(x, y);
        return occupied;
    }

    /// Islands that end below the upper height are furniture or noise, not walls.
    void takeThings(MapCells& occupied) {
        const CellPieces pieces(occupied, CellPieces::Joined::ByCorners);
        std::vector<std::vector<CellIndex>> places(pieces.size());
        std::vector<CloudThing> things(pieces.size());
        for (CloudThing& thing : things) thing = {{}, {}, 0, 0, HUGE_VAL, -HUGE_VAL, false};
        pieces.forEachRun([&](const RowRun& run, std::size_t piece) {
            for (int x = run.first; x <= run.last; ++x) {
                const CountedCell& cell = at(x, run.row);
                things[piece].bottom = std::min<double>(things[piece].bottom, cell.lowest);
                things[piece].top = std::max<double>(things[piece].top, cell.highest);
                places[piece].push_back({x, run.row});
            }
        });
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (things[i].top > *options_.slice_top - kBelowTop) continue;
            for (const CellIndex place : places[i]) occupied.erase(place.x, place.y);
            if (places[i].size() < kMinThing) continue;
            const double bottom = things[i].bottom - floor_;
            things[i].bottom = bottom < kStands ? 0 : bottom;
            things[i].top -= floor_;
            fit(things[i], places[i]);
            things_.push_back(things[i]);
        }
    }

    [[nodiscard]] Point2 middleOf(CellIndex place) const {
        return {corner_.x + (place.x + 0.5) * cell_, corner_.y + (place.y + 0.5) * cell_};
    }

    /// Finds the smallest rectangle around the cell centres: points lie on the faces of a body,
    /// which pass through cells anywhere.
    void fit(CloudThing& thing, const std::vector<CellIndex>& places) const {
        double least = HUGE_VAL;
        for (int degrees = 0; degrees < kHeadings; ++degrees) {
            const Vec2 along = unitVector(Angle::degrees(degrees));
            const Vec2 across = perpendicular(along);
            Box2 box;
            for (const CellIndex place : places) {
                const Vec2 way = middleOf(place) - Point2{};
                box.add({dot(way, along), dot(way, across)});
            }
            const double length = std::max(box.width(), cell_),
                         width = std::max(box.depth(), cell_);
            if (length * width >= least) continue;
            least = length * width;
            thing.middle = Point2{} + box.center().x * along + box.center().y * across;
            thing.heading = Angle::degrees(degrees);
            thing.length = length;
            thing.width = width;
        }
        const double filled = static_cast<double>(places.size()) * cell_ * cell_;
        const double share = filled / ((thing.length + cell_) * (thing.width + cell_));
        thing.is_round = share < kRoundShare && share > kRoundShare * std::numbers::pi / 4;
    }

    void add(const CloudThing& thing, ImportRecords& out) const {
        Record& record = out.add(thing.is_round ? "cylinder" : "cube", 0);
        Tuple at{wholeMicrometres(thing.middle.x), wholeMicrometres(thing.middle.y)};
        if (thing.bottom > 0) at.push_back(wholeMicrometres(thing.bottom));
        record.set("at", std::move(at));
        record.set("heading", thing.heading.degrees());
        const double height = std::max(cell_, thing.top - thing.bottom);
        record.set("size", Tuple{wholeMicrometres(thing.length), wholeMicrometres(thing.width),
                                 wholeMicrometres(height)});
    }

    /// Finds the least width of gaps that encloses half of the largest area any width encloses.
    /// \throws FormatError if no width encloses a room
    [[nodiscard]] double gapsToClose(const MapCells& occupied) const {
        const MapCells free = complement(occupied);
        std::array<double, kGaps.size()> areas{};
        for (std::size_t i = 0; i < kGaps.size(); ++i) areas[i] = enclosed(free, kGaps[i]);
        const double most = *std::max_element(areas.begin(), areas.end());
        if (most == 0)
            failFile(name_,
                     "its points enclose no room between the heights of --slice-walls, also with "
                     "gaps of " +
                         formatDouble(kGaps.back()) +
                         " m closed: take larger cells with --resolution, other heights, or wider "
                         "gaps with --close-gaps");
        std::size_t i = 0;
        while (2 * areas[i] < most) ++i;
        if (kGaps[i] > kGapOfPoints)
            out_.warn("the walls have gaps: those of up to " + formatDouble(kGaps[i]) +
                      " m are closed; --close-gaps M sets the widest");
        return kGaps[i];
    }

    /// Returns the area of the room that would be kept, 0 if it is open.
    [[nodiscard]] double enclosed(const MapCells& free, double gap) const {
        const MapCells closed = gap > 0 ? difference(free, gapCells(free, gap / cell_)) : free;
        const CellPieces pieces(closed, CellPieces::Joined::BySides);
        const auto area_of = [&](std::size_t piece) {
            const double area = static_cast<double>(pieces[piece].cells) * cell_ * cell_;
            return pieces[piece].border > 0 || area < kMinRoomArea ? 0 : area;
        };
        double sum = 0, largest = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) largest = std::max(largest, area_of(i));
        for (const Point2 p : options_.inside)
            if (const auto piece =
                    pieces.at({static_cast<int>(std::floor((p.x - corner_.x) / cell_)),
                               static_cast<int>(std::floor((p.y - corner_.y) / cell_))}))
                sum += area_of(*piece);
        return options_.inside.empty() ? largest : sum;
    }

    /// With cells of half the size, so that a wall can lie in the middle of the counted ones.
    [[nodiscard]] CellMap fineMap(const MapCells& occupied) const {
        MapCells walls(2 * columns_, 2 * rows_);
        occupied.forEach([&walls](int x, int y) {
            for (const int row : {2 * y, 2 * y + 1}) walls.insertRun(row, 2 * x, 2 * x + 1);
        });
        MapCells free = complement(walls);
        CellMap map{std::move(free), std::move(walls), cell_ / 2, {corner_, Angle()}};
        map.wall_depth = 1;
        return map;
    }

    CloudFile file_;
    const std::string& name_;
    const ImportOptions& options_;
    Budget budget_;
    ImportRecords& out_;
    double cell_ = kCell, floor_ = 0;
    Vec2 survey_;  // subtracted from the points of the file
    Point2 corner_;
    int columns_ = 0, rows_ = 0;
    std::vector<CountedCell> cells_;
    std::vector<CloudThing> things_;
};

/// The closed fences that run counter-clockwise: rooms, not holes in them.
std::vector<Polygon> roomsIn(const Document& document) {
    std::vector<Polygon> rooms;
    for (const Record& record : document.records) {
        if (record.keyword() != "fence") continue;
        Polygon room;
        for (const Tuple& p : record.list("path")) room.push_back({p[0], p[1]});
        if (signedArea(room) > 0) rooms.push_back(std::move(room));
    }
    return rooms;
}

}  // namespace

Document readPointCloud(std::string_view bytes, const std::string& name,
                        const ImportOptions& options, const Schemas& schemas) {
    ImportRecords out(schemas, name, options);
    CloudPlan plan(bytes, name, options, out);
    plan.write();
    Document document = out.take();
    ImportRecords things(schemas, name, options);
    plan.addThings(roomsIn(document), things);
    for (Record& thing : things.take().records) document.records.push_back(std::move(thing));
    return document;
}

}  // namespace ispace::meshes
