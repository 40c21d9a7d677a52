// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "env/band.h"
#include "env/body.h"
#include "env/slice.h"
#include "geom/polygon.h"
#include "record/record.h"

namespace ispace {

/// Height at which free floor is judged if nobody says otherwise: the scanning height of a sensor
/// that stands on the floor.
constexpr double kScanHeight = 0.15;

/// One record of the environment with its shape.
struct Element {
    Record record;
    std::string id;
    Body body;
};

/// A room: its elements and the region they enclose. Immutable.
class Environment {
  public:
    /// Takes the environment records among `records` (others are left alone). `ids` as of
    /// assignIds(records). O(n log n) for plans whose walls meet at their ends or cross now and
    /// then.
    /// \throws FormatError with all findings: zero-length walls, zero sizes, crossing zone or
    ///         fence outlines, doors and windows that are in no wall or overlap, nothing that
    ///         encloses, or lines that do not close ("not enclosed: 0.12 m between w3 and w4 near
    ///         (4.1, 2.0)"); the last two only where every wall has made its lines
    Environment(std::span<const Record> records, std::span<const std::string> ids);

    [[nodiscard]] const std::vector<Element>& elements() const { return elements_; }
    /// Bounding rectangle of the wall lines (thesis, Limit Acquire).
    [[nodiscard]] const Box2& limits() const { return limits_; }
    /// The faces of the wall lines that hold the inside points, each with those joined to it by
    /// open doors, directly or through others: mostly one part, and one for each room where
    /// several are meant. Openings else do not count: an open door to the outside joins nothing.
    /// Walls that stand within the joined rooms bound nothing.
    [[nodiscard]] const Regions& indoor() const { return indoor_; }
    /// The known inside point: the first record's, else the origin if it lies strictly in a bounded
    /// face, else a point of the largest face.
    [[nodiscard]] Point2 inside() const { return inside_; }
    /// The wall lines, welded, with all openings closed; for drawings, and for the parity rule
    /// where no open door joins rooms: there the lines that enclose are the edges of indoor().
    [[nodiscard]] const std::vector<Segment2>& wallLines() const { return wall_lines_; }
    /// Height of the highest wall, in metres.
    [[nodiscard]] double height() const { return height_; }

    /// What stands at this height (prisms are closed: their top and bottom count).
    [[nodiscard]] Slice slice(double height) const;
    /// What stands anywhere between the two heights, ends included. \pre bottom <= top
    [[nodiscard]] Band band(double bottom, double top) const;
    /// Indoor less the solids at this height.
    [[nodiscard]] std::vector<Region> freeFloor(double height) const;

  private:
    std::vector<Element> elements_;
    std::vector<Segment2> wall_lines_;
    Box2 limits_;
    Regions indoor_;
    Point2 inside_;
    double height_ = 0;
};

}  // namespace ispace
