// SPDX-License-Identifier: GPL-3.0-or-later
// A writer of its own: Cairo's SVG knows neither layers nor ids nor titles, which are what one
// takes a plan into a drawing program for.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "base/number.h"
#include "base/utf8.h"
#include "io/plan_drawing.h"

namespace ispace {

namespace {

std::string escaped(std::string_view text) {
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

/// Names that XML takes: letters, digits, `_ - .`, none twice.
class XmlIds {
  public:
    std::string take(std::string_view wanted) {
        std::string id;
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
    std::set<std::string> taken_;
};

class SvgWriter {
  public:
    explicit SvgWriter(const PlanDrawing& plan) : plan_(plan) {
        ids_.take("clip-indoor");
        for (const std::string_view layer : kPlanLayers) layer_ids_.push_back(layerId(layer));
    }

    std::string write(const std::string& title) {
        begin(title);
        auto item = plan_.items.begin();
        for (std::size_t layer = 0; layer < kPlanLayers.size(); ++layer) {
            const auto is_here = [&] {
                return item != plan_.items.end() && static_cast<std::size_t>(item->layer) == layer;
            };
            if (!is_here()) continue;
            out_.append("<g id=\"").append(layer_ids_[layer]);
            out_.append("\" inkscape:groupmode=\"layer\" inkscape:label=\"");
            out_.append(escaped(kPlanLayers[layer])) += '"';
            if (layer == static_cast<std::size_t>(PlanLayer::Views))
                out_ += " clip-path=\"url(#clip-indoor)\"";
            out_ += ">\n";
            for (; is_here(); ++item) add(*item);
            out_ += "</g>\n";
        }
        out_ += "</svg>\n";
        return std::move(out_);
    }

  private:
    std::string layerId(std::string_view layer) {
        return ids_.take("layer-" + std::string(layer.substr(0, layer.find(' '))));
    }

    void begin(const std::string& title) {
        const std::string width = number(plan_.width), height = number(plan_.height);
        out_.append(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\""
            " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"");
        out_.append(" width=\"").append(width).append("mm\" height=\"").append(height);
        out_.append("mm\" viewBox=\"0 0 ").append(width).append(" ").append(height);
        out_.append(
            "\" font-family=\"DejaVu Sans, sans-serif\" fill=\"none\""
            " stroke-linecap=\"round\" stroke-linejoin=\"round\" fill-rule=\"evenodd\">\n");
        out_.append("<title>").append(escaped(title.empty() ? "plan" : title));
        out_.append("</title>\n<desc>Millimetres on paper, 1:")
            .append(formatDouble(std::round(1e6 / plan_.view.scale) / 1e3));
        out_.append(". The plan's origin lies at ").append(place(plan_.view * Point2()));
        out_.append(", y up.</desc>\n<rect width=\"").append(width).append("\" height=\"");
        out_.append(height).append("\" fill=\"#ffffff\"/>\n");
        if (std::any_of(plan_.items.begin(), plan_.items.end(),
                        [](const DrawnItem& item) { return item.layer == PlanLayer::Views; }))
            addIndoorClip();
    }

    void addIndoorClip() {
        out_ += "<clipPath id=\"clip-indoor\"><path clip-rule=\"evenodd\" d=\"";
        for (const Polygon& curve : curvesOf(plan_.indoor)) addCurve(curve, true);
        out_ += "\"/></clipPath>\n";
    }

    void addCurve(const std::vector<Point2>& curve, bool closed) {
        char command = 'M';
        for (const Point2 p : curve) {
            (out_ += command).append(place(plan_.view * p));
            command = 'L';
        }
        if (closed) out_ += 'Z';
    }

    void add(const DrawnItem& item) {
        out_ += "<g";
        if (!item.id.empty()) out_.append(" id=\"").append(ids_.take(item.id)) += '"';
        out_ += '>';
        if (!item.title.empty())
            out_.append("<title>").append(escaped(item.title)).append("</title>");
        for (const DrawnPath& path : item.paths) add(path);
        for (const DrawnText& text : item.texts) add(text);
        out_ += "</g>\n";
    }

    void add(const DrawnPath& path) {
        out_ += "<path d=\"";
        for (const std::vector<Point2>& curve : path.curves) addCurve(curve, path.closed);
        out_ += '"';
        if (path.fill) addColor("fill", *path.fill);
        if (path.line) {
            addColor("stroke", path.line->color);
            out_.append(" stroke-width=\"").append(number(path.line->width * plan_.em)) += '"';
            if (!path.line->dashes.empty()) addDashes(path.line->dashes);
        }
        out_ += "/>";
    }

    void addDashes(const std::vector<double>& dashes) {
        out_ += " stroke-linecap=\"butt\" stroke-dasharray=\"";
        const char* gap = "";
        for (const double dash : dashes) {
            out_.append(gap).append(number(dash * plan_.em));
            gap = " ";
        }
        out_ += '"';
    }

    void add(const DrawnText& text) {
        constexpr std::array<std::string_view, 3> kAnchors{"start", "middle", "end"};
        const Point2 page = plan_.view * text.anchor;
        out_.append("<text x=\"").append(number(page.x)).append("\" y=\"").append(number(page.y));
        out_.append("\" font-size=\"").append(number(text.size * plan_.em));
        out_.append("\" text-anchor=\"").append(kAnchors[static_cast<std::size_t>(text.align)]);
        out_ += '"';
        if (text.bold) out_ += " font-weight=\"bold\"";
        if (text.halo) {
            addColor("stroke", plan_colors::kPaper.faded(0.85));
            out_.append(" stroke-width=\"").append(number(text.size * plan_.em / 4));
            out_ += "\" paint-order=\"stroke\"";
        }
        addColor("fill", text.color);
        out_.append(">").append(escaped(text.text)).append("</text>");
    }

    void addColor(std::string_view what, Color color) {
        constexpr std::string_view kDigits = "0123456789abcdef";
        out_.append(" ").append(what).append("=\"#");
        for (const double part : {color.red, color.green, color.blue}) {
            const auto value = static_cast<std::size_t>(std::lround(part * 255));
            out_ += kDigits[value / 16];
            out_ += kDigits[value % 16];
        }
        out_ += '"';
        if (color.alpha < 1)
            out_.append(" ").append(what).append("-opacity=\"").append(number(color.alpha)) += '"';
    }

    /// A ten-thousandth of a millimetre of paper is enough.
    static std::string number(double value) { return formatDouble(std::round(value * 1e4) / 1e4); }
    static std::string place(Point2 page) { return number(page.x) + ',' + number(page.y); }

    const PlanDrawing& plan_;
    XmlIds ids_;
    std::vector<std::string> layer_ids_;
    std::string out_;
};

}  // namespace

std::string planSvg(const PlanDrawing& plan, const std::string& title) {
    return SvgWriter(plan).write(title);
}

}  // namespace ispace
