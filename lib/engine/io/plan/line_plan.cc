// SPDX-License-Identifier: GPL-3.0-or-later
// Imports a plan of lines: pays for crowded lines, takes drawn doors out, joins ends, finds
// openings, simplifies, adds jambs, chooses rooms and writes their walls as fences. Openings are
// found anew after each step that moves lines, so they always lie on the walls that are written.
#include "io/plan/line_plan.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "base/number.h"
#include "base/random.h"
#include "env/environment.h"
#include "geom/arrangement.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "io/plan/parallel_lines.h"
#include "io/plan/plan_rooms.h"

namespace ispace {

namespace {

constexpr double kMaxExtent = 10000;      // metres
constexpr double kUnitsPerOverlap = 0.5;  // of Budget
constexpr double kFreeOverlaps = 64;      // of a line with the boxes of others
constexpr double kOpeningReach = 1e-5;    // from its end to its wall

/// Sizes of openings where walls are high enough.
constexpr double kDoorHeight = 2, kSill = 0.9, kWindowHeight = 1.2;

/// Estimates the pairs of lines whose boxes overlap, which each search for crossings and gaps
/// compares, from a sample; 0 if the sample has too few. Counts the pairs of few lines.
double sampledOverlaps(std::span<const Segment2> lines) {
    constexpr std::uint64_t kSamples = 1U << 18;
    constexpr std::size_t kSureHits = 16;
    const std::size_t n = lines.size();
    std::size_t hits = 0;
    if (n * n < kSamples) {
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < i; ++k) hits += bounds(lines[i]).overlaps(bounds(lines[k]));
        return static_cast<double>(hits);
    }
    for (std::uint64_t i = 0; i < kSamples; ++i) {
        const std::uint64_t bits = mixedBits(i);
        hits += bounds(lines[(bits >> 32U) % n]).overlaps(bounds(lines[(bits & 0xffffffffU) % n]));
    }
    if (hits < kSureHits) return 0;
    return static_cast<double>(hits) / kSamples * static_cast<double>(n) * static_cast<double>(n) /
           2;
}

/// The lines of a plan, and the kept ones among them.
class LinePlan {
  public:
    LinePlan(LayerSorter::Sorted shapes, const std::string& name, const ImportOptions& options,
             const DrawingSource* drawing, ImportRecords& out)
        : sizes_(std::move(shapes.sizes)) {
        DrawnDoors drawn{{}, std::move(shapes.walls)};
        Budget budget(drawing != nullptr ? drawing->bytes : 0, options.max_work);
        payFor(pathPieces(drawn.walls), name, drawing != nullptr, budget);
        if (drawing != nullptr) drawn = takeDrawnDoors(std::move(drawn.walls), budget);
        drawn_doors_ = drawn.swings.size();
        paths_ =
            normalisedLines(std::move(drawn.walls), options.snap.value_or(kDefaultSnap), budget);
        pieces_ = pathPieces(paths_);
        drawn_ = boundsOf(pieces_);
        check(name, options, drawing, budget);
        std::vector<PlanShape> doors = std::move(shapes.doors);
        doors.insert(doors.end(), std::make_move_iterator(drawn.swings.begin()),
                     std::make_move_iterator(drawn.swings.end()));
        std::vector<double> thickness;
        const auto find = [&] {
            thickness.clear();
            if (!sizes_)
                for (const PlanPath& path : paths_)
                    thickness.insert(thickness.end(), path.pieceCount(), path.thickness);
            return findOpenings(doors, shapes.windows, pieces_, budget, sizes_ ? &*sizes_ : nullptr,
                                thickness);
        };
        PlanOpenings found = find();
        if (auto straight = withoutJoints(paths_, found.lost_in, budget); straight && !sizes_) {
            pieces_ = pathPieces(paths_ = std::move(*straight));
            found = find();
        }
        if (options.simplify.value_or(0) > 0) {
            simplify(*options.simplify, found.openings, budget);
            found = find();
        }
        openings_ = std::move(found.openings);
        unused_symbols_ = found.unused;
        lost_ = std::move(found.lost);
        if (!sizes_) {
            for (PlanPath& jamb : addJambs(openings_, pieces_, thickness, budget))
                paths_.push_back(std::move(jamb));
            pieces_ = pathPieces(paths_);
        }
        keepRooms(options, drawing, budget, out);
    }

    [[nodiscard]] PlanOutcome outcome() const {
        PlanOutcome outcome{rooms_.area(), 0, rooms_.is_frame, rooms_.regions, drawn_};
        for (const Segment2& gap : rooms_.closing)
            outcome.widest_gap = std::max(outcome.widest_gap, distance(gap.a, gap.b));
        return outcome;
    }

    /// Returns PlanOutcome::walled; 0 if there are too many parallel lines.
    [[nodiscard]] double walled(Budget work) const {
        if (rooms_.regions.empty()) return 0;
        try {
            return shareOfWalls(rooms_.regions.front().rooms.front().outline, pieces_, work);
        } catch (const FormatError& /*more than the work*/) {
            return 0;
        }
    }

    void write(ImportRecords& out, const ImportOptions& options) {
        if (!rooms_.reached.empty()) {
            // Without walls, doors are where the floor continues.
            writeRooms(rooms_, options, out);
            return note(options, out);
        }
        const std::vector<PlanPath> fences =
            sizes_ ? std::move(paths_) : joinedAtEnds(std::move(paths_));
        const std::vector<std::size_t> fence_of = fencesOfOpenings(fences);
        std::vector<std::string> ids(fences.size());
        for (const std::size_t fence : fence_of)
            if (fence < fences.size() && ids[fence].empty())
                ids[fence] = out.freeId("f" + std::to_string(fence + 1), "f");
        for (std::size_t i = 0; i < fences.size(); ++i) {
            out.fence(fences[i], ids[i]);
            if (fences[i].thickness > 0 && !sizes_)
                out.last().set("thickness", wholeMicrometres(fences[i].thickness));
            if (const DrawnSize* size = sizeOf(fences[i].line)) {
                out.last().set("height", size->height);
                out.last().set("thickness", size->width);
            }
        }
        for (std::size_t i = 0; i < openings_.size(); ++i) {
            const std::string wall =
                openings_[i].wall ? ids[fence_of[i]] : out.freeId("gap", "gap");
            if (!openings_[i].wall) out.wall(openings_[i].line, wall, openings_[i].drawn_on);
            writeOpening(openings_[i], wall, out, options.wall_height);
        }
        writeRooms(rooms_, options, out);
        note(options, out);
    }

  private:
    /// Pays for lines that lie among many others, before any search compares them.
    static void payFor(std::span<const Segment2> lines, const std::string& name, bool has_layers,
                       Budget& budget) {
        const double crowd =
            sampledOverlaps(lines) - kFreeOverlaps * static_cast<double>(lines.size());
        const double units = std::max(0.0, kUnitsPerOverlap * crowd);
        if (!budget.take(static_cast<std::uint64_t>(units)))
            refuse("neighbours", name, has_layers, budget);
    }

    [[noreturn]] static void refuse(const std::string& cause, const std::string& name,
                                    bool has_layers, const Budget& budget) {
        failFile(name, cause + " of the lines make " + budget.excess() +
                           (has_layers ? "; --wall-layer 'A-WALL*' leaves layers out" : ""));
    }

    void check(const std::string& name, const ImportOptions& options, const DrawingSource* drawing,
               Budget& budget) const {
        const Box2 box = boundsOf(pieces_);
        if (!pieces_.empty() && drawing != nullptr)
            checkScale(std::max(box.width(), box.depth()), *drawing, name, options);
        if (!pieces_.empty() && std::max(box.width(), box.depth()) > kMaxExtent)
            failFile(name,
                     "the plan is " + formatFixed(std::max(box.width(), box.depth()), 0) +
                         " m wide: is the unit right? Say another, for example with --units mm");
        const double crossings = sampledCrossings(pieces_);
        if (crossTooOften(pieces_, crossings))
            failFile(name,
                     "the lines cross each other too often to be walls: leave layers of hatching "
                     "out, for example with --wall-layer 'A-WALL*'");
        if (!payForCrossings(crossings, pieces_.size(), options.rooms, budget))
            refuse("crossings", name, drawing != nullptr, budget);
    }

    /// Keeps pieces that openings lie on or touch.
    void simplify(double tolerance, const std::vector<PlanOpening>& openings, Budget& budget) {
        paths_ = joinedAtEnds(std::move(paths_));
        pieces_ = pathPieces(paths_);
        const NearSegments search(pieces_, budget);
        std::vector<std::size_t> fixed;
        for (const PlanOpening& opening : openings)
            for (const Point2 end : {opening.line.a, opening.line.b})
                for (const std::size_t i : search.near(end, kOpeningReach))
                    if (distance(end, pieces_[i]) <= kOpeningReach) fixed.push_back(i);
        paths_ = simplifiedPaths(paths_, tolerance, budget, fixed);
        pieces_ = pathPieces(paths_);
    }

    /// Returns walls, then lines that close the gaps of openings.
    [[nodiscard]] std::vector<Segment2> allPieces() const {
        std::vector<Segment2> all(pieces_);
        for (const PlanOpening& opening : openings_)
            if (!opening.wall) all.push_back(opening.line);
        return all;
    }

    void keepRooms(const ImportOptions& options, const DrawingSource* drawing, Budget& budget,
                   ImportRecords& out) {
        std::vector<Segment2> doorways;
        for (const PlanOpening& opening : openings_)
            if (!opening.is_window && !isShut(opening)) doorways.push_back(opening.line);
        const std::vector<Segment2> all = allPieces();
        PlanWalls plan{all, doorways, {}, {}, {}};
        plan.is_drawing = drawing != nullptr;
        if (drawing != nullptr) plan.unit_hint = [&] { return otherUnitHint(*drawing); };
        rooms_ = chooseRooms(plan, options, budget, out);
        if (rooms_.regions.empty() || sizes_) return;
        const std::vector<bool> keep = belongsTo(rooms_.regions, all);
        std::size_t gap = pieces_.size();
        std::vector<PlanOpening> kept;
        for (const PlanOpening& opening : openings_)
            if (keep[opening.wall ? *opening.wall : gap++]) kept.push_back(opening);
        dropped_openings_ = openings_.size() - kept.size();
        openings_ = std::move(kept);
        const std::vector<bool> walls(keep.begin(),
                                      keep.begin() + static_cast<std::ptrdiff_t>(pieces_.size()));
        dropped_lines_ = static_cast<std::size_t>(std::count(walls.begin(), walls.end(), false));
        paths_ = withPieces(std::move(paths_), walls);
    }

    /// Returns for each opening on a wall the index of the fence it is in.
    [[nodiscard]] std::vector<std::size_t> fencesOfOpenings(
        const std::vector<PlanPath>& fences) const {
        using Ends = std::array<double, 4>;
        const auto ends_of = [](const Segment2& s) {
            return lexLess(s.a, s.b) ? Ends{s.a.x, s.a.y, s.b.x, s.b.y}
                                     : Ends{s.b.x, s.b.y, s.a.x, s.a.y};
        };
        std::map<Ends, std::size_t> fence_with;
        for (const PlanOpening& opening : openings_)
            if (opening.wall) fence_with[ends_of(pieces_[*opening.wall])] = 0;
        for (std::size_t i = 0; i < fences.size(); ++i)
            for (std::size_t k = 0; k < fences[i].pieceCount(); ++k)
                if (const auto it = fence_with.find(ends_of(fences[i].piece(k)));
                    it != fence_with.end())
                    it->second = i;
        std::vector<std::size_t> result;
        result.reserve(openings_.size());
        for (const PlanOpening& opening : openings_)
            result.push_back(opening.wall ? fence_with.at(ends_of(pieces_[*opening.wall]))
                                          : fences.size());
        return result;
    }

    [[nodiscard]] const DrawnSize* sizeOf(int line) const {
        if (!sizes_) return nullptr;
        const auto found = sizes_->find(line);
        return found == sizes_->end() || found->second.height <= 0 ? nullptr : &found->second;
    }

    [[nodiscard]] bool isShut(const PlanOpening& opening) const {
        const DrawnSize* size = sizeOf(opening.drawn_on);
        return size != nullptr && size->width > 0;
    }

    void writeOpening(const PlanOpening& opening, const std::string& wall, ImportRecords& out,
                      double wall_height) const {
        Record& record = out.add(opening.is_window ? "window" : "door", opening.drawn_on);
        record.set("wall", wall);
        ImportRecords::setPoint(record, "from", opening.line.a);
        ImportRecords::setPoint(record, "to", opening.line.b);
        const DrawnSize* size = sizeOf(opening.drawn_on);
        if (size != nullptr) {
            record.set("height", wholeMicrometres(size->height));
            const double depth = wholeMicrometres(size->depth);
            if (depth > 0 && depth <= record.schema().find("size")->upper)
                record.set("size", Tuple{wholeMicrometres(distance(opening.line.a, opening.line.b)),
                                         depth});
            if (opening.is_window) {
                record.set("sill", size->bottom);
                if (!size->glass.empty()) record.set("glass", size->glass);
                if (size->is_open) record.set("open", true);
                if (size->is_blind) record.set("blind", true);
            } else {
                record.set("open", !isShut(opening));
            }
        } else if (opening.is_window) {
            const double sill = std::min(kSill, wall_height * kSill / kDoorHeight);
            record.set("height", std::min(kWindowHeight, wall_height - sill));
            record.set("sill", sill);
        } else {
            record.set("height", std::min(kDoorHeight, wall_height));
            record.set("open", true);
        }
    }

    /// Warns of symbols that open no wall, once for each layer.
    void warnOfLost(const ImportOptions& options, ImportRecords& out) const {
        if (options.door_layers.empty() && options.window_layers.empty()) return;
        std::map<std::string, std::pair<std::size_t, const LostSymbol*>> by_layer;
        for (const LostSymbol& symbol : lost_) {
            auto& [count, first] = by_layer[symbol.layer];
            if (count++ == 0) first = &symbol;
        }
        for (const auto& [layer, lost] : by_layer) {
            const auto& [count, first] = lost;
            out.warn(countText(count, "shape") + " on the layer " + layer +
                         (count == 1 ? " opens no wall, at " : " open no wall, the first at ") +
                         formatFixed(first->at.x, 2) + ',' + formatFixed(first->at.y, 2) +
                         ": doors and windows lie on a wall, or across it with sides at most "
                         "0.6 m apart",
                     first->drawn_on);
        }
    }

    void note(const ImportOptions& options, ImportRecords& out) const {
        warnOfLost(options, out);
        if (drawn_doors_ > 0)
            out.report("leaves and swings of " + countText(drawn_doors_, "door") +
                       " among the walls close no room");
        const auto windows = static_cast<std::size_t>(
            std::count_if(openings_.begin(), openings_.end(),
                          [](const PlanOpening& opening) { return opening.is_window; }));
        if (!openings_.empty() || unused_symbols_ > 0)
            out.note(countText(openings_.size() - windows, "door") + ", " +
                     countText(windows, "window") +
                     (unused_symbols_ == 0 ? std::string()
                                           : "; " + countText(unused_symbols_, "line") +
                                                 " on their layers open nothing and are left out"));
        if (dropped_lines_ + dropped_openings_ > 0)
            out.note("left out outside of it: " + countText(dropped_lines_, "line") + " and " +
                     countText(dropped_openings_, "opening"));
    }

    std::optional<std::map<int, DrawnSize>> sizes_;
    std::vector<PlanPath> paths_;
    std::vector<Segment2> pieces_;  // of all walls drawn
    Box2 drawn_;                    // their bounds
    std::vector<PlanOpening> openings_;
    std::vector<LostSymbol> lost_;
    std::size_t unused_symbols_ = 0, dropped_lines_ = 0, dropped_openings_ = 0;
    std::size_t drawn_doors_ = 0;  // leaves
    PlanRooms rooms_;
};

}  // namespace

LayerSorter::Use LayerSorter::useOf(const std::string& layer) {
    const auto [it, is_new] = uses_.try_emplace(layer, Others);
    if (!is_new) return it->second;
    Use& use = it->second;
    const bool is_wall = matchesLayer(options_.wall_layers, layer);
    const bool is_window = matchesLayer(options_.window_layers, layer);
    const bool is_door = options_.door_layers.empty() ? !is_wall && !is_window && isDoorName(layer)
                                                      : matchesLayer(options_.door_layers, layer);
    if (hidden_.count(layer) != 0 || lowerCased(layer) == "defpoints")  // never plotted
        use = Hidden;
    else if (is_door)
        use = Doors;
    else if (is_window)
        use = Windows;
    else if (is_wall || (options_.wall_layers.empty() && !isThingName(layer)))
        use = Walls;
    else if (options_.wall_layers.empty())
        use = Things;
    return use;
}

bool LayerSorter::isUsed(const std::string& layer) {
    const Use use = useOf(layer);
    return use == Walls || use == Doors || use == Windows || use == Things;
}

bool LayerSorter::mayBeWall(const std::string& layer) { return useOf(layer) == Walls; }

bool LayerSorter::isNamed(const std::string& name) const {
    return matchesLayer(options_.door_layers, name) || matchesLayer(options_.window_layers, name) ||
           matchesLayer(options_.wall_layers, name);
}

LayerSorter::Sorted LayerSorter::sort(std::vector<PlanShape> shapes) {
    Sorted sorted;
    // A drawing may have other names for all of its lines.
    const auto is_wall = [this](const PlanShape& shape) { return useOf(shape.layer) == Walls; };
    if (std::none_of(shapes.begin(), shapes.end(), is_wall))
        for (auto& [layer, use] : uses_)
            if (use == Things || (use == Doors && options_.door_layers.empty())) use = Walls;
    const bool has_others =
        options_.wall_layers.empty() &&
        std::any_of(shapes.begin(), shapes.end(), [&](const PlanShape& shape) {
            return is_wall(shape) && !shape.is_dashed && shape.path.points.size() >= 2;
        });
    for (PlanShape& shape : shapes) {
        const Use use = useOf(shape.layer);
        if (has_others && use == Walls && shape.is_dashed && shape.walls_in.empty()) {
            ++dashed_[shape.layer];
            continue;
        }
        ++counts_[use][shape.layer];
        if (use == Walls) {
            const bool is_window = shape.walls_in.empty() && isWindowName(shape.layer);
            ++(is_window ? window_names_[shape.layer] : wall_names_[shape.walls_in]);
        }
        if (use == Walls)
            sorted.walls.push_back(std::move(shape.path));
        else if (use == Doors)
            sorted.doors.push_back(std::move(shape));
        else if (use == Windows)
            sorted.windows.push_back(std::move(shape));
    }
    return sorted;
}

void LayerSorter::note(ImportRecords& out) const {
    constexpr std::array<const char*, kUses> kTitles{
        "layers of walls: ",
        "layers of doors: ",
        "layers of windows: ",
        "layers left out: ",
        "layers left out because they are off or frozen: ",
        ""};
    for (std::size_t use = 0; use < Things; ++use)
        if (!counts_[use].empty()) out.note(kTitles[use] + listText(counts_[use]));
    if (!dashed_.empty())
        out.report("dashed lines close no room, as those of axes and of edges above: " +
                   listText(dashed_) + "; --wall-layer takes those of a layer");
    if (!counts_[Things].empty())
        out.report("layers left out because their names are not those of walls: " +
                   listText(counts_[Things]) + "; --wall-layer takes others");
}

void LayerSorter::warnOfGlobs(ImportRecords& out) const {
    const auto warn_of = [&](const char* option, const std::vector<std::string>& globs) {
        for (const std::string& glob : globs)
            if (!hasLines(glob))
                out.warn(std::string("no line on the layers of ") + option + ' ' + glob +
                         "; layers with lines: " + all());
    };
    warn_of("--door-layer", options_.door_layers);
    warn_of("--window-layer", options_.window_layers);
}

bool LayerSorter::hasLines(const std::string& glob) const {
    for (std::size_t use = 0; use < kUses; ++use)
        for (const auto& [layer, count] : counts_[use])
            if (use != Hidden && matchesLayer({glob}, layer)) return true;
    return false;
}

void LayerSorter::mustHaveWalls(const Sorted& sorted, const std::string& name,
                                const std::map<std::string, std::size_t>& left_out) const {
    if (!sorted.walls.empty()) return;
    failFile(name, (options_.wall_layers.empty() ? "no line to make a wall of"
                                                 : "no line on the layers of walls") +
                       std::string("; layers with lines: ") + all() +
                       (left_out.empty() ? "" : "; left out: " + listText(left_out)));
}

std::string LayerSorter::all() const {
    std::map<std::string, std::size_t> shown;
    for (std::size_t use = 0; use < kUses; ++use)
        for (const auto& [layer, count] : counts_[use])
            if (use != Hidden) shown[layer] += count;
    return (shown.empty() ? "none" : listText(shown)) +
           (counts_[Hidden].empty() ? "" : "; off or frozen: " + listText(counts_[Hidden]));
}

std::map<std::string, std::size_t> LayerSorter::unusedWallNames() const {
    if (!options_.wall_layers.empty() || wall_names_.count("") == 0) return {};
    std::map<std::string, std::size_t> names = wall_names_;
    names.erase("");
    if (!names.empty()) names.insert(window_names_.begin(), window_names_.end());
    return names;
}

PlanOutcome writeLinePlan(LayerSorter::Sorted shapes, const LayerSorter& sorter,
                          const std::string& name, const ImportOptions& options,
                          const DrawingSource* drawing, ImportRecords& out) {
    sorter.mustHaveWalls(
        shapes, name,
        drawing == nullptr ? std::map<std::string, std::size_t>() : drawing->left_out);
    if (drawing != nullptr) sorter.warnOfGlobs(out);
    return withFileName(name, [&] {
        std::set<double> thick;
        for (const PlanPath& path : shapes.walls)
            if (path.thickness > 0 && !shapes.sizes) thick.insert(wholeMicrometres(path.thickness));
        if (!thick.empty())
            out.report(
                "lines with a width are walls of that thickness: " + formatDouble(*thick.begin()) +
                (thick.size() == 1 ? "" : " to " + formatDouble(*thick.rbegin())) + " m");
        LinePlan plan(std::move(shapes), name, options, drawing, out);
        plan.write(out, options);
        PlanOutcome outcome = plan.outcome();
        if (drawing == nullptr) return outcome;
        const std::map<std::string, std::size_t> names = sorter.unusedWallNames();
        if (!names.empty() || !drawing->import)  // to be compared
            outcome.walled = plan.walled(Budget(drawing->bytes, options.max_work));
        warnOfWallNames(names, outcome, *drawing, options, out);
        return outcome;
    });
}

/// Turns between the axes, each time at the widest gap along it. The longer part stays if the gap
/// is five times its extent and it has nine tenths of all length; two turns without a cut end it.
void leaveOutStrays(std::vector<PlanShape>& shapes, ImportRecords* out) {
    constexpr double kFar = 5;      // of the gap to strays, as a share of the plan's extent
    constexpr double kBulk = 0.9;   // of the length of all lines, which the plan has
    constexpr int kMaxRounds = 64;  // groups of strays
    struct Span {
        double low, high, length;
        std::size_t shape;
    };
    const auto length_of = [](const PlanPath& path) {
        double length = 0;
        for (std::size_t i = 0; i < path.pieceCount(); ++i)
            length += distance(path.piece(i).a, path.piece(i).b);
        return length;
    };
    std::vector<bool> is_stray(shapes.size(), false);
    double whole = 0;
    std::vector<Span> all;
    for (std::size_t i = 0; i < shapes.size(); ++i)
        if (shapes[i].path.points.size() >= 2) {
            all.push_back({0, 0, length_of(shapes[i].path), i});
            whole += all.back().length;
        }
    const double least = kBulk * whole;
    // Splits off what lies behind the widest gap, along either axis, while it is far and short.
    for (int round = 0, idle = 0; round < kMaxRounds && idle < 2; ++round) {
        const bool along_x = round % 2 == 0;
        for (Span& span : all) {
            const Box2 box = bounds(shapes[span.shape].path.points);
            span.low = along_x ? box.low.x : box.low.y;
            span.high = along_x ? box.high.x : box.high.y;
        }
        std::sort(all.begin(), all.end(), [](const Span& a, const Span& b) {
            return a.low == b.low ? a.shape < b.shape : a.low < b.low;
        });
        ++idle;
        std::size_t cut = 0;
        double widest = 0, low_end = 0, reach = 0, before = 0, passed = 0, total = 0, last = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            total += all[i].length;
            if (i > 0 && all[i].low - reach > widest) {
                widest = all[i].low - reach;
                cut = i;
                low_end = reach;
                before = passed;
            }
            reach = i == 0 ? all[i].high : std::max(reach, all[i].high);
            passed += all[i].length;
            last = reach;
        }
        if (cut == 0) continue;
        const bool first_stays = before >= total - before;
        const double extent = first_stays ? low_end - all.front().low : last - all[cut].low;
        if (widest < kFar * extent || (first_stays ? before : total - before) < least) continue;
        idle = 0;
        const auto middle = all.begin() + static_cast<std::ptrdiff_t>(cut);
        const auto [from, to] =
            first_stays ? std::pair{middle, all.end()} : std::pair{all.begin(), middle};
        for (auto span = from; span != to; ++span) is_stray[span->shape] = true;
        all.erase(from, to);
    }
    const auto first = std::find(is_stray.begin(), is_stray.end(), true);
    if (first == is_stray.end()) return;
    const PlanShape& stray = shapes[static_cast<std::size_t>(first - is_stray.begin())];
    const Point2 at = stray.path.points.front();
    const auto count = static_cast<std::size_t>(std::count(is_stray.begin(), is_stray.end(), true));
    if (out != nullptr)
        out->warn("left out " + countText(count, "line") + " far from all others, " +
                      (count == 1 ? "at " : "the first at ") + formatFixed(at.x, 1) + ',' +
                      formatFixed(at.y, 1) + " m on the layer " + stray.layer +
                      ": delete it in the drawing",
                  stray.path.line);
    std::vector<PlanShape> kept;
    for (std::size_t i = 0; i < shapes.size(); ++i)
        if (!is_stray[i]) kept.push_back(std::move(shapes[i]));
    shapes = std::move(kept);
}

namespace {

/// Metres: beyond all surveyors' coordinates.
constexpr double kOffEarth = 1e8;

void requireWithin(double metres, const PlanShape& shape, const std::string& name) {
    for (const Point2 p : shape.path.points)
        if (!(std::max(std::abs(p.x), std::abs(p.y)) <= metres))
            failFile(name,
                     "lies more than " + formatDouble(kMaxPlanCoordinate / 1000) +
                         " km from the origin: are the units right (--units)?",
                     shape.path.line);
}

double medianOf(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void requireOnEarth(const PlanShape& shape, const std::string& name) {
    requireWithin(kOffEarth, shape, name);
}

std::optional<Vec2> movedHome(std::vector<PlanShape>& shapes, const std::string& name) {
    std::vector<double> x, y;
    for (const PlanShape& shape : shapes)
        if (!shape.path.points.empty()) {
            x.push_back(shape.path.points.front().x);
            y.push_back(shape.path.points.front().y);
        }
    const auto way = wayFromSurvey({medianOf(x), medianOf(y)});
    for (PlanShape& shape : shapes) {
        if (way) {
            for (Point2& p : shape.path.points) p = p - *way;
            for (PlanChord& chord : shape.chords) {
                chord.line = {chord.line.a - *way, chord.line.b - *way};
                if (chord.center) chord.center = *chord.center - *way;
            }
        }
        requireWithin(kMaxPlanCoordinate, shape, name);
    }
    return way;
}

double writeLinePlan(std::vector<PlanShape> shapes, const std::string& name,
                     const ImportOptions& options, ImportRecords& out) {
    LayerSorter sorter({}, options);
    LayerSorter::Sorted sorted = sorter.sort(std::move(shapes));
    sorter.note(out);
    return writeLinePlan(std::move(sorted), sorter, name, options, nullptr, out).area;
}

std::string listText(const std::map<std::string, std::size_t>& counts) {
    constexpr std::size_t kMaxNames = 12;
    std::string text;
    std::size_t named = 0;
    for (const auto& [thing, count] : counts) {
        if (named == kMaxNames) break;
        if (named++ > 0) text += ", ";
        text += thing + " (" + std::to_string(count) + ')';
    }
    if (counts.size() > named) text += " and " + std::to_string(counts.size() - named) + " more";
    return text;
}

}  // namespace ispace
