// SPDX-License-Identifier: GPL-3.0-or-later
// Reads plans of HouseExpo (T. Li et al., HouseExpo: A large-scale 2D indoor layout dataset for
// learning-based algorithms on mobile robots, 2019). The JSON is parsed as a stream: members that
// are not imported, and depth, cost no memory.
#include "extensions/cad/cad.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "geom/polygon.h"
#include "io/import_records.h"
#include "io/plan/plan_rooms.h"

namespace ispace::cad {

namespace {

struct Box {
    std::string category;
    std::array<double, 4> corners;  // x, y of two opposite corners
};

/// The members of the JSON object that are imported.
struct HousePlan {
    bool has_outline = false;
    Polygon outline;
    std::vector<Polygon> holes;
    std::vector<Box> boxes;
};

/// An iterator over bytes that reports the position of a parser, which holds copies of it.
class CountingIterator {
  public:
    // NOLINTBEGIN(readability-identifier-naming): names that the standard library wants
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;
    // NOLINTEND(readability-identifier-naming)

    CountingIterator(const char* at, const char** farthest) : at_(at), farthest_(farthest) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        *farthest_ = std::max(*farthest_, ++at_);
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator old = *this;
        ++*this;
        return old;
    }
    friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
        return a.at_ == b.at_;
    }

  private:
    const char* at_;
    const char** farthest_;
};

/// Parses the JSON as a stream: stores only the members of HousePlan, and counts the depth.
class HousePlanHandler : public nlohmann::json_sax<nlohmann::json> {
  public:
    HousePlanHandler(std::string_view bytes, const std::string& name)
        : bytes_(bytes), name_(name), at_(bytes.data()) {}

    HousePlan read() {
        nlohmann::json::sax_parse(CountingIterator(bytes_.data(), &at_),
                                  CountingIterator(bytes_.data() + bytes_.size(), &at_), this);
        if (finding_) throw FormatError(*finding_);
        if (!plan_.has_outline)
            failFile(name_,
                     "JSON without `verts`: wanted a HouseExpo plan, an object with `verts`, the "
                     "outline as a list of [x, y]");
        return std::move(plan_);
    }

    bool null() override { return scalar("null"); }
    bool boolean(bool /*value*/) override { return scalar("true or false"); }
    bool number_integer(std::int64_t value) override { return number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) override {
        return number(static_cast<double>(value));
    }
    bool number_float(double value, const std::string& /*text*/) override { return number(value); }
    bool string(std::string& /*value*/) override { return scalar("a string"); }
    bool binary(binary_t& /*value*/) override { return scalar("binary data"); }

    bool start_object(std::size_t /*size*/) override {
        ++depth_;
        if (depth_ == 1 || !wanted() || (key_ == "room_category" && depth_ == 2)) return true;
        return fail("found an object");
    }
    bool end_object() override {
        --depth_;
        return true;
    }
    bool key(std::string& name) override {
        if (depth_ == 1) {
            key_ = name;
            if (key_ == "verts" && plan_.has_outline) return fail("a second `verts`", "");
            plan_.has_outline = plan_.has_outline || key_ == "verts";
        } else if (depth_ == 2 && key_ == "room_category") {
            category_ = name;
        }
        return true;
    }
    bool start_array(std::size_t /*size*/) override {
        ++depth_;
        if (depth_ == 1) return fail("found a list", "wanted a HouseExpo plan, an object");
        if (wanted() && depth_ > tupleDepth()) return fail("found a list");
        return true;
    }
    bool end_array() override {
        const bool good = !wanted() || endOfList();
        --depth_;
        return good;
    }
    bool parse_error(std::size_t /*position*/, const std::string& token,
                     const nlohmann::detail::exception& error) override {
        // "[json.exception.parse_error.101] parse error at line 1, column 3: …"
        std::string what = error.what();
        if (const std::size_t colon = what.find(": "); colon != std::string::npos)
            what.erase(0, colon + 2);
        return fail("bad JSON near " + excerpt(token), printable(what));
    }

  private:
    [[nodiscard]] bool wanted() const {
        return key_ == "verts" || key_ == "holes" || key_ == "room_category";
    }
    /// Returns the depth of the lists of numbers: [x, y] in `verts` is the third list or object.
    [[nodiscard]] int tupleDepth() const { return key_ == "verts" ? 3 : 4; }
    [[nodiscard]] std::string wantedShape() const {
        if (key_ == "verts") return "wanted a list of [x, y] in metres";
        if (key_ == "holes") return "wanted a list of rings, each a list of [x, y] in metres";
        return "wanted lists of [x1, y1, x2, y2] by category";
    }

    bool fail(const std::string& found) { return fail('`' + key_ + "`: " + found, wantedShape()); }
    /// Ends the parse.
    bool fail(const std::string& found, const std::string& wanted) {
        const std::string_view before(bytes_.data(), static_cast<std::size_t>(at_ - bytes_.data()));
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t start = before.find_last_of('\n') + 1;  // 0 in the first line
        finding_ = Diagnostic{displayName(name_), static_cast<int>(line),
                              static_cast<int>(std::max<std::size_t>(1, before.size() - start)),
                              wanted.empty() ? found : found + ", " + wanted};
        return false;
    }

    bool scalar(const std::string& what) {
        if (depth_ == 0) return fail("found " + what, "wanted a HouseExpo plan, an object");
        return !wanted() || fail("found " + what);
    }

    bool number(double value) {
        if (depth_ == 0 || !wanted()) return depth_ > 0 || scalar("a number");
        if (depth_ != tupleDepth()) return fail("found a number");
        if (!(std::abs(value) <= kMaxSurveyed))
            return fail("`" + key_ +
                            "`: " + (std::isfinite(value) ? formatDouble(value) : "a number") +
                            " is too far away",
                        "wanted metres up to " + formatDouble(kMaxSurveyed));
        tuple_.push_back(value);
        return tuple_.size() <= 4 || fail("found a list of five numbers");
    }

    /// \pre wanted()
    bool endOfList() {
        if (depth_ == tupleDepth()) {
            const std::size_t size = key_ == "room_category" ? 4 : 2;
            if (tuple_.size() != size)
                return fail("found a list of " + countText(tuple_.size(), "number"));
            if (size == 4)
                plan_.boxes.push_back({category_, {tuple_[0], tuple_[1], tuple_[2], tuple_[3]}});
            else
                ring_.push_back({tuple_[0], tuple_[1]});
            tuple_.clear();
        } else if (depth_ == tupleDepth() - 1 && key_ != "room_category") {
            if (key_ == "verts")
                plan_.outline = std::exchange(ring_, {});
            else
                plan_.holes.push_back(std::exchange(ring_, {}));
        }
        return true;
    }

    std::string_view bytes_;
    const std::string& name_;
    const char* at_;
    std::optional<Diagnostic> finding_;
    HousePlan plan_;
    int depth_ = 0;
    std::string key_, category_;
    std::vector<double> tuple_;
    Polygon ring_;
};

/// Moves a plan in surveyors' coordinates to the origin.
void moveHome(HousePlan& plan, const std::string& name, ImportRecords& out) {
    Box2 box;
    for (const Point2 p : plan.outline) box.add(p);
    Box2 all = box;
    for (const Polygon& hole : plan.holes)
        for (const Point2 p : hole) all.add(p);
    for (const Box& room : plan.boxes)
        for (std::size_t i = 0; i + 1 < room.corners.size(); i += 2)
            all.add({room.corners[i], room.corners[i + 1]});
    if (!all.empty() && std::max(all.width(), all.depth()) > kMaxPlanCoordinate)
        failFile(name, "the plan is wider than 900 km: is it in metres?");
    const auto way = plan.outline.empty() ? std::nullopt : wayFromSurvey(box.low);
    if (!way) return;
    for (Point2& p : plan.outline) p = p - *way;
    for (Polygon& hole : plan.holes)
        for (Point2& p : hole) p = p - *way;
    for (Box& room : plan.boxes)
        for (std::size_t i = 0; i < room.corners.size(); ++i)
            room.corners[i] -= i % 2 == 0 ? way->x : way->y;
    out.report(surveyText(*way, "plan"));
}

/// The rings after snapping and simplifying; those without area are dropped.
std::vector<Polygon> normalised(const std::vector<Polygon>& rings, const ImportOptions& options,
                                Budget& work) {
    std::vector<PlanPath> paths;
    paths.reserve(rings.size());
    for (const Polygon& ring : rings) paths.push_back({ring, true, 0});
    std::vector<Polygon> result;
    for (PlanPath& path : snapped(paths, options.snap.value_or(0), work))
        if (path.closed) result.push_back(std::move(path.points));
    if (options.simplify.value_or(0) > 0) result = simplified(result, *options.simplify);
    return result;
}

/// Finds the room: the largest face within the outline and outside the holes.
class RoomFinder {
  public:
    RoomFinder(const HousePlan& plan, const std::string& name, const ImportOptions& options,
               Budget& work)
        : name_(name),
          outline_(normalised({plan.outline}, options, work)),
          holes_(normalised(plan.holes, options, work)),
          work_(work) {
        if (outline_.empty() && !normalised({plan.outline}, {}, work).empty())
            fail("`verts`: nothing is left of an outline of " +
                 countText(plan.outline.size(), "point") +
                 " after snapping and simplifying, wanted less of that (--snap, --simplify)");
        if (outline_.empty())
            fail("`verts`: an outline of " + countText(plan.outline.size(), "point") +
                 " encloses nothing, wanted three corners or more");
    }

    PlanRooms rooms(const ImportOptions& options, ImportRecords& out) const {
        PlanWalls plan;
        for (const auto* rings : {&outline_, &holes_})
            for (const Polygon& ring : *rings)
                forEachEdge(ring, [&](const Segment2& edge) { plan.lines.push_back(edge); });
        if (crossTooOften(plan.lines)) fail("the outline crosses itself too often to be a plan");
        plan.is_floor = [this](Point2 p) { return isFloor(p); };
        PlanRooms rooms = chooseRooms(plan, options, work_, out);
        if (rooms.regions.empty()) fail("`verts` encloses nothing outside of the holes");
        return rooms;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { failFile(name_, message); }
    [[nodiscard]] bool isFloor(Point2 p) const {
        return locate(outline_.front(), p) == Side::Inside &&
               std::none_of(holes_.begin(), holes_.end(),
                            [p](const Polygon& hole) { return locate(hole, p) == Side::Inside; });
    }

    const std::string& name_;
    std::vector<Polygon> outline_, holes_;
    Budget& work_;
};

void writeZones(const std::vector<Box>& boxes, ImportRecords& out) {
    std::size_t flat = 0;
    for (const auto& [category, corners] : boxes) {
        const auto [x1, y1, x2, y2] = corners;
        const double length = wholeMicrometres(std::abs(x2 - x1));
        const double width = wholeMicrometres(std::abs(y2 - y1));
        if (length > 0 && width > 0)
            out.zone(out.freeId(category, "room"), {(x1 + x2) / 2, (y1 + y2) / 2}, Angle(), length,
                     width);
        else
            ++flat;
    }
    if (flat > 0) out.note(countText(flat, "box") + " of `room_category` without area left out");
}

}  // namespace

Document readHouseExpo(std::string_view json, const std::string& name, const ImportOptions& options,
                       const Schemas& schemas) {
    HousePlan plan = HousePlanHandler(json, name).read();
    Budget work(json.size(), options.max_work);
    ImportRecords out(schemas, name, options);
    moveHome(plan, name, out);
    const PlanRooms rooms = withFileName(
        name, [&] { return RoomFinder(plan, name, options, work).rooms(options, out); });
    if (rooms.reached.empty())
        for (const PlanRegion& region : rooms.regions)
            for (const Region& room : region.rooms) out.outline(room);
    writeRooms(rooms, options, out);
    writeZones(plan.boxes, out);
    return out.take();
}

}  // namespace ispace::cad
