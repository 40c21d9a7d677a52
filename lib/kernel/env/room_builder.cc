// SPDX-License-Identifier: GPL-3.0-or-later
// Large rooms are built by several tasks at once, which stop at their first findings. A room with
// findings is then built again step by step, so that messages and their order do not depend on
// threads; only broken rooms pay for it.
#include "env/room_builder.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "base/parallel.h"
#include "env/enclosure.h"
#include "env/environment.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/planar_map.h"

namespace ispace {

namespace {

/// Builds the body of a record without its walls, which need the welded lines of all records.
Body bodyBesideWalls(const Record& record) {
    if (!isWall(record)) return bodyOf(record);
    Body body;
    if (record.keyword() == "ispace" && record.flag("ceiling")) body.plates = bodyOf(record).plates;
    return body;
}

template <typename T>
void append(std::vector<T>& items, std::vector<T>&& more) {
    if (items.empty())
        items = std::move(more);
    else
        std::move(more.begin(), more.end(), std::back_inserter(items));
}

void addBody(Body& body, Body&& more) {
    append(body.sheets, std::move(more.sheets));
    append(body.prisms, std::move(more.prisms));
}

/// Returns the `inside` records.
std::vector<const Record*> insideRecords(std::span<const Element> elements) {
    std::vector<const Record*> inside;
    for (const Element& element : elements)
        if (element.record.keyword() == "inside") inside.push_back(&element.record);
    return inside;
}

/// All weather is the same outside: a second record would contradict the first.
void checkWeather(std::span<const Element> elements, Diagnostics& findings) {
    const Record* first = nullptr;
    for (const Element& element : elements) {
        const Record& record = element.record;
        if (record.keyword() != "weather") continue;
        if (first != nullptr)
            findings.add(record.finding("the room has weather already, in " +
                                        otherPlace(first->place(), record.place())));
        else
            first = &record;
    }
}

/// Limit of corners in all shapes: a constant, and more for each written record than for one that a
/// repetition creates. A few lines can define round and checkered objects without end; hand-written
/// plans stay far below the limit.
constexpr std::size_t kMaxCorners = 1'000'000, kMaxCornersWritten = 1000, kMaxCornersMade = 10;

std::size_t cornersOf(const Body& body) {
    std::size_t corners = 0;
    for (const Prism& prism : body.prisms) corners += prism.footprint.size();
    for (const Plate& plate : body.plates) corners += plate.outline.size();
    return corners;
}

/// Returns a finding about the file as a whole.
Diagnostic fileFinding(std::span<const Element> elements, std::string message) {
    if (elements.empty()) return {{}, 0, 0, std::move(message)};
    Diagnostic diagnostic = elements.front().record.finding(std::move(message));
    diagnostic.line = diagnostic.column = 0;
    return diagnostic;
}

/// Builds an environment step by step and collects all findings that are independent of each other.
class Builder {
  public:
    /// \param with_things false: giveThings() must follow
    void takeRecords(std::span<const Record> records, std::span<const std::string> ids,
                     bool with_things) {
        elements_.reserve(static_cast<std::size_t>(
            std::count_if(records.begin(), records.end(),
                          [](const Record& record) { return record.schema().isEnvironment(); })));
        if (with_things)
            for (std::size_t i = 0; i < records.size(); ++i) {
                if (records[i].schema().isEnvironment())
                    take(begun(records[i], ids[i], true), true);
            }
        else
            takeInBlocks(records, ids);
        inside_ = insideRecords(elements_);
        checkWeather(elements_, findings_);
        if (plan_.walls.empty() && walls_whole_)
            findings_.add(fileFinding(elements_, noWallsText()));
        // The region inside a self-crossing wall is meaningless and may take long to find.
        if (plan_.walls.empty() || !walls_simple_) findings_.throwIfAny();
    }

    /// Suggests slicing if there is a mesh, which may be the room itself.
    [[nodiscard]] std::string noWallsText() const {
        const bool has_mesh =
            std::any_of(elements_.begin(), elements_.end(),
                        [](const Element& element) { return element.record.keyword() == "mesh"; });
        if (elements_.empty())
            return "no walls: nothing encloses a room; add an ispace, wall or fence record, or "
                   "read a layout beside its room (ROOM LAYOUT)";
        return std::string("no walls: nothing encloses a room; ") +
               (has_mesh
                    ? "envc --slice-walls 1.2 cuts walls out of the mesh of a room, 1.2 m above "
                      "its floor; or "
                    : "") +
               "add an ispace, wall or fence record";
    }

    /// Builds the shapes of all elements except walls, in parallel to the walls.
    /// \throws FormatError with all findings
    void giveThings() {
        Diagnostics findings;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            if (!isWall(elements_[i].record)) giveShape(elements_[i], *bodies_[i], findings);
            countCorners(elements_[i]);
        }
        findings.throwIfAny();
    }

    /// Computes the wall lines and cuts the openings. \pre there are walls
    /// \throws FormatError with all findings so far, or only some if `at_once`
    void cutWalls(bool at_once) {
        const auto place = [this] { openings_ = placeOpenings(elements_, plan_, findings_); };
        const auto weld_all = [&] { welded_ = at_once ? weld(plan_.lines) : weldedLines(); };
        parallelInvoke(at_once, place, weld_all);
        for (const Segment2& piece : welded_.pieces) {
            limits_.add(piece.a);
            limits_.add(piece.b);
        }
        if (!openings_.empty())
            cut_ = cutOpenings(elements_, plan_, welded_, openings_, findings_);
        else
            cut_.parts = wallParts(plan_.walls, welded_);
    }

    /// Returns the bodies of walls and of the fillings of openings, and frees their parts.
    [[nodiscard]] std::vector<Body> takeWallBodies() {
        const std::vector<WallPart> parts = std::move(cut_.parts);
        return ispace::wallBodies(parts, plan_.walls.size() + openings_.size());
    }

    /// \param bodies those of takeWallBodies(). \pre all other elements have their shape
    void addWalls(std::vector<Body> bodies) {
        const std::size_t walls = plan_.walls.size();
        for (std::size_t i = 0; i < bodies.size(); ++i)
            addBody(*bodies_[i < walls ? plan_.owner[i] : openings_[i - walls].element],
                    std::move(bodies[i]));
    }

    /// Finds the indoor region. \throws FormatError with all findings
    void enclose() {
        try {
            enclosure_ = enclosed();
        } catch (const FormatError& error) {
            // Broken walls need not enclose a region.
            if (walls_whole_) findings_.add(withFile(error));
        }
        findings_.throwIfAny();
    }

    /// Moves the result out. \pre all steps are done
    [[nodiscard]] BuiltRoom take() {
        double height = 0;
        for (const WallLine& wall : plan_.walls) height = std::max(height, wall.top);
        for (std::size_t i = 0; i < elements_.size(); ++i) elements_[i].slot = i;
        return {std::move(elements_),  corners_, std::move(welded_.pieces),
                std::move(enclosure_), limits_,  height};
    }

  private:
    [[nodiscard]] Enclosure enclosed() const {
        const std::vector<Region> faces =
            cut_.passages.empty() ? boundedFaces(welded_) : boundedFaces(cut_.lines, cut_.passages);
        return ispace::enclose(plan_, faces, limits_, elements_, inside_);
    }

    /// The result of one record alone.
    struct Begun {
        Element element;
        std::shared_ptr<Body> body;
        std::vector<WallLine> walls = {};
        Diagnostics wall_findings = {}, findings = {};
    };

    [[nodiscard]] Begun begun(const Record& record, const std::string& id, bool with_things) const {
        const auto body = std::make_shared<Body>();
        Begun begun{{record, id, body}, body};
        const bool is_wall = isWall(record);
        if (is_wall) begun.walls = wallLinesOf(record, begun.wall_findings);
        if (is_wall || with_things) giveShape(begun.element, *body, begun.findings);
        return begun;
    }

    void take(Begun&& begun, bool with_things) {
        const bool is_wall = isWall(begun.element.record);
        if (is_wall) {
            for (const WallLine& wall : begun.walls) plan_.add(wall, elements_.size());
            walls_whole_ = walls_whole_ && begun.wall_findings.empty() && !begun.walls.empty();
            takeFindings(begun.wall_findings);
        }
        elements_.push_back(std::move(begun.element));
        bodies_.push_back(std::move(begun.body));
        if (with_things) countCorners(elements_.back());
        walls_simple_ = walls_simple_ && (begun.findings.empty() || !is_wall);
        takeFindings(begun.findings);
    }

    /// Reads the records in parallel blocks: walls with their lines, objects without shapes.
    void takeInBlocks(std::span<const Record> records, std::span<const std::string> ids) {
        constexpr std::size_t kBlock = 512;
        std::array<std::vector<Begun>, kBlocksAtOnce> slots;
        const auto begin = [&](std::size_t block) {
            std::vector<Begun>& slot = slots[block % kBlocksAtOnce];
            slot.clear();
            slot.reserve(kBlock);
            const std::size_t end = std::min(records.size(), (block + 1) * kBlock);
            for (std::size_t i = block * kBlock; i < end; ++i)
                if (records[i].schema().isEnvironment())
                    slot.push_back(begun(records[i], ids[i], false));
        };
        const auto take_all = [&](std::size_t block) {
            for (Begun& begun : slots[block % kBlocksAtOnce]) take(std::move(begun), false);
        };
        orderedPipeline((records.size() + kBlock - 1) / kBlock, begin, take_all);
    }

    static void giveShape(const Element& element, Body& body, Diagnostics& findings) {
        body = bodyBesideWalls(element.record);
        checkShape(element.record, body, findings);
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

    /// Adds the file to findings about lines, which have no position.
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
    std::vector<std::shared_ptr<Body>> bodies_;            // of the elements
    std::size_t corners_ = 0, max_corners_ = kMaxCorners;  // without walls and meshes
    WallPlan plan_;
    bool walls_whole_ = true;   // every record has all its lines
    bool walls_simple_ = true;  // no wall crosses itself
    std::vector<const Record*> inside_;
    std::vector<Opening> openings_;
    CutWalls cut_;
    Box2 limits_;
    WeldedLines welded_;
    Enclosure enclosure_;
};

/// Runs one step after another, so that findings are in order.
void buildInOrder(std::span<const Record> records, std::span<const std::string> ids,
                  Builder& builder) {
    builder.takeRecords(records, ids, true);
    builder.cutWalls(false);
    builder.addWalls(builder.takeWallBodies());
    builder.enclose();
}

/// Finds the region enclosed by the walls, the longest task, in parallel to the other shapes.
/// \throws FormatError with some of the findings
void buildAtOnce(std::span<const Record> records, std::span<const std::string> ids,
                 Builder& builder) {
    builder.takeRecords(records, ids, false);
    std::vector<Body> walls;
    const auto enclose = [&] { builder.enclose(); };
    const auto give_walls = [&] { walls = builder.takeWallBodies(); };
    parallelInvoke(
        true,
        [&] {
            builder.cutWalls(true);
            parallelInvoke(true, enclose, give_walls);
        },
        [&builder] { builder.giveThings(); });
    builder.addWalls(std::move(walls));
}

}  // namespace

BuiltRoom buildRoom(std::span<const Record> records, std::span<const std::string> ids) {
    if (records.size() >= kManyRecords) {
        try {
            Builder builder;
            buildAtOnce(records, ids, builder);
            return builder.take();
        } catch (const FormatError&) {
        }
    }
    Builder builder;
    buildInOrder(records, ids, builder);
    return builder.take();
}

namespace {

/// Returns true for the records that determine the walls and the indoor region.
bool shapesWalls(const Record& record) {
    const std::string& keyword = record.keyword();
    return isWall(record) || keyword == "door" || keyword == "window" || keyword == "inside";
}

Record withId(Record record, const std::string& id) {
    record.set("id", id);
    return record;
}

/// Returns true if findings about the records would be the same, too.
bool isSame(const Record& a, const Record& b) {
    if (!(a == b) || a.mesh() != b.mesh()) return false;
    const SourcePosition &x = a.place(), &y = b.place();
    return x.line == y.line && (x.file == y.file || (x.file && y.file && *x.file == *y.file));
}

}  // namespace

std::optional<EditedElements> editElements(std::span<const Element> before, std::size_t corners,
                                           std::span<const Record> records,
                                           std::span<const std::string> ids) {
    EditedElements edited{{}, corners};
    edited.elements.reserve(before.size() + 1);
    std::size_t next = 0;  // of `before`
    bool has_new_weather = false;
    const auto is_at = [&](std::size_t i, std::size_t record) {
        return i < before.size() && record < ids.size() && before[i].id == ids[record];
    };
    const auto drop = [&](const Element& element) {
        edited.is_changed = true;
        edited.corners -= cornersOf(element.body);
        return !shapesWalls(element.record);
    };
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!records[i].schema().isEnvironment()) continue;
        // Deleted elements end at the one with this id; a renamed one precedes the next equal id.
        const bool is_renamed = !is_at(next, i) && is_at(next + 1, i + 1);
        while (!is_renamed && next < before.size() && !is_at(next, i))
            if (!drop(before[next++])) return std::nullopt;
        const bool is_new = next == before.size();
        const bool is_same = is_at(next, i) && isSame(before[next].record, records[i]);
        // A new id, or an automatic one that an edit writes, leaves the shape.
        if (is_same ||
            (!is_new && isSame(withId(before[next].record, ids[i]), withId(records[i], ids[i])))) {
            edited.is_changed = edited.is_changed || !is_same;
            edited.elements.push_back({records[i], ids[i], before[next].shape, before[next].slot});
            ++next;
            continue;
        }
        std::size_t slot = edited.elements.empty() ? 0 : edited.elements.back().slot + 1;
        if (!is_new) {
            slot = before[next].slot;
            if (!drop(before[next++])) return std::nullopt;
        }
        const auto body = std::make_shared<Body>(bodyBesideWalls(records[i]));
        Diagnostics findings;
        checkShape(records[i], *body, findings);
        has_new_weather = has_new_weather || records[i].keyword() == "weather";
        if (shapesWalls(records[i]) || !findings.empty()) return std::nullopt;
        edited.is_changed = true;
        edited.corners += cornersOf(*body);
        edited.elements.push_back({records[i], ids[i], body, slot});
    }
    while (next < before.size())
        if (!drop(before[next++])) return std::nullopt;
    if (edited.corners > kMaxCorners) return std::nullopt;
    if (has_new_weather) {
        Diagnostics findings;
        checkWeather(edited.elements, findings);
        if (!findings.empty()) return std::nullopt;
    }
    return edited;
}

}  // namespace ispace
