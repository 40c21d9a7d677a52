// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/dxf_drawing.h"

#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>

#include <sstream>
#include <utility>

#include "base/message.h"

namespace ispace {

namespace {

constexpr int kFrozen = 1, kClosed = 1;

/// Keeps what dxflib reads.
class Collector : public DL_CreationAdapter {
  public:
    explicit Collector(DxfDrawing& drawing) : drawing_(drawing), target_(&drawing.entities) {}

    void setVariableInt(const std::string& key, int value, int /*code*/) override {
        if (key == "$INSUNITS") drawing_.units = value;
    }
    void addLayer(const DL_LayerData& layer) override {
        drawing_.layers.insert(printable(layer.name));
        if (attributes.getColor() < 0 || (layer.flags & kFrozen) != 0)
            drawing_.hidden_layers.insert(printable(layer.name));
    }
    void addBlock(const DL_BlockData& block) override {
        const auto [it, is_new] = drawing_.blocks.try_emplace(printable(block.name));
        if (!is_new) it->second = {};
        it->second.base = {block.bpx, block.bpy};
        target_ = &it->second.entities;
    }
    void endBlock() override { target_ = &drawing_.entities; }

    void addLine(const DL_LineData& line) override {
        add(DxfPolyline{{{{line.x1, line.y1}, 0}, {{line.x2, line.y2}, 0}}, false});
    }
    void addArc(const DL_ArcData& arc) override {
        add(DxfArc{
            {arc.cx, arc.cy}, arc.radius, Angle::degrees(arc.angle1), Angle::degrees(arc.angle2)});
    }
    void addCircle(const DL_CircleData& circle) override {
        add(DxfArc{{circle.cx, circle.cy}, circle.radius, Angle(), Angle::degrees(360)});
    }
    void addEllipse(const DL_EllipseData& ellipse) override {
        const Vec2 major{ellipse.mx, ellipse.my};
        // World coordinates: seen from below only the sense of its parameter changes.
        const double ratio = isMirrored() ? -ellipse.ratio : ellipse.ratio;
        add(DxfEllipse{{ellipse.cx, ellipse.cy},
                       major,
                       ratio * perpendicular(major),
                       ellipse.angle1,
                       ellipse.angle2});
        target_->back().mirrored = false;
    }
    void addPolyline(const DL_PolylineData& polyline) override {
        add(DxfPolyline{{}, (polyline.flags & kClosed) != 0});
    }
    void addVertex(const DL_VertexData& vertex) override {
        auto* polyline =
            target_->empty() ? nullptr : std::get_if<DxfPolyline>(&target_->back().shape);
        if (polyline != nullptr) polyline->vertices.push_back({{vertex.x, vertex.y}, vertex.bulge});
    }
    void addSpline(const DL_SplineData& spline) override {
        add(DxfSpline{static_cast<int>(spline.degree), {}, {}, {}});
    }
    void addKnot(const DL_KnotData& knot) override {
        if (DxfSpline* spline = lastSpline()) spline->knots.push_back(knot.k);
    }
    void addControlPoint(const DL_ControlPointData& point) override {
        DxfSpline* spline = lastSpline();
        if (spline == nullptr) return;
        spline->controls.push_back({point.x, point.y});
        spline->weights.push_back(point.w);
    }
    void addInsert(const DL_InsertData& insert) override {
        add(DxfInsert{printable(insert.name),
                      {insert.ipx, insert.ipy},
                      insert.sx,
                      insert.sy,
                      Angle::degrees(insert.angle),
                      insert.cols,
                      insert.rows,
                      insert.colSp,
                      insert.rowSp});
    }

  private:
    [[nodiscard]] DxfSpline* lastSpline() const {
        return target_->empty() ? nullptr : std::get_if<DxfSpline>(&target_->back().shape);
    }
    [[nodiscard]] bool isMirrored() { return getExtrusion()->getDirection()[2] < 0; }
    template <typename Shape>
    void add(Shape shape) {
        target_->push_back({std::move(shape), printable(attributes.getLayer()), isMirrored(),
                            attributes.getHandle()});
    }

    DxfDrawing& drawing_;
    std::vector<DxfEntity>* target_;
};

}  // namespace

DxfDrawing readDrawing(std::string_view bytes, const std::string& name) {
    DxfText checked = checkedDxf(bytes, name);
    DxfDrawing drawing;
    drawing.left_out = std::move(checked.left_out);
    drawing.sizes = std::move(checked.sizes);
    std::istringstream stream(std::move(checked.text));
    Collector collector(drawing);
    DL_Dxf().in(stream, &collector);
    return drawing;
}

}  // namespace ispace
