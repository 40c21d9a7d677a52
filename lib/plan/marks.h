// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "draw/palette.h"
#include "draw/picture.h"
#include "geom/box.h"
#include "layout/scene.h"
#include "sensor/kind.h"

namespace ispace {

/// Mark of a sensor: a body by its kind, and an arrow where it looks aside.
struct SensorMark {
    SensorSign sign = SensorSign::Disc;
    std::optional<Angle> heading = {};  ///< as seen, y up; none: it looks straight up or down
    Color color = palette::kInk;
    bool hollow = false;
};

/// The bearings that a placed sensor shows on a plan.
BearingSpan bearingsOf(const Scene& scene, const Placed& placed);

/// The level part of where a pose looks, if there is one.
std::optional<Angle> headingOf(const Pose3& pose);

/// At a place of the page.
void drawSensorMark(Picture& picture, Point2 page, const SensorMark& mark, double radius);

/// Puts signs and labels where they cover least. All in page units.
class LabelPlacer {
  public:
    LabelPlacer(const Box2& frame, double em) : frame_(frame), em_(em) {}

    /// A mark and its arrow, which nothing should cover.
    void addMark(Point2 page, std::optional<Angle> heading);
    /// Place for a sign of this radius: its own, or the next one around it that is free.
    Point2 placeSign(Point2 page, double radius);
    /// Middle of the label of a mark, or nothing where it would cover another label, or another
    /// mark in a crowd. Of the places around the mark, those behind the heading come first.
    std::optional<Point2> placeLabel(Point2 page, Angle heading, double width, double size,
                                     bool crowd);
    /// True if nothing else lies in the box, which is then taken.
    bool take(const Box2& box);

  private:
    [[nodiscard]] double costOf(const Box2& box) const;

    Box2 frame_;
    double em_;
    std::vector<Box2> marks_, labels_;
};

}  // namespace ispace
