// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/dxf_writer.h"

#include <dxflib/dl_dxf.h>
#include <dxflib/dl_writer_ascii.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/number.h"

namespace ispace::cad {

namespace {

constexpr int kMetres = 6;     // $INSUNITS
constexpr int kByLayer = 256;  // colour of entities
constexpr int kWhite = 7;      // a layer's colour for readers that support only the old palette
constexpr int kClosed = 1;

/// dxflib's writer with output to a string, and doubles with all digits.
class StringWriter : public DL_WriterA {
  public:
    StringWriter() : DL_WriterA("/dev/null", DL_VERSION_2000) {}

    void dxfReal(int code, double value) const override { group(code, formatDouble(value)); }
    void dxfInt(int code, int value) const override { group(code, std::to_string(value)); }
    void dxfHex(int code, int value) const override {
        std::array<char, 24> digits{};
        std::snprintf(digits.data(), digits.size(), "%X", static_cast<unsigned>(value));
        group(code, digits.data());
    }
    void dxfString(int code, const char* value) const override { group(code, value); }
    void dxfString(int code, const std::string& value) const override { group(code, value); }

    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    void group(int code, std::string_view value) const {
        text_ += std::to_string(code);
        text_ += '\n';
        text_ += value;
        text_ += '\n';
    }

    mutable std::string text_;
};

int trueColor(const Color& color) {
    const auto part = [](double share) { return static_cast<int>(std::lround(share * 255)); };
    return (part(color.red) << 16) | (part(color.green) << 8) | part(color.blue);
}

/// Returns an entity's attributes: all but the layer as the layer defines them.
DL_Attributes on(const std::string& layer) { return {layer, kByLayer, -1, "BYLAYER", 1}; }

/// Returns tan(sweep / 4) of an edge, by which polylines store arcs.
double bulgeOf(const CurveEdge& edge) {
    if (!edge.isArc()) return 0;
    const Vec2 from = edge.from - edge.center, to = edge.to - edge.center;
    const double turn = std::atan2(cross(from, to), dot(from, to));
    const double sweep = edge.radius > 0 ? turn : -turn;
    const double whole = sweep < 0 ? sweep + 2 * 3.14159265358979323846 : sweep;
    return std::copysign(std::tan(whole / 4), edge.radius);
}

}  // namespace

struct DxfWriter::Parts {
    StringWriter out;
    DL_Dxf dxf;

    void writeTables(const std::vector<DxfLayer>& layers) {
        out.sectionTables();
        dxf.writeVPort(out);
        out.tableLinetypes(3);
        for (const char* name : {"BYBLOCK", "BYLAYER", "CONTINUOUS"})
            dxf.writeLinetype(out, DL_LinetypeData(name, name, 0, 0, 0.0));
        out.tableEnd();
        out.tableLayers(static_cast<int>(layers.size()) + 1);
        dxf.writeLayer(out, DL_LayerData("0", 0), DL_Attributes("", kWhite, -1, "CONTINUOUS", 1));
        for (const DxfLayer& layer : layers)
            dxf.writeLayer(out, DL_LayerData(layer.name, 0),
                           DL_Attributes("", kWhite, trueColor(layer.color), -1, "CONTINUOUS"));
        out.tableEnd();
        out.tableStyle(1);
        dxf.writeStyle(out, DL_StyleData("Standard", 0, 0.0, 1.0, 0.0, 0, 0.2, "txt", ""));
        out.tableEnd();
        dxf.writeView(out);
        dxf.writeUcs(out);
        out.tableAppid(2);
        dxf.writeAppid(out, "ACAD");
        dxf.writeAppid(out, kDxfApplication);
        out.tableEnd();
        dxf.writeDimStyle(out, 0.2, 0.1, 0.1, 0.1, 0.2);
        dxf.writeBlockRecord(out);
        out.tableEnd();
        out.sectionEnd();
    }

    void writeBlocks() {
        out.sectionBlocks();
        for (const char* name : {"*Model_Space", "*Paper_Space", "*Paper_Space0"}) {
            dxf.writeBlock(out, DL_BlockData(name, 0, 0.0, 0.0, 0.0));
            dxf.writeEndBlock(out, name);
        }
        out.sectionEnd();
    }

    void beginPolyline(const std::string& layer, std::size_t points, bool closed) {
        const int count = static_cast<int>(points);
        dxf.writePolyline(out, DL_PolylineData(count, 0, 0, closed ? kClosed : 0), on(layer));
    }
};

DxfWriter::DxfWriter(const std::vector<DxfLayer>& layers) : parts_(std::make_unique<Parts>()) {
    StringWriter& out = parts_->out;
    parts_->dxf.writeHeader(out);
    out.dxfString(9, "$INSUNITS");
    out.dxfInt(70, kMetres);
    out.dxfString(9, "$MEASUREMENT");
    out.dxfInt(70, 1);
    out.sectionEnd();
    parts_->writeTables(layers);
    parts_->writeBlocks();
    out.sectionEntities();
}

DxfWriter::~DxfWriter() = default;

void DxfWriter::line(const std::string& layer, const Segment2& segment) {
    const auto& [a, b] = segment;
    parts_->dxf.writeLine(parts_->out, DL_LineData(a.x, a.y, 0, b.x, b.y, 0), on(layer));
}

void DxfWriter::path(const std::string& layer, const std::vector<Point2>& points, bool closed,
                     double width, DxfExtrusion upright, const DxfOpening& opening) {
    parts_->beginPolyline(layer, points.size(), closed);
    if (width > 0) parts_->out.dxfReal(43, width);
    if (upright.bottom != 0) parts_->out.dxfReal(38, upright.bottom);
    if (upright.height != 0) parts_->out.dxfReal(39, upright.height);
    for (const Point2 p : points) parts_->dxf.writeVertex(parts_->out, DL_VertexData(p.x, p.y));
    parts_->dxf.writePolylineEnd(parts_->out);
    if (opening.depth == 0 && opening.pane.empty()) return;
    parts_->out.dxfString(1001, kDxfApplication);
    for (const std::string& text : opening.pane) parts_->out.dxfString(1000, text);
    if (opening.depth != 0) parts_->out.dxfReal(1041, opening.depth);
}

void DxfWriter::curve(const std::string& layer, const Curve& curve) {
    parts_->beginPolyline(layer, curve.size(), true);
    for (const CurveEdge& edge : curve)
        parts_->dxf.writeVertex(parts_->out,
                                DL_VertexData(edge.from.x, edge.from.y, 0, bulgeOf(edge)));
    parts_->dxf.writePolylineEnd(parts_->out);
}

void DxfWriter::circle(const std::string& layer, Point2 center, double radius,
                       DxfExtrusion upright) {
    parts_->dxf.writeCircle(parts_->out, DL_CircleData(center.x, center.y, upright.bottom, radius),
                            on(layer));
    if (upright.height != 0) parts_->out.dxfReal(39, upright.height);
}

void DxfWriter::area(const std::string& layer, const Region& region) {
    const std::vector<Polygon> curves = curvesOf(region);
    const DL_HatchData hatch(static_cast<int>(curves.size()), true, 1, 0, "SOLID");
    parts_->dxf.writeHatch1(parts_->out, hatch, on(layer));
    for (const Polygon& curve : curves) {
        const DL_HatchLoopData loop(static_cast<int>(curve.size()));
        parts_->dxf.writeHatchLoop1(parts_->out, loop);
        forEachEdge(curve, [&](const Segment2& edge) {
            parts_->dxf.writeHatchEdge(parts_->out,
                                       DL_HatchEdgeData(edge.a.x, edge.a.y, edge.b.x, edge.b.y));
        });
        parts_->dxf.writeHatchLoop2(parts_->out, loop);
    }
    parts_->dxf.writeHatch2(parts_->out, hatch, on(layer));
}

void DxfWriter::text(const std::string& layer, Point2 place, const std::string& text,
                     double height) {
    std::string line = text;
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    parts_->dxf.writeText(parts_->out,
                          DL_TextData(place.x, place.y, 0, place.x, place.y, 0, height, 1, 0, 0, 0,
                                      line, "Standard", 0),
                          on(layer));
}

std::string DxfWriter::finish() {
    StringWriter& out = parts_->out;
    out.sectionEnd();
    parts_->dxf.writeObjects(out);
    parts_->dxf.writeObjectsEnd(out);
    out.dxfEOF();
    return out.take();
}

}  // namespace ispace::cad
