// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/environment.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <utility>

#include "env/enclosure.h"
#include "env/info.h"
#include "env/level.h"
#include "env/openings.h"
#include "env/slice.h"
#include "env/walls.h"
#include "geom/planar_map.h"
#include "record/at_once.h"

namespace ispace {

namespace {

/// What a record is besides its walls: those follow from the lines of all records, welded.
Body bodyBesideWalls(const Record& record) {
    if (!isWall(record)) return bodyOf(record);
    Body body;
    if (record.keyword() == "ispace" && record.flag("ceiling")) body.plates = bodyOf(record).plates;
    return body;
}

void addBody(Body& body, Body&& more) {
    std::move(more.sheets.begin(), more.sheets.end(), std::back_inserter(body.sheets));
    std::move(more.prisms.begin(), more.prisms.end(), std::back_inserter(body.prisms));
}

/// The `inside` records.
std::vector<const Record*> insideRecords(std::span<const Element> elements) {
    std::vector<const Record*> inside;
    for (const Element& element : elements)
        if (element.record.keyword() == "inside") inside.push_back(&element.record);
    return inside;
}

/// Calls on_sheet(sheet, element) and on_solid(prism, element) for the walls and things that
/// stand anywhere between two heights; meshes of files are cut elsewhere.
template <typename OnSheet, typename OnSolid>
void forEachStanding(std::span<const Element> elements, double bottom, double top, OnSheet on_sheet,
                     OnSolid on_solid) {
    const auto stands = [&](const auto& part) { return part.bottom <= top && bottom <= part.top; };
    for (std::size_t i = 0; i < elements.size(); ++i) {
        for (const Sheet& sheet : elements[i].body.sheets)
            if (stands(sheet)) on_sheet(sheet, i);
        for (const Prism& prism : elements[i].body.prisms)
            if (stands(prism)) on_solid(prism, i);
    }
}

/// What the shapes of things may have in corners: so many, and more for each record that is written
/// than for those that a repetition makes. A few lines can make round and checkered things without
/// end; a plan that somebody wrote stays far below.
constexpr std::size_t kMaxCorners = 1'000'000, kMaxCornersWritten = 1000, kMaxCornersMade = 10;

std::size_t cornersOf(const Body& body) {
    std::size_t corners = 0;
    for (const Prism& prism : body.prisms) corners += prism.footprint.size();
    for (const Plate& plate : body.plates) corners += plate.outline.size();
    return corners;
}

/// For findings about the file as a whole.
Diagnostic fileFinding(std::span<const Element> elements, std::string message) {
    if (elements.empty()) return {{}, 0, 0, std::move(message)};
    Diagnostic diagnostic = elements.front().record.finding(std::move(message));
    diagnostic.line = diagnostic.column = 0;
    return diagnostic;
}

/// Builds an environment step by step, with as many findings together as do not follow from each
/// other.
class Builder {
  public:
    /// \param with_things else giveThings() is still to be called
    void takeRecords(std::span<const Record> records, std::span<const std::string> ids,
                     bool with_things) {
        elements_.reserve(static_cast<std::size_t>(
            std::count_if(records.begin(), records.end(),
                          [](const Record& record) { return record.schema().isEnvironment(); })));
        for (std::size_t i = 0; i < records.size(); ++i) {
            if (records[i].schema().isEnvironment()) takeRecord(records[i], ids[i], with_things);
        }
        inside_ = insideRecords(elements_);
        if (plan_.walls.empty() && walls_whole_)
            findings_.add(fileFinding(
                elements_,
                "no walls: nothing encloses a room; add an ispace, wall or fence record"));
        // What a wall that crosses itself encloses says little, and may take long to find.
        if (plan_.walls.empty() || !walls_simple_) findings_.throwIfAny();
    }

    /// The shapes of all that is no wall, while others look at walls. \throws FormatError
    void giveThings() {
        Diagnostics findings;
        for (Element& element : elements_) {
            if (!isWall(element.record)) giveShape(element, findings);
            countCorners(element);
        }
        findings.throwIfAny();
    }

    /// Lines of walls, and what is cut out of them. \pre there are walls
    /// \throws FormatError with all findings so far, or some if `at_once`
    void cutWalls(bool at_once) {
        doBoth(
            at_once, [this] { openings_ = placeOpenings(elements_, plan_, findings_); },
            [this, at_once] { welded_ = at_once ? weld(plan_.lines) : weldedLines(); });
        for (const Segment2& piece : welded_.pieces) {
            limits_.add(piece.a);
            limits_.add(piece.b);
        }
        if (!openings_.empty())
            cut_ = cutOpenings(elements_, plan_, welded_, openings_, findings_);
        else
            cut_.parts = wallParts(plan_.walls, welded_);
    }

    [[nodiscard]] std::vector<Body> wallBodies() const {
        return ispace::wallBodies(cut_.parts, plan_.walls.size() + openings_.size());
    }

    /// \param bodies those of wallBodies(). \pre all else has its shape
    void addWalls(std::vector<Body> bodies) {
        const std::size_t walls = plan_.walls.size();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            addBody(elements_[i < walls ? plan_.owner[i] : openings_[i - walls].element].body,
                    std::move(bodies[i]));
    }

    /// \throws FormatError with all findings
    Enclosure enclose() {
        Enclosure enclosure;
        try {
            const std::vector<Region> faces = cut_.passages.empty()
                                                  ? boundedFaces(welded_)
                                                  : boundedFaces(cut_.lines, cut_.passages);
            enclosure = ispace::enclose(plan_, faces, limits_, elements_, inside_);
        } catch (const FormatError& error) {
            // What is left of broken walls need not enclose anything.
            if (walls_whole_) findings_.add(withFile(error));
        }
        findings_.throwIfAny();
        return enclosure;
    }

    [[nodiscard]] double height() const {
        double height = 0;
        for (const WallLine& wall : plan_.walls) height = std::max(height, wall.top);
        return height;
    }
    [[nodiscard]] const Box2& limits() const { return limits_; }
    [[nodiscard]] std::vector<Element> takeElements() { return std::move(elements_); }
    [[nodiscard]] std::vector<Segment2> takeLines() { return std::move(welded_.pieces); }

  private:
    void takeRecord(const Record& record, const std::string& id, bool with_things) {
        const bool is_wall = isWall(record);
        if (is_wall) {
            const std::size_t before = plan_.walls.size();
            Diagnostics findings;
            for (const WallLine& wall : wallLinesOf(record, findings))
                plan_.add(wall, elements_.size());
            walls_whole_ = walls_whole_ && findings.empty() && plan_.walls.size() > before;
            takeFindings(findings);
        }
        elements_.push_back({record, id, {}});
        Diagnostics findings;
        if (is_wall || with_things) giveShape(elements_.back(), findings);
        if (with_things) countCorners(elements_.back());
        walls_simple_ = walls_simple_ && (findings.empty() || !is_wall);
        takeFindings(findings);
    }

    static void giveShape(Element& element, Diagnostics& findings) {
        element.body = bodyBesideWalls(element.record);
        checkShape(element.record, element.body, findings);
    }

    void countCorners(const Element& element) {
        corners_ += cornersOf(element.body);
        max_corners_ += element.record.isMade() ? kMaxCornersMade : kMaxCornersWritten;
        if (corners_ > max_corners_)
            throw FormatError(element.record.finding(
                "the shapes up to here have more than " + std::to_string(max_corners_) +
                " corners: fewer round or checkered things are wanted, or smaller ones"));
    }

    void takeFindings(const Diagnostics& findings) {
        try {
            findings.throwIfAny();
        } catch (const FormatError& error) {
            findings_.add(error);
        }
    }

    /// Findings about lines as such, without a place of their own.
    [[nodiscard]] FormatError withFile(const FormatError& error) const {
        std::vector<Diagnostic> all = error.diagnostics();
        for (Diagnostic& diagnostic : all) {
            if (diagnostic.file.empty())
                diagnostic = fileFinding(elements_, std::move(diagnostic.message));
        }
        return FormatError(std::move(all));
    }

    [[nodiscard]] WeldedLines weldedLines() {
        try {
            return weld(plan_.lines);
        } catch (const FormatError& error) {
            findings_.add(withFile(error));
            findings_.throwIfAny();
            throw;
        }
    }

    Diagnostics findings_;
    std::vector<Element> elements_;
    std::size_t corners_ = 0, max_corners_ = kMaxCorners;  // without walls and meshes
    WallPlan plan_;
    bool walls_whole_ = true;   // every record has all its lines
    bool walls_simple_ = true;  // none crosses itself
    std::vector<const Record*> inside_;
    std::vector<Opening> openings_;
    WeldedLines welded_;
    CutWalls cut_;
    Box2 limits_;
};

/// One step after another, so that findings come in order.
Enclosure buildInOrder(std::span<const Record> records, std::span<const std::string> ids,
                       Builder& builder) {
    builder.takeRecords(records, ids, true);
    builder.cutWalls(false);
    builder.addWalls(builder.wallBodies());
    return builder.enclose();
}

/// What takes longest, finding what walls enclose, while the shapes of all else are made.
/// \throws FormatError if there are findings: some of them
Enclosure buildAtOnce(std::span<const Record> records, std::span<const std::string> ids,
                      Builder& builder) {
    builder.takeRecords(records, ids, false);
    std::vector<Body> walls;
    Enclosure enclosure;
    const auto enclose = [&] { enclosure = builder.enclose(); };
    const auto give_walls = [&] { walls = builder.wallBodies(); };
    doBoth(
        true,
        [&] {
            builder.cutWalls(true);
            doBoth(true, enclose, give_walls);
        },
        [&builder] { builder.giveThings(); });
    builder.addWalls(std::move(walls));
    return enclosure;
}

Enclosure build(std::span<const Record> records, std::span<const std::string> ids,
                Builder& builder) {
    if (records.size() >= kManyRecords) {
        try {
            return buildAtOnce(records, ids, builder);
        } catch (const FormatError&) {
            builder = Builder();
        }
    }
    return buildInOrder(records, ids, builder);
}

}  // namespace

Environment::Environment(std::span<const Record> records, std::span<const std::string> ids) {
    assert(records.size() == ids.size());
    Builder builder;
    Enclosure enclosure = build(records, ids, builder);
    auto data = std::make_shared<Data>();
    data->indoor = std::move(enclosure.indoor);
    data->inside = enclosure.inside;
    data->limits = builder.limits();
    data->height = builder.height();
    data->elements = builder.takeElements();
    data->wall_lines = builder.takeLines();
    data_ = std::move(data);
    levels_ = std::make_shared<Levels>();
}

const RegionIndex& Environment::Data::indoorIndex() const {
    return *indoor_index.get([this] { return std::make_shared<const RegionIndex>(indoor.parts); });
}

Slice Environment::Data::slice(double at) const {
    Slice slice;
    slice.height = at;
    const auto add_sheet = [&](const Sheet& sheet, std::size_t owner) {
        if (!isAmong(Surfaces::Opaque, sheet)) return;
        slice.sheets.push_back(sheet.line);
        slice.sheet_owners.push_back(owner);
    };
    const auto add_solid = [&](const Prism& prism, std::size_t owner) {
        if (prism.curve) slice.rounds.push_back({*prism.curve, slice.solids.size()});
        slice.solids.push_back(prism.curve ? outlineOf(*prism.curve) : prism.footprint);
        slice.solid_owners.push_back(owner);
    };
    forEachStanding(elements, at, at, add_sheet, add_solid);
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (!elements[i].body.meshes.empty()) cutMeshes(elements[i].body, at, slice, i);
    return slice;
}

Slice Environment::band(double bottom, double top) const {
    assert(bottom <= top);
    Slice band;
    band.height = bottom;
    const auto add_sheet = [&](const Sheet& sheet, std::size_t owner) {
        band.sheets.push_back(sheet.line);
        band.sheet_owners.push_back(owner);
    };
    const auto add_solid = [&](const Prism& prism, std::size_t owner) {
        band.solids.push_back(prism.footprint);
        band.solid_owners.push_back(owner);
    };
    forEachStanding(elements(), bottom, top, add_sheet, add_solid);
    for (std::size_t i = 0; i < elements().size(); ++i)
        if (!elements()[i].body.meshes.empty())
            bandOfMeshes(elements()[i].body, bottom, top, band, i);
    return band;
}

/// The levels last asked for, the latest at the end, and those that others still hold.
struct Environment::Levels {
    /// A slice takes some 100 bytes a line, and 300 more once it is asked for visibility; free
    /// floor and indexes are of the same order.
    static constexpr std::ptrdiff_t kMaxKept = 64;
    static constexpr std::size_t kMaxLines = 500'000;

    std::mutex mutex;
    std::vector<std::shared_ptr<const Level>> kept;
    std::vector<std::weak_ptr<const Level>> let_go;

    /// The one of this height that somebody holds, or a new one.
    std::shared_ptr<const Level> find(double height, const std::shared_ptr<const Data>& data) {
        std::erase_if(let_go, [](const auto& level) { return level.expired(); });
        for (const auto& held : let_go)
            if (auto level = held.lock(); level != nullptr && level->height() == height)
                return level;
        return std::shared_ptr<const Level>(new Level(data, height));
    }

    /// Takes out those that are too many, the latest excepted.
    std::vector<std::shared_ptr<const Level>> takeSurplus() {
        auto first = std::prev(kept.end());
        std::size_t lines = 0;
        while (first != kept.begin() && kept.end() - first < kMaxKept) {
            lines += (*std::prev(first))->linesMade();
            if (lines > kMaxLines) break;
            --first;
        }
        std::vector<std::shared_ptr<const Level>> surplus(std::move_iterator(kept.begin()),
                                                          std::move_iterator(first));
        kept.erase(kept.begin(), first);
        let_go.insert(let_go.end(), surplus.begin(), surplus.end());
        return surplus;
    }
};

std::shared_ptr<const Level> Environment::level(double height) const {
    std::vector<std::shared_ptr<const Level>> surplus;  // ends after the lock
    const std::scoped_lock lock(levels_->mutex);
    auto& kept = levels_->kept;
    const auto known = std::find_if(kept.begin(), kept.end(), [height](const auto& level) {
        return level->height() == height;
    });
    if (known != kept.end()) {
        std::rotate(known, known + 1, kept.end());
    } else {
        kept.push_back(levels_->find(height, data_));
        surplus = levels_->takeSurplus();
    }
    return kept.back();
}

}  // namespace ispace
