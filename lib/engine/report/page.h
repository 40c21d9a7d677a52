// SPDX-License-Identifier: GPL-3.0-or-later
// Reports for people, as pages of blocks: sections of reports add to them, and extensions write
// them.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "base/number.h"
#include "drawing/drawing.h"
#include "geom/pose.h"
#include "report/text_table.h"

namespace ispace {

/// Formats an area for people: "12.30 m2".
inline std::string squareMetres(double area) { return formatFixed(area, 2) + " m2"; }

/// The emphasis of a paragraph, or of a row of a table.
enum class Tone { Plain, Good, Bad, Small };

struct PageText {
    std::string text;
    Tone tone = Tone::Plain;
};

struct PageTable {
    std::string caption;
    std::string sides;  ///< as of aligned()
    TextRow heads;
    std::vector<TextRow> rows;
    std::vector<Tone> tones = {};  ///< of the rows; missing ones are plain
};

/// Lines of text to copy: commands, records.
struct PageCode {
    std::string text;
};

/// A sensor, for the script of a map, which computes how well the sensor sees a point.
struct MapSensor {
    std::string id, noun;
    Pose3 pose;
    double plane = 0;  ///< height of the floor that it covers
    Color color = palette::kSensor;
    /// Of a camera: pixels a radian (see LensResolution) at even steps of the angle off the axis up
    /// to `widest`, for each of `bearings` even steps of the bearing about the axis in turn.
    std::vector<double> resolution = {};
    std::size_t bearings = 1;
    Angle widest = {};
};

/// A map that the script of an HTML page makes interactive: layers to switch, zoom, and a readout
/// of the sensors that see a spot. The picture's layer `views` holds a group for each sensor, in
/// order, with its region as the first path.
struct MapIndex {
    PageView view;
    std::vector<MapSensor> sensors;
    std::vector<std::string> hidden;  ///< layers that are off at first
};

struct PageFigure {
    std::string caption;
    Picture picture;
    double width = 1;            ///< share of the column's width, on paper and on wide screens
    bool is_for_screen = false;  ///< paper omits it
};

/// A figure for paper, and the one in its place on screens.
struct PageMap {
    PageFigure paper;
    Picture screen;
    MapIndex index;
};

using PageBlock = std::variant<PageText, PageTable, PageCode, PageFigure, PageMap>;

struct PageSection {
    std::string id;  ///< of the HTML element, unique on the page
    std::string title;
    std::vector<PageBlock> blocks = {};
    bool begins_sheet = false;  ///< on paper
};

/// Names on a report that is handed over; empty ones are left out.
struct PageCover {
    std::string title;  ///< in place of that of the page
    std::string project, client, author;
    std::string logo;  ///< bytes of a PNG file
    [[nodiscard]] bool isGiven() const {
        return !(title.empty() && project.empty() && client.empty() && author.empty() &&
                 logo.empty());
    }
};

enum class Paper { A4, Letter };

struct ReportPage {
    std::string title, subtitle;
    std::vector<PageSection> sections = {};
    PageCover cover = {};
    Paper paper = Paper::A4;
};

}  // namespace ispace
