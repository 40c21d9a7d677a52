// SPDX-License-Identifier: GPL-3.0-or-later
// Writes pictures as SVG. Cairo's SVG writer does not support layers, ids and titles, which drawing
// programs require, and converts text to outlines. SVG 1.1 (W3C, 2011), layers as
// inkscape:groupmode; numbers have four decimals in millimetres, three in pixels, two in elements
// of pages.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "base/message.h"
#include "base/number.h"
#include "drawing/drawing.h"

namespace ispace {

namespace {

using Kind = DisplayList::Kind;

/// Creates unique XML names: letters, digits, `_ - .`.
class XmlIds {
  public:
    explicit XmlIds(std::string_view prefix) : prefix_(prefix) {}

    std::string take(std::string_view wanted) {
        std::string id = prefix_;
        for (const char c : wanted) {
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
            const bool later = (c >= '0' && c <= '9') || c == '-' || c == '.';
            if (later && id.empty()) id += '_';
            id += letter || later ? c : '_';
        }
        std::string free = id;
        for (std::size_t i = 2; !taken_.insert(free).second; ++i)
            free = id + '_' + std::to_string(i);
        return free;
    }

  private:
    std::string prefix_;  ///< of all names
    std::set<std::string> taken_;
};

class SvgWriter {
  public:
    /// \param prefix of ids, for an element of a page; nullopt: writes a document
    SvgWriter(const Picture& picture, std::optional<std::string_view> prefix)
        : picture_(picture),
          list_(picture.list()),
          is_document_(!prefix),
          // A precision of a ten-thousandth of a millimetre on paper, and of a thousandth of a
          // pixel, is enough.
          fineness_(picture.unit() == PageUnit::Millimetre ? 1e4
                    : prefix                               ? 1e2
                                                           : 1e3),
          ids_(prefix.value_or("")) {}

    std::string write() {
        begin();
        takeLayerIds();
        for (const DisplayList::Shape& shape : list_.shapes) add(shape);
        out_ += "</svg>\n";
        return std::move(out_);
    }

  private:
    void begin() {
        const std::string width = number(picture_.width()), height = number(picture_.height());
        const std::string unit = picture_.unit() == PageUnit::Millimetre ? "mm" : "px";
        if (is_document_) {
            out_.append(
                "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                "<svg xmlns=\"http://www.w3.org/2000/svg\""
                " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"");
            attribute("width", width + unit);
            attribute("height", height + unit);
        } else {
            out_ += "<svg role=\"img\"";
            attribute("aria-label", escapedXml(picture_.title()));
        }
        attribute("viewBox", "0 0 " + width + ' ' + height);
        out_ +=
            " font-family=\"DejaVu Sans, Verdana, sans-serif\" xml:space=\"preserve\""
            " fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\""
            " fill-rule=\"evenodd\">\n";
        if (is_document_ && !picture_.title().empty())
            out_.append("<title>").append(escapedXml(picture_.title())).append("</title>\n");
        if (!picture_.description().empty())
            out_.append("<desc>").append(escapedXml(picture_.description())).append("</desc>\n");
        out_ += "<rect";
        attribute("width", width);
        attribute("height", height);
        out_ += " fill=\"#ffffff\"/>\n";
    }

    /// Reserves the ids of all layers, so that elements before them do not take these ids.
    void takeLayerIds() {
        std::size_t index = 0;
        for (const DisplayList::Shape& shape : list_.shapes) {
            if (shape.kind != Kind::Layer && shape.kind != Kind::Group) continue;
            const std::string& name = list_.names[index++].title;
            if (shape.kind == Kind::Layer)
                layer_ids_.push_back(ids_.take("layer-" + name.substr(0, name.find(' '))));
        }
    }

    void add(const DisplayList::Shape& shape) {
        switch (shape.kind) {
            case Kind::Layer:
            case Kind::Group:
                beginGroup(shape);
                break;
            case Kind::End:
                out_ += "</g>\n";
                break;
            case Kind::Text:
                add(list_.texts[shape.first]);
                break;
            case Kind::Image:
                add(list_.images[shape.first]);
                break;
            case Kind::Area:
            case Kind::Lines:
            case Kind::Arc:
                addPath(shape);
        }
    }

    void beginGroup(const DisplayList::Shape& shape) {
        const DisplayList::Name& name = list_.names[names_++];
        const std::string clip = shape.first < shape.last ? addClip(shape) : "";
        out_ += "<g";
        if (shape.kind == Kind::Layer) {
            attribute("id", layer_ids_[layers_++]);
            if (is_document_) attribute("inkscape:groupmode", "layer");
            attribute(is_document_ ? "inkscape:label" : "data-layer", escapedXml(name.title));
        } else if (!name.id.empty()) {
            attribute("id", ids_.take(name.id));
        }
        if (!clip.empty()) attribute("clip-path", "url(#" + clip + ")");
        out_ += shape.kind == Kind::Layer ? ">\n" : ">";
        if (shape.kind == Kind::Group && !name.title.empty())
            out_.append("<title>").append(escapedXml(name.title)).append("</title>");
    }

    /// Writes equal clips once. \return its id
    std::string addClip(const DisplayList::Shape& shape) {
        std::string data = dataOf(shape);
        if (const auto known = clips_.find(data); known != clips_.end()) return known->second;
        std::string id = ids_.take("clip-" + std::to_string(clips_.size() + 1));
        out_ += "<clipPath";
        attribute("id", id);
        out_ += "><path clip-rule=\"evenodd\"";
        attribute("d", data);
        out_ += "/></clipPath>";
        clips_.emplace(std::move(data), id);
        return id;
    }

    [[nodiscard]] std::string dataOf(const DisplayList::Shape& shape) const {
        std::string data;
        if (shape.kind == Kind::Arc) {
            const DisplayList::Arc& arc = list_.arcs[shape.first];
            const auto at = [&](Angle turn) {
                const Vec2 way = arc.radius * unitVector(turn);
                return place({arc.center.x + way.x, arc.center.y - way.y});
            };
            data.append("M").append(place(arc.center)).append("L").append(at(arc.from));
            data.append("A").append(place({arc.radius, arc.radius})).append(" 0 ");
            data += arc.to - arc.from > Angle::degrees(180) ? '1' : '0';
            data.append(" 0 ").append(at(arc.to)) += 'Z';
            return data;
        }
        for (std::uint32_t i = shape.first; i < shape.last; ++i) {
            char command = 'M';
            for (const Point2 p : list_.curve(i)) {
                (data += command).append(place(p));
                command = 'L';
            }
            if (shape.kind != Kind::Lines) data += 'Z';
        }
        return data;
    }

    /// Writes a single element if it looks the same: a fill with an outline above it.
    void addPath(const DisplayList::Shape& shape) {
        const std::span<const Ink> inks = list_.inksOf(shape);
        for (std::size_t i = 0; i < inks.size(); ++i) {
            if (const auto* hatch = std::get_if<Hatch>(&inks[i])) {
                addHatch(shape, *hatch);
                continue;
            }
            beginPath(shape);
            if (const auto* fill = std::get_if<Color>(&inks[i])) {
                color("fill", *fill);
                if (i + 1 < inks.size() && std::holds_alternative<Stroke>(inks[i + 1])) ++i;
            }
            if (const auto* stroke = std::get_if<Stroke>(&inks[i])) add(*stroke);
            out_ += "/>";
        }
    }

    void beginPath(const DisplayList::Shape& shape) {
        if (shape.kind == Kind::Arc && list_.arcs[shape.first].isCircle()) {
            const DisplayList::Arc& arc = list_.arcs[shape.first];
            out_ += "<circle";
            attribute("cx", number(arc.center.x));
            attribute("cy", number(arc.center.y));
            attribute("r", number(arc.radius));
        } else {
            out_ += "<path";
            attribute("d", dataOf(shape));
        }
    }

    void addHatch(const DisplayList::Shape& shape, const Hatch& hatch) {
        const std::string clip = addClip(shape);
        out_ += "<g";
        attribute("clip-path", "url(#" + clip + ")");
        out_ += "><path d=\"";
        for (const Segment2& line : hatchLines(hatch, visibleBox(picture_, shape)))
            out_.append("M").append(place(line.a)).append("L").append(place(line.b));
        out_ += '"';
        add(Stroke{hatch.color, hatch.width});
        out_ += "/></g>";
    }

    void add(const Stroke& stroke) {
        color("stroke", stroke.color);
        attribute("stroke-width", number(stroke.width));
        if (stroke.dashes.empty()) return;
        std::string dashes;
        for (const double dash : stroke.dashes)
            dashes.append(dashes.empty() ? "" : " ").append(number(dash));
        attribute("stroke-linecap", "butt");
        attribute("stroke-dasharray", dashes);
    }

    void add(const DisplayList::Text& text) {
        constexpr std::array<std::string_view, 3> kAnchors{"start", "middle", "end"};
        const TextStyle& style = text.style;
        out_ += "<text";
        attribute("x", number(text.anchor.x));
        attribute("y", number(text.anchor.y));
        attribute("font-size", number(style.size));
        if (style.align != Align::Left)
            attribute("text-anchor", kAnchors[static_cast<std::size_t>(style.align)]);
        if (style.bold) attribute("font-weight", "bold");
        // Viewers that lack the font stretch theirs.
        attribute("textLength", number(textWidth(text.text, style)));
        attribute("lengthAdjust", "spacingAndGlyphs");
        if (style.halo) {
            add(Stroke{*style.halo, style.size / 4});
            attribute("paint-order", "stroke");
        }
        color("fill", style.color);
        out_.append(">").append(escapedXml(text.text)).append("</text>");
    }

    void add(const DisplayList::Raster& raster) {
        out_ += "<image preserveAspectRatio=\"none\" image-rendering=\"pixelated\"";
        attribute("x", number(raster.corner.x));
        attribute("y", number(raster.corner.y));
        attribute("width", number(raster.pixel_width * raster.image.width));
        attribute("height", number(raster.pixel_height * raster.image.height));
        attribute("href", "data:image/png;base64," + base64(encodePng(raster.image)));
        out_ += "/>";
    }

    void attribute(std::string_view name, std::string_view value) {
        out_.append(" ").append(name).append("=\"").append(value) += '"';
    }
    void color(std::string_view what, Color color) {
        attribute(what, cssColor(Color{color.red, color.green, color.blue}));
        if (color.alpha < 1) attribute(std::string(what) + "-opacity", number(color.alpha));
    }
    [[nodiscard]] std::string number(double value) const {
        return formatDouble(std::round(value * fineness_) / fineness_);
    }
    [[nodiscard]] std::string place(Point2 page) const {
        return number(page.x) + ',' + number(page.y);
    }

    const Picture& picture_;
    const DisplayList& list_;
    bool is_document_;
    double fineness_;
    XmlIds ids_;
    std::vector<std::string> layer_ids_;
    std::size_t names_ = 0, layers_ = 0;
    std::map<std::string, std::string> clips_;  // ids by data
    std::string out_;
};

}  // namespace

std::string escapedXml(std::string_view text) {
    std::string out;
    for (const char c : printable(text)) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string writeSvg(const Picture& picture) { return SvgWriter(picture, {}).write(); }

std::string svgElement(const Picture& picture, std::string_view prefix) {
    return SvgWriter(picture, prefix).write();
}

}  // namespace ispace
