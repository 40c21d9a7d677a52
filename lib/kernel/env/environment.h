// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/env: the environment: its records, bodies, indoor region, slices, mesh. Uses record,
// geom.
//
// An environment is immutable, and all that is derived from it (levels, regions, indexes) depends
// on the records alone, whichever thread asks first. The index of the indoor region and the digest
// are computed once, the latest levels are cached (64, with up to half a million lines), slices are
// computed at each call. Metres, x-y floor, z up. Copies cost two counters; an edit shares all that
// it does not change.
//
//     const Environment room(records, assignIds(records));
//     const double area = room.indoor().area();                // m2
//     const std::shared_ptr<const Level> level = room.level(0.3);
//     const bool is_free = level->isFree({2, 1});
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "env/body.h"
#include "env/slice.h"
#include "geom/polygon.h"
#include "record/record.h"

namespace ispace {

/// Default height of the free floor: the scan height of a sensor on the floor.
constexpr double kScanHeight = 0.15;

/// One record of the environment with its id and its body. Copies share the body.
struct Element {
    Record record;
    std::string id;
    std::shared_ptr<const Body> shape;
    /// Ascending. An edit keeps the slots of the elements that stay, and that of one it replaces.
    std::size_t slot = 0;
    const Body& body = *shape;
};

/// The difference between the elements of two environments, ascending. An element that an edit
/// replaces is in both lists.
struct ElementChanges {
    std::vector<std::size_t> removed;  ///< indices in the elements of the first
    std::vector<std::size_t> added;    ///< indices in the elements of the second
    [[nodiscard]] std::size_t size() const { return removed.size() + added.size(); }
};

class Level;
class RegionIndex;

/// A room: its elements and the region they enclose. Immutable; copies share all data.
class Environment {
  public:
    /// Reads the environment records among `records` and skips others. `ids` are those of
    /// assignIds(records). O(n log n) for plans with walls that meet at their ends or cross now
    /// and then.
    /// \throws FormatError with all findings: zero-length walls, zero sizes, crossing zone or
    ///         fence outlines, doors and windows that lie in no wall or overlap, missing walls, or
    ///         lines that do not close ("not enclosed: 0.12 m between w3 and w4 near (4.1, 2.0)");
    ///         reports the last two only if every wall record has valid lines
    Environment(std::span<const Record> records, std::span<const std::string> ids);
    /// Builds the same, sharing with another environment the data that its records do not change:
    /// everything if all are equal, else the walls and the equal elements if walls, openings and
    /// inside points are equal. O(n) comparisons, then, and the work of the changed elements.
    Environment(std::span<const Record> records, std::span<const std::string> ids,
                const Environment& before);

    /// Compares the elements with those of `before`. Empty unless both share their walls and so few
    /// elements differ that data made of `before` are worth an update. O(n)
    [[nodiscard]] std::optional<ElementChanges> changesSince(const Environment& before) const;

    [[nodiscard]] const std::vector<Element>& elements() const { return data_->elements; }
    /// Returns the bounding rectangle of the wall lines (thesis, Limit Acquire).
    [[nodiscard]] const Box2& limits() const { return data_->walls->limits; }
    /// Returns the faces of the wall lines that contain the inside points, each merged with the
    /// faces that open doors join to it, directly or through others: usually one part, or one per
    /// room if several rooms have inside points. Windows, closed doors and open doors to the
    /// outside join no faces. Walls within the joined rooms are not part of the boundary.
    [[nodiscard]] const Regions& indoor() const { return data_->walls->indoor; }
    /// Returns an index of indoor() for bulk queries; built at the first call.
    [[nodiscard]] const RegionIndex& indoorIndex() const { return data_->walls->indoorIndex(); }
    /// Returns the floor of the indoor region at z = 0.
    [[nodiscard]] Mesh floor() const;
    /// Returns the known inside point: the first record's, else the origin if it lies strictly in a
    /// bounded face, else a point of the largest face.
    [[nodiscard]] Point2 inside() const { return data_->walls->inside; }
    /// Returns the wall lines, welded, with all openings closed, for drawings. The parity rule may
    /// use them only if no open door joins rooms; otherwise use the edges of indoor().
    [[nodiscard]] const std::vector<Segment2>& wallLines() const { return data_->walls->lines; }
    /// Returns environmentDigest() of its records. Computed at the first call; thread-safe.
    [[nodiscard]] const std::string& digest() const;
    /// Returns the height of the highest wall, in metres.
    [[nodiscard]] double height() const { return data_->walls->height; }

    /// Returns the level at a height: its slice, free floor, point location and visibility, see
    /// env/level.h. Thread-safe. Caches recent levels up to a total size; store the pointer of a
    /// level that you use for long.
    [[nodiscard]] std::shared_ptr<const Level> level(double height) const;
    /// Computes the slice that stops light at this height (prisms are closed: top and bottom
    /// count). Computed at each call; a level stores its slice.
    [[nodiscard]] Slice slice(double height) const { return data_->slice(height); }
    /// Computes the band between two heights, ends included, with clear glass. \pre bottom <= top
    [[nodiscard]] Slice band(double bottom, double top) const;
    /// These of some elements alone, given by their indices.
    [[nodiscard]] Slice slice(double height, std::span<const std::size_t> which) const;
    [[nodiscard]] Slice band(double bottom, double top, std::span<const std::size_t> which) const;

  private:
    friend class Level;
    /// The data that walls, openings and inside points determine.
    struct Walls {
        std::vector<Segment2> lines = {};
        Box2 limits = {};
        Regions indoor = {};
        Point2 inside = {};
        double height = 0;

        [[nodiscard]] const RegionIndex& indoorIndex() const;
        Lazy<std::shared_ptr<const RegionIndex>> indoor_index = {};
        /// Returns the triangles of each part of the region.
        [[nodiscard]] const std::vector<Triangulation>& floorParts() const;
        Lazy<std::vector<Triangulation>> floor = {};
    };
    struct Data {
        std::vector<Element> elements = {};
        std::size_t corners = 0;  ///< of the shapes that records give
        std::shared_ptr<const Walls> walls = {};

        [[nodiscard]] Slice slice(double at) const;
        Lazy<std::string> digest = {};
    };
    struct Levels;

    std::shared_ptr<const Data> data_;
    std::shared_ptr<Levels> levels_;  // separate from the data, which levels share
};

/// Measures of an environment, for messages and for `envc --info --json`.
struct EnvironmentInfo {
    std::string digest;
    Box2 limits;
    double indoor_area = 0;             ///< m2
    double free_area = 0;               ///< m2, at kScanHeight
    double height = 0;                  ///< the highest wall, m
    double perimeter = 0;               ///< of the indoor region, holes included, m
    std::map<std::string, int> counts;  ///< records by keyword
    std::size_t triangles = 0;          ///< of bodies and floor
};

EnvironmentInfo describe(const Environment& environment, std::span<const Record> records,
                         const std::string& digest);

/// Returns one JSON object and a newline, schema ispace-info/1.
std::string infoJson(const EnvironmentInfo& info);
std::string infoText(const EnvironmentInfo& info);

/// Reports defects in the shape of a record beyond its schema and its wall lines: zones and closed
/// fences that cross themselves, zones without extent, bodies too small for their distance from the
/// origin, mesh files that are not loaded or contain no body.
void checkShape(const Record& record, const Body& body, Diagnostics& findings);

/// Formats a point to the centimetre: "(4.1, 2.0)".
std::string placeText(Point2 p);

/// Returns the name of an element in findings: "wall w3", "door d1".
std::string nameOf(const Element& element);

/// Formats a length for findings, to the millimetre or to two digits if that is finer: "0.12",
/// "0.0012".
std::string lengthText(double length);

}  // namespace ispace
