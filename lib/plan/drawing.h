// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/io only: a plan as things to draw, between the scene and its pictures (plan_*.cc).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "draw/picture.h"
#include "geom/box.h"
#include "layout/scene.h"

namespace ispace {

/// What belongs together, in the order of drawing. Fields of view lie below all that stands.
enum class PlanLayer {
    Floor,
    Grid,
    Zones,
    Views,
    Objects,
    Walls,
    Openings,
    Infra,
    Robots,
    Sensors,
    Labels,
    Frame
};
constexpr std::array<std::string_view, 12> kPlanLayers = {
    "floor",           "grid",  "zones",  "fields of view", "objects", "walls",
    "doors & windows", "infra", "robots", "sensors",        "labels",  "frame"};

/// Curves, filled by the even-odd rule and stroked. Places are in metres; widths and dashes of the
/// line are in sizes of text.
struct DrawnPath {
    std::vector<std::vector<Point2>> curves;
    bool closed = true;
    std::optional<Color> fill = {};
    std::optional<Stroke> line = {};
};

/// A line of text at a place in metres; sizes are of the plan's text.
struct DrawnText {
    Point2 anchor;
    std::string text;
    double size = 1;
    Align align = Align::Left;
    Color color = {};
    bool bold = false;
    bool halo = false;
};

/// An element, or a part of the frame.
struct DrawnItem {
    PlanLayer layer = PlanLayer::Floor;
    std::string id = {};     ///< "" for what has no name
    std::string title = {};  ///< what it is, in words
    std::vector<DrawnPath> paths = {};
    std::vector<DrawnText> texts = {};
};

/// Everything on the page, in the order of drawing within each layer.
struct PlanDrawing {
    double width = 0, height = 0;  ///< of the page: pixels or millimetres
    double em = 0;                 ///< size of text on it
    PageView view;                 ///< metres to the page
    Box2 box;                      ///< what the plan shows, metres
    Regions indoor;                ///< fields of view are drawn on it alone
    std::vector<DrawnItem> items = {};

    /// Size of text in metres of the plan.
    [[nodiscard]] double metres() const { return em / view.scale; }
};

/// Colours of what is no material.
namespace plan_colors {
constexpr Color kInk = Color::rgb(0x1F2328);
constexpr Color kFaintInk = Color::rgb(0x656D76);
constexpr Color kPaper = Color::rgb(0xFFFFFF);
constexpr Color kIndoor = Color::rgb(0xF8F4EC);
constexpr Color kGrid = Color::rgb(0x7A8794);
constexpr Color kWall = Color::rgb(0x2B3036);
constexpr Color kLowWall = Color::rgb(0xB9BDC1);
constexpr Color kWallEdge = Color::rgb(0x24292F);
constexpr Color kGlass = Color::rgb(0x2F7EA8);
constexpr Color kDoor = Color::rgb(0x7A5230);
constexpr Color kOutside = Color::rgb(0xD5D7DA);
constexpr Color kSensor = Color::rgb(0xB3261E);
}  // namespace plan_colors

/// What the plan shows: the limits with walls' thickness, and what stands near them.
Box2 planBox(const Scene& scene);

/// A circle of chords, counter-clockwise; a part of it from one angle to the next.
std::vector<Point2> planCircle(Point2 center, double radius);
std::vector<Point2> planArc(Point2 center, double radius, Angle from, Angle to);

// Each adds the items of its layers; all count on width to box of the drawing.
void addRoom(PlanDrawing& plan, const Scene& scene);
void addThings(PlanDrawing& plan, const Scene& scene);
void addPlaced(PlanDrawing& plan, const Scene& scene);
void addObstacles(PlanDrawing& plan, const Environment& environment, double height);
/// Grid, coordinates, title, bar of scale and what is said beside it.
void addFrame(PlanDrawing& plan, const std::string& title, const std::vector<std::string>& notes);

std::string writePlan(const PlanDrawing& plan, PictureFormat format, const std::string& title);

}  // namespace ispace
