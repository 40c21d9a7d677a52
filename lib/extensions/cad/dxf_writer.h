// SPDX-License-Identifier: GPL-3.0-or-later
// Writes ASCII DXF of AutoCAD 2000 (AC1015), with colours of layers as true colours (group 420, of
// AutoCAD 2004), which readers skip that do not know them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drawing/color.h"
#include "geom/curve.h"
#include "geom/polygon.h"

namespace ispace::cad {

/// A layer of a drawing; it defines the colour of its entities.
struct DxfLayer {
    std::string name;
    Color color;
};

/// Vertical extent of a flat entity in metres: elevation and thickness, in DXF's terms.
struct DxfExtrusion {
    double bottom = 0, height = 0;
};

/// Name under which extended data of entities is ours: a distance, the depth of an opening through
/// its wall in units of the drawing, and texts about the pane of a window.
constexpr const char* kDxfApplication = "ISPACE";
constexpr const char kDxfGlass[] = "glass=";  ///< before a choice of the key
constexpr const char kDxfOpen[] = "open=yes", kDxfBlind[] = "blind=yes";

/// Extended data of an opening.
struct DxfOpening {
    double depth = 0;                    ///< through its wall; 0: none
    std::vector<std::string> pane = {};  ///< texts about it
};

/// Writes a drawing in ASCII DXF (AutoCAD 2000) through dxflib: metres ($INSUNITS 6), coordinates
/// in shortest form. Entities refer to their layer by name. Equal calls give equal bytes.
class DxfWriter {
  public:
    explicit DxfWriter(const std::vector<DxfLayer>& layers);
    ~DxfWriter();
    DxfWriter(const DxfWriter&) = delete;
    DxfWriter& operator=(const DxfWriter&) = delete;

    void line(const std::string& layer, const Segment2& segment);
    /// Writes a polyline, `width` metres wide; a closed one does not repeat its first point.
    void path(const std::string& layer, const std::vector<Point2>& points, bool closed,
              double width = 0, DxfExtrusion upright = {}, const DxfOpening& opening = {});
    /// Writes a closed polyline with true arcs.
    void curve(const std::string& layer, const Curve& curve);
    void circle(const std::string& layer, Point2 center, double radius, DxfExtrusion upright = {});
    /// Writes a solid filling without the holes.
    void area(const std::string& layer, const Region& region);
    /// Writes a line of text, `height` metres high, that begins at `place`. Blanks replace control
    /// characters.
    void text(const std::string& layer, Point2 place, const std::string& text, double height);

    /// Returns the file. No further entity may be written.
    std::string finish();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace ispace::cad
