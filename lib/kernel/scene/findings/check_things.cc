// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number.h"
#include "scene/findings/findings.h"

namespace ispace {

namespace {

/// Limit of the separating directions tested: normals of at most this many edges.
constexpr std::size_t kDirections = 32;

void addDirections(const Polygon& polygon, std::vector<Vec2>& out) {
    const std::size_t step = std::max<std::size_t>(1, polygon.size() / kDirections);
    for (std::size_t i = 0; i < polygon.size(); i += step) {
        const Vec2 side = polygon[i + 1 == polygon.size() ? 0 : i + 1] - polygon[i];
        if (length(side) > 0) {
            out.push_back(1 / length(side) * perpendicular(side));
            out.push_back(-out.back());
        }
    }
}

/// A pair of parts with heights in common.
using PartPair = std::pair<const Part*, const Part*>;

/// Computes the shortest translation that moves the second parts beyond the first ones.
double wayApart(const std::vector<PartPair>& pairs, const PartPair& deepest) {
    std::vector<Vec2> directions;
    addDirections(deepest.first->footprint, directions);
    addDirections(deepest.second->footprint, directions);
    double best = std::numeric_limits<double>::infinity();
    for (const Vec2 direction : directions) {
        double way = 0;
        for (const auto& [a, b] : pairs)
            way = std::max(way, penetrationDepth(a->footprint, b->footprint, direction));
        best = std::min(best, way);
    }
    return best;
}

}  // namespace

CheckContext::CheckContext(const Scene& from)
    : scene(from),
      indoor(from.environment.indoorIndex()),
      element_of(from.records.size() + 1),
      placed_of(from.records.size() + 1) {
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (!scene.records[i].schema().isEnvironment()) continue;
        element_of[i] = records.size();
        records.push_back(i);
    }
    for (const PlacedRecord& placed : scene.placed) placed_of[placed.record] = &placed;
}

const Parts& CheckContext::parts() {
    if (!parts_) parts_.emplace(scene.environment);
    return *parts_;
}

const Parts& CheckContext::partsAbout() {
    if (parts_about_) return *parts_about_;
    std::vector<Box2> places;
    for (const PlacedRecord& placed : scene.placed) {
        const Point2 at = placed.pose.position.onFloor();
        places.push_back({at, at});
    }
    const BoxTree tree(places);
    return parts_about_.emplace(scene.environment, [&tree](const Box2& box) {
        bool is_near = false;
        tree.search(box, [&is_near](std::size_t) { is_near = true; });
        return is_near;
    });
}

std::map<std::size_t, MeshCuts>& CheckContext::meshes() {
    if (meshes_) return *meshes_;
    meshes_.emplace();
    const std::vector<Element>& elements = scene.environment.elements();
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (!elements[i].body.meshes.empty()) meshes_->emplace(i, MeshCuts(elements[i].body));
    return *meshes_;
}

const std::multimap<std::size_t, Finding>& CheckContext::walls() {
    if (!walls_) walls_ = wallFindings(*this);
    return *walls_;
}

CircleCheck& CheckContext::circles() {
    if (!circles_) circles_.emplace(*this);
    return *circles_;
}

bool CheckContext::isObject(std::size_t element) const {
    const RecordType type = this->element(element).record.schema().type;
    return type == RecordType::Other || type == RecordType::Infra;
}

std::string CheckContext::name(std::size_t record) const {
    const Record& named = scene.records[record];
    return named.writtenId().empty() ? scene.ids[record]
                                     : named.keyword() + ' ' + scene.ids[record];
}

std::string CheckContext::elementName(std::size_t element) const { return name(records[element]); }

Finding CheckContext::finding(std::size_t record, Severity severity, Point2 at,
                              const std::string& message, std::string hint) const {
    return {severity,
            scene.ids[record],
            at,
            name(record) + message,
            std::move(hint),
            scene.records[record].place()};
}

Finding CheckContext::warning(std::size_t element, Point2 at, const std::string& message,
                              std::string hint) const {
    return finding(records[element], Severity::Warning, at, message, std::move(hint));
}

std::string distanceText(double way) {
    return formatFixed(std::ceil(100 * way - 1e-6) / 100, 2) + " m";
}

void ThingCheck::checkObject(std::size_t element, std::vector<Finding>& findings) {
    bool in_wall = isPartOfBuilding(element);
    for (const std::size_t other : neighbours(element)) {
        if (isFull(findings)) return;
        if (isPartOfBuilding(element) && isPartOfBuilding(other)) continue;
        const auto place = shared(element, other);
        if (!place) continue;
        const bool is_wall = !context_->isObject(other);
        in_wall = in_wall || is_wall;
        std::string hint = is_wall ? "move it" : "move one";
        if (place->way > 0) hint += ", e.g. by " + distanceText(place->way);
        findings.push_back(context_->warning(
            element, place->place,
            " overlaps " + context_->elementName(other) + " near " + placeText(place->place),
            std::move(hint)));
    }
    checkInRoom(element, in_wall, findings);
}

/// Pillars stand in walls and carry ceiling frames.
bool ThingCheck::isPartOfBuilding(std::size_t element) const {
    const Record& record = context_->element(element).record;
    return !context_->isObject(element) || record.schema().type == RecordType::Infra;
}

std::vector<std::size_t> ThingCheck::neighbours(std::size_t element) const {
    std::vector<std::size_t> out;
    const auto add = [&](std::size_t other) {
        if (other != element && (other > element || !context_->isObject(other)))
            out.push_back(other);
    };
    const auto look = [&](const Box2& box, const auto& heights) {
        context_->parts().search(box, [&](const Part& part) {
            if (sharedHeights(part, heights).isShared()) add(part.element);
        });
        for (const auto& [other, mesh] : context_->meshes())
            if (mesh.box().meets(box) && sharedHeights(mesh.heights(), heights).isShared())
                add(other);
    };
    for (const Part& part : context_->parts().of(element)) look(bounds(part.footprint), part);
    const auto mesh = context_->meshes().find(element);
    if (mesh != context_->meshes().end()) look(mesh->second.box(), mesh->second.heights());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::optional<ThingCheck::Shared> ThingCheck::shared(std::size_t a, std::size_t b) {
    if (auto found = sharedParts(a, b)) return found;
    auto& meshes = context_->meshes();
    const auto mesh_a = meshes.find(a), mesh_b = meshes.find(b);
    std::optional<Point2> place;
    if (mesh_a != meshes.end() && mesh_b != meshes.end())
        place = sharedMeshes(mesh_a->second, mesh_b->second);
    if (!place && mesh_a != meshes.end()) place = sharedMesh(mesh_a->second, b);
    if (!place && mesh_b != meshes.end()) place = sharedMesh(mesh_b->second, a);
    return place ? std::optional(Shared{*place}) : std::nullopt;
}

std::optional<ThingCheck::Shared> ThingCheck::sharedParts(std::size_t a, std::size_t b) const {
    // For elements of very many parts, only overlapping pairs determine the translation.
    constexpr std::size_t kMaxPairs = 400;
    const auto parts_a = context_->parts().of(a);
    const bool is_wall = !context_->isObject(b);
    std::vector<PartPair> overlapping, beside;
    std::optional<Overlap> deepest;
    PartPair deepest_pair;
    const auto look = [&](const Part& first, const Part& second) {
        if (!sharedHeights(first, second).isShared()) return;
        if (beside.size() < kMaxPairs) beside.push_back({&first, &second});
        const auto overlap = overlapOf(first.footprint, second.footprint);
        if (!overlap) return;
        if (overlapping.size() < kMaxPairs) overlapping.push_back({&first, &second});
        if (deepest && deepest->depth >= overlap->depth) return;
        deepest = overlap;
        deepest_pair = {&first, &second};
    };
    for (const Part& first : parts_a) {
        context_->parts().search(bounds(first.footprint), [&](const Part& second) {
            if (second.element == b) look(first, second);
        });
    }
    if (!deepest) return std::nullopt;
    const bool few = !is_wall && parts_a.size() * context_->parts().of(b).size() <= kMaxPairs;
    return Shared{deepest->place, wayApart(few ? beside : overlapping, deepest_pair)};
}

std::optional<Point2> ThingCheck::sharedMesh(MeshCuts& mesh, std::size_t other) {
    for (const Part& part : context_->parts().of(other)) {
        const HeightRange heights = sharedHeights(mesh.heights(), part);
        if (!heights.isShared() || !mesh.box().meets(bounds(part.footprint))) continue;
        for (const double height : mesh.heightsIn(heights))
            if (auto place = sharedPlace(mesh.at(height), part.footprint)) return place;
    }
    return std::nullopt;
}

std::optional<Point2> ThingCheck::sharedMeshes(MeshCuts& a, MeshCuts& b) {
    const HeightRange heights = sharedHeights(a.heights(), b.heights());
    if (!heights.isShared() || !a.box().meets(b.box())) return std::nullopt;
    for (const double height : a.heightsIn(heights))
        if (auto place = sharedPlace(a.at(height), b.at(height))) return place;
    return std::nullopt;
}

void ThingCheck::checkInRoom(std::size_t element, bool in_wall,
                             std::vector<Finding>& findings) const {
    std::optional<Point2> out, in;
    const auto look = [&](const Box2& box, const auto& points, const auto& on_floor) {
        // Away from the walls one point decides for all.
        bool near = false;
        context_->indoor.edgesIn(box, [&near](const Segment2& /*edge*/) { near = true; });
        for (const auto& point : points) {
            const Point2 p = on_floor(point);
            std::optional<Point2>& side = context_->isOut(p) ? out : in;
            if (!side) side = p;
            if (!near || (out && in)) return;
        }
    };
    for (const Part& part : context_->parts().of(element))
        look(bounds(part.footprint), part.footprint, [](Point2 p) { return p; });
    const auto mesh = context_->meshes().find(element);
    if (mesh != context_->meshes().end())
        for (const Mesh& part : context_->element(element).body.meshes)
            look(mesh->second.box(), part.vertices, [](const Point3& p) { return p.onFloor(); });
    if (!out || (in && in_wall)) return;
    findings.push_back(context_->warning(
        element, *out,
        (in ? " lies partly outside the room near " : " lies outside the room near ") +
            placeText(*out),
        "move it in or leave it out"));
}

void ThingCheck::checkZone(std::size_t element, std::vector<Finding>& findings) const {
    const RegionIndex& indoor = context_->indoor;
    const Polygon outline = zoneOutline(context_->element(element).record);
    bool in = false;
    for (const Point2 p : outline) in = in || indoor.locate(p) == Side::Inside;
    // The room may lie in the zone, or both run through each other.
    indoor.edgesIn(bounds(outline), [&](const Segment2& edge) {
        in = in || placeWithin(edge, outline).has_value();
    });
    if (!in) in = indoor.locate(interiorPoint({outline, {}})) == Side::Inside;
    if (!in)
        findings.push_back(context_->warning(
            element, outline.front(), " lies outside the room near " + placeText(outline.front()),
            "move it in or leave it out"));
}

}  // namespace ispace
