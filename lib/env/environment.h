// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "env/body.h"
#include "env/slice.h"
#include "geom/polygon.h"
#include "record/record.h"

namespace ispace {

/// Default height of the free floor: that at which a sensor standing on the floor scans.
constexpr double kScanHeight = 0.15;

/// One record of the environment with its shape.
struct Element {
    Record record;
    std::string id;
    Body body;
};

class Level;
class RegionIndex;

/// A room: its elements and the region they enclose. Immutable; copies share everything.
class Environment {
  public:
    /// Reads the environment records among `records` and skips others. `ids` as of
    /// assignIds(records). O(n log n) for plans whose walls meet at their ends or cross now and
    /// then.
    /// \throws FormatError with all findings: zero-length walls, zero sizes, crossing zone or
    ///         fence outlines, doors and windows that are in no wall or overlap, nothing that
    ///         encloses, or lines that do not close ("not enclosed: 0.12 m between w3 and w4 near
    ///         (4.1, 2.0)"); the last two only where every wall has made its lines
    Environment(std::span<const Record> records, std::span<const std::string> ids);

    [[nodiscard]] const std::vector<Element>& elements() const { return data_->elements; }
    /// Bounding rectangle of the wall lines (thesis, Limit Acquire).
    [[nodiscard]] const Box2& limits() const { return data_->limits; }
    /// The faces of the wall lines that hold the inside points, each with those joined to it by
    /// open doors, directly or through others: mostly one part, and one for each room where
    /// several are meant. Openings else do not count: an open door to the outside joins nothing.
    /// Walls that stand within the joined rooms are no boundary.
    [[nodiscard]] const Regions& indoor() const { return data_->indoor; }
    /// The same, made for very many questions; built when first asked for.
    [[nodiscard]] const RegionIndex& indoorIndex() const { return data_->indoorIndex(); }
    /// The floor of the indoor region at z = 0.
    [[nodiscard]] Mesh floor() const;
    /// The known inside point: the first record's, else the origin if it lies strictly in a bounded
    /// face, else a point of the largest face.
    [[nodiscard]] Point2 inside() const { return data_->inside; }
    /// The wall lines, welded, with all openings closed; for drawings, and for the parity rule
    /// where no open door joins rooms: there the lines that enclose are the edges of indoor().
    [[nodiscard]] const std::vector<Segment2>& wallLines() const { return data_->wall_lines; }
    /// Of its records, see environmentDigest(). Computed when it is first asked for; thread-safe.
    [[nodiscard]] const std::string& digest() const;
    /// Height of the highest wall, in metres.
    [[nodiscard]] double height() const { return data_->height; }

    /// Returns the level at a height: its slice, free floor, point location and visibility, see
    /// env/level.h. Thread-safe. Recent levels are cached, depending on their size; callers keep
    /// the pointer of a level that they use for long.
    [[nodiscard]] std::shared_ptr<const Level> level(double height) const;
    /// Computes the slice that stops light at this height (prisms are closed: top and bottom
    /// count). Computed at each call; a level stores its slice.
    [[nodiscard]] Slice slice(double height) const { return data_->slice(height); }
    /// Computes the band between two heights, ends included, with clear glass. \pre bottom <= top
    [[nodiscard]] Slice band(double bottom, double top) const;

  private:
    friend class Level;
    struct Data {
        std::vector<Element> elements = {};
        std::vector<Segment2> wall_lines = {};
        Box2 limits = {};
        Regions indoor = {};
        Point2 inside = {};
        double height = 0;

        [[nodiscard]] Slice slice(double at) const;
        [[nodiscard]] const RegionIndex& indoorIndex() const;
        Lazy<std::shared_ptr<const RegionIndex>> indoor_index = {};
        /// The triangles of each part of the region.
        [[nodiscard]] const std::vector<Triangulation>& floorParts() const;
        Lazy<std::vector<Triangulation>> floor = {};
        Lazy<std::string> digest = {};
    };
    struct Levels;

    std::shared_ptr<const Data> data_;
    std::shared_ptr<Levels> levels_;  // apart from the data, which levels hold
};

/// Measures of an environment, for people and for `envc --info --json`.
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

/// One JSON object and a newline, schema ispace-info/1.
std::string infoJson(const EnvironmentInfo& info);
std::string infoText(const EnvironmentInfo& info);

/// Findings about the shape of a record beyond its schema and its wall lines: zones and closed
/// fences that cross themselves, zones without extent, bodies too small for their place, files of
/// meshes that are not loaded or hold no body.
void checkShape(const Record& record, const Body& body, Diagnostics& findings);

/// Writes a point as on a plan, to the centimetre: "(4.1, 2.0)".
std::string placeText(Point2 p);

/// "wall w3", "door d1": how findings name an element.
std::string nameOf(const Element& element);

/// A length as findings give it: at least millimetres and at least two digits: "0.12", "0.0012".
std::string lengthText(double length);

}  // namespace ispace
