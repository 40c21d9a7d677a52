// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/projection/projection_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/color.h"
#include "report/coverage_report.h"

namespace ispace::projection {

namespace {

std::string sizeText(double width, double height) {
    return formatFixed(width, 2) + " x " + formatFixed(height, 2);
}

std::string placeText(Point3 place) {
    return formatFixed(place.x, 2) + ',' + formatFixed(place.y, 2) + ',' + formatFixed(place.z, 2);
}

std::string headText(const ProjectorCoverage& projector) {
    std::string text = "projector " + printable(projector.id) + ": ";
    if (!projector.model.empty()) text += projector.model + ", ";
    text += std::to_string(projector.figures.columns) + " x " +
            std::to_string(projector.figures.rows) + " pixels, " +
            formatDouble(projector.figures.lumens) + " lm, " +
            (projector.figures.turns() ? "turns" : "stays");
    return text + ", carries pictures on " + formatFixed(projector.carries, 2) + " m2\n";
}

TextRow rowOf(const SurfaceProjection& one, const ProjectionSurface& surface) {
    TextRow row = {printable(surface.name),
                   formatFixed(surface.area(), 2),
                   formatFixed(one.carries, 2),
                   formatFixed(one.shadowed, 2),
                   formatFixed(one.shadowed_by_movers, 2),
                   formatFixed(one.best, 0)};
    if (!one.rectangle) {
        row.insert(row.end(), 8, "-");
        return row;
    }
    const PictureRectangle& best = *one.rectangle;
    const std::array<std::string, 8> cells = {
        sizeText(best.width, best.height),    placeText(best.middle),
        formatFixed(best.least, 0),           formatFixed(best.ratio(), 2),
        formatFixed(best.slant.degrees(), 1), formatFixed(best.pan.degrees(), 1),
        formatFixed(best.tilt.degrees(), 1),  formatFixed(best.lux, 0)};
    row.insert(row.end(), cells.begin(), cells.end());
    return row;
}

void addRectangle(JsonWriter& json, const PictureRectangle& best) {
    json.beginObject().key("middle").beginArray().value(best.middle.x).value(best.middle.y);
    json.value(best.middle.z).endArray();
    json.key("left").value(best.left).key("bottom").value(best.bottom);
    json.key("width").value(best.width).key("height").value(best.height);
    json.key("pan").value(best.pan.degrees()).key("tilt").value(best.tilt.degrees());
    json.key("density").value(best.least).key("max_density").value(best.most);
    json.key("ratio").value(best.ratio()).key("slant").value(best.slant.degrees());
    json.key("illuminance").value(best.lux).endObject();
}

void addProjector(JsonWriter& json, const ProjectorCoverage& projector,
                  const ProjectionReport& projection) {
    json.beginObject().key("id").value(projector.id).key("model");
    if (projector.model.empty())
        json.null();
    else
        json.value(projector.model);
    json.key("pixels").beginArray().value(projector.figures.columns);
    json.value(projector.figures.rows).endArray();
    json.key("light").value(projector.figures.lumens);
    json.key("turns").value(projector.figures.turns()).key("carries").value(projector.carries);
    json.key("surfaces").beginArray();
    for (const SurfaceProjection& one : projector.surfaces) {
        json.beginObject().key("surface").value(projection.surfaces[one.surface].name);
        json.key("carries").value(one.carries).key("shadowed").value(one.shadowed);
        json.key("shadowed_by_movers").value(one.shadowed_by_movers);
        json.key("max_density").value(one.best).key("rectangle");
        if (one.rectangle)
            addRectangle(json, *one.rectangle);
        else
            json.null();
        json.endObject();
    }
    json.endArray().endObject();
}

/// A surface in the picture: what any projector does with its cells.
struct Panel {
    std::size_t surface = 0;
    std::vector<CellState> cells;
    std::vector<std::pair<std::string, PictureRectangle>> rectangles;
    Point2 corner;  // lower left, on the page
};

int rankOf(CellState state) {
    switch (state) {
        case CellState::Carries:
            return 4;
        case CellState::Coarse:
            return 3;
        case CellState::ShadowedByMovers:
            return 2;
        case CellState::Shadowed:
            return 1;
        case CellState::Dark:
            break;
    }
    return 0;
}

constexpr std::uint32_t kDark = 0xE4E6E8, kShadow = 0x8C959F, kMoverShadow = 0xB08068,
                        kCoarse = 0xF6E3A1, kCarries = 0x7FB8E8;
constexpr std::array<std::pair<std::uint32_t, const char*>, 5> kLegend = {
    {{kCarries, "carries pictures"},
     {kCoarse, "too coarse"},
     {kMoverShadow, "shadow of robots and people"},
     {kShadow, "shadow of elements"},
     {kDark, "out of reach"}}};

std::uint32_t colorOf(CellState state) {
    switch (state) {
        case CellState::Carries:
            return kCarries;
        case CellState::Coarse:
            return kCoarse;
        case CellState::ShadowedByMovers:
            return kMoverShadow;
        case CellState::Shadowed:
            return kShadow;
        case CellState::Dark:
            break;
    }
    return kDark;
}

std::vector<Panel> panelsOf(const ProjectionReport& projection) {
    std::vector<Panel> panels;
    for (std::size_t s = 0; s < projection.surfaces.size(); ++s) {
        if (!projection.surfaces[s].isFlat()) continue;
        Panel panel{s, {}, {}, {}};
        for (const ProjectorCoverage& projector : projection.projectors)
            for (const SurfaceProjection& one : projector.surfaces) {
                if (one.surface != s) continue;
                const std::vector<CellState>& cells = one.cells.front();
                if (panel.cells.empty()) panel.cells.assign(cells.size(), CellState::Dark);
                for (std::size_t i = 0; i < cells.size(); ++i)
                    if (rankOf(cells[i]) > rankOf(panel.cells[i])) panel.cells[i] = cells[i];
                if (one.rectangle) panel.rectangles.emplace_back(projector.id, *one.rectangle);
            }
        if (!panel.cells.empty()) panels.push_back(std::move(panel));
    }
    return panels;
}

void drawPanel(Picture& picture, const Panel& panel, const FlatFace& facet, const std::string& name,
               double scale, double em) {
    Image image{static_cast<int>(facet.columns), static_cast<int>(facet.rows), {}};
    image.pixels.assign(facet.columns * facet.rows, 0xFFFFFF);
    for (std::size_t i = 0; i < facet.cells.size(); ++i) {
        const std::size_t column = facet.cells[i] % facet.columns;
        const std::size_t row = facet.rows - 1 - facet.cells[i] / facet.columns;
        image.pixels[row * facet.columns + column] = colorOf(panel.cells[i]);
    }
    const double wide = scale * facet.width, high = scale * facet.height;
    const TextStyle plain{em, false, Align::Left, palette::kInk, {}};
    picture.pushGroup(name, name);
    picture.image({panel.corner.x, panel.corner.y - high}, std::move(image),
                  wide / static_cast<double>(facet.columns),
                  high / static_cast<double>(facet.rows));
    const auto box = [&](double left, double bottom, double width, double height) {
        const double x = panel.corner.x + scale * left, y = panel.corner.y - scale * bottom;
        return Polygon{{x, y},
                       {x + scale * width, y},
                       {x + scale * width, y - scale * height},
                       {x, y - scale * height}};
    };
    picture.area(box(0, 0, facet.width, facet.height), {Stroke{palette::kInk, 1}});
    for (const auto& [id, best] : panel.rectangles) {
        picture.area(box(best.left, best.bottom, best.width, best.height),
                     {Stroke{palette::kInk, 2}});
        picture.text({panel.corner.x + scale * (best.left + best.width / 2),
                      panel.corner.y - scale * (best.bottom + best.height / 2)},
                     fitText(id, scale * best.width, plain),
                     {em, false, Align::Center, palette::kInk, Color::rgb(0xFFFFFF)});
    }
    picture.text({panel.corner.x, panel.corner.y + 1.2 * em},
                 fitText(name, std::max(wide, 6 * em), plain),
                 {em, false, Align::Left, palette::kInk, {}});
    picture.pop();
}

}  // namespace

std::string projectionText(const ProjectionReport& projection) {
    std::string text = "pictures of at least " + formatDouble(projection.density) +
                       " pixels a metre, on cells of " + formatDouble(projection.cell) + " m\n";
    for (const ProjectorCoverage& projector : projection.projectors) {
        text += headText(projector);
        if (projector.surfaces.empty()) continue;
        std::vector<TextRow> rows = {{"surface", "m2", "carries", "shadow", "by movers",
                                      "most px/m", "rectangle m", "middle", "px/m", "ratio",
                                      "slant", "pan", "tilt", "lux"}};
        rows.reserve(projector.surfaces.size() + 1);
        for (const SurfaceProjection& one : projector.surfaces)
            rows.push_back(rowOf(one, projection.surfaces[one.surface]));
        text += aligned(rows, "lr");
    }
    if (projection.projectors.size() < 2) return text;
    text += "all projectors\n";
    std::vector<TextRow> rows = {{"surface", "m2", "carries"}};
    for (std::size_t s = 0; s < projection.surfaces.size(); ++s)
        if (projection.carried[s] > 0)
            rows.push_back({printable(projection.surfaces[s].name),
                            formatFixed(projection.surfaces[s].area(), 2),
                            formatFixed(projection.carried[s], 2)});
    return text + aligned(rows, "lr");
}

std::string projectionJson(const ProjectionReport& projection) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-projection/1");
    json.key("tool").value("coverage").key("version").value(version());
    json.key("density").value(projection.density).key("cell").value(projection.cell);
    json.key("projectors").beginArray();
    for (const ProjectorCoverage& projector : projection.projectors)
        addProjector(json, projector, projection);
    json.endArray().key("surfaces").beginArray();
    for (std::size_t s = 0; s < projection.surfaces.size(); ++s) {
        const ProjectionSurface& surface = projection.surfaces[s];
        json.beginObject().key("name").value(surface.name).key("element").value(surface.element);
        json.key("area").value(surface.area()).key("flat").value(surface.isFlat());
        json.key("carries").value(projection.carried[s]).endObject();
    }
    return json.endArray().endObject().take() + '\n';
}

Picture projectionPicture(const ProjectionReport& projection, const std::string& title, int width) {
    constexpr int kLeastWidth = 200, kMostWidth = 12000;
    if (width < kLeastWidth || width > kMostWidth)
        throw UsageError("a picture " + std::to_string(width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kLeastWidth) +
                         " to " + std::to_string(kMostWidth));
    std::vector<Panel> panels = panelsOf(projection);
    const double em = std::max(9.0, width / 1200.0 * 14), margin = 1.4 * em, gap = 1.5 * em;
    const auto facet_of = [&projection](const Panel& panel) -> const FlatFace& {
        return projection.surfaces[panel.surface].facets.front();
    };
    // Two of the widest surfaces fill the width.
    double widest = 1;
    for (const Panel& panel : panels) widest = std::max(widest, facet_of(panel).width);
    const double scale = (width - 2 * margin - gap) / (2 * widest);
    double x = margin, top = margin + (title.empty() ? 0 : 2.2 * em), row_height = 0;
    std::size_t first = 0;
    const auto end_row = [&](std::size_t end) {
        for (std::size_t i = first; i < end; ++i) panels[i].corner.y = top + row_height;
        top += row_height + 2.4 * em;
        first = end;
        row_height = 0;
        x = margin;
    };
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const double wide = std::max(scale * facet_of(panels[i]).width, 6 * em);
        if (i > first && x + wide > width - margin) end_row(i);
        panels[i].corner.x = x;
        row_height = std::max(row_height, scale * facet_of(panels[i]).height);
        x += wide + gap;
    }
    end_row(panels.size());
    const double height = std::min(Picture::kMaxSide, std::ceil(top + 3.4 * em));
    Picture picture(width, height);
    picture.describe(title.empty() ? "projection" : title, "");
    if (!title.empty())
        picture.text({margin, 2.2 * em}, title, {1.35 * em, true, Align::Left, palette::kInk, {}});
    for (const Panel& panel : panels)
        drawPanel(picture, panel, facet_of(panel), projection.surfaces[panel.surface].name, scale,
                  em);
    double left = margin;
    for (const auto& [color, words] : kLegend) {
        const double y = top + em;
        picture.area({{left, y}, {left + em, y}, {left + em, y - em}, {left, y - em}},
                     {Color::rgb(color), Stroke{palette::kInk, 0.5}});
        const TextStyle style{em, false, Align::Left, palette::kInk, {}};
        picture.text({left + 1.4 * em, y}, words, style);
        left += 2.8 * em + textWidth(words, style);
    }
    drawScaleBar(picture, {margin, top + 3 * em}, 15 * em, scale, em);
    return picture;
}

}  // namespace ispace::projection
