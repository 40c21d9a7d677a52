// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "io/import_records.h"
#include "io/plan/drawing_unit.h"
#include "io/plan/line_plan.h"
#include "io/plan/svg.h"
#include "io/plan/unread.h"
#include "io/sdf/sdf_files.h"

namespace ispace {

namespace {

/// The contents of an SVG file that an import uses.
struct SvgDrawing {
    std::vector<PlanShape> shapes;
    std::string scale;  ///< length of a unit and its source, for a note
    double metres_per_unit = 0;
    std::map<std::string, std::size_t> left_out;  ///< elements, by type or reason
    std::vector<UnreadThing> unread;              ///< rules that may hide lines
};

constexpr int kMaxElementDepth = 200;  // elements in elements, by `use` or not

/// Radii that differ by less, as shares, are those of a circle.
constexpr double kRound = 0.01;

constexpr std::array<std::string_view, 4> kGroups{"g", "a", "switch", "svg"};
constexpr std::array<std::string_view, 7> kShapes{"path", "line",   "polyline", "polygon",
                                                  "rect", "circle", "ellipse"};
constexpr std::array<std::string_view, 3> kOthers{"text", "image", "foreignObject"};

/// Share of the page; a larger rectangle is a drawing with a wrong page.
constexpr double kMaxBackground = 1.1;

double metresOf(const std::string& unit) {
    for (const LengthUnit& known : kLengthUnits)
        if (unit == known.name) return known.metres;
    throw SvgError("unknown unit " + unit);
}

/// The context of an element.
struct Around {
    Affine frame;
    SvgStyle style;
    SvgNames names;
    int depth = 0;
    bool is_used = false;  ///< by `use`
};

/// Makes names printable. Neighbours share theirs, which may be long.
class PrintableNames {
  public:
    const std::string& of(std::string_view name) {
        if (name != last_) {
            last_ = name;
            text_ = printable(last_);
        }
        return text_;
    }

  private:
    std::string last_, text_;
};

class SvgReader {
  public:
    /// \param metres_per_unit if empty, from the options or the drawing's size
    SvgReader(std::string_view bytes, const std::string& name, const ImportOptions& options,
              std::optional<double> metres_per_unit = {})
        : file_(bytes, name),
          options_(options),
          asked_scale_(metres_per_unit),
          budget_(bytes.size(), options.max_work) {}

    SvgDrawing read() {
        const pugi::xml_node root = file_.root();
        if (svgName(root) != "svg") file_.fail(root, "no `svg` at the root");
        listElements(root);
        at(root, [&] {
            page_frame_ = pageOf(root);
            addChildren(root, {page_frame_, svgStyle({}, svgProperties(root, sheet_)), {}});
        });
        for (const auto& [selector, count] : sheet_.unread())
            for (std::size_t i = 0; i < count; ++i)
                drawing_.unread.push_back({"the CSS rule `" + printable(selector) + '`'});
        return std::move(drawing_);
    }

    /// Returns metres a unit by the size on paper, if the drawing has one.
    std::optional<double> paperScale() {
        const pugi::xml_node root = file_.root();
        if (svgName(root) != "svg") file_.fail(root, "no `svg` at the root");
        std::optional<double> scale;
        at(root, [&] {
            if (isSvgPhysical(root.attribute("width").value()) ||
                isSvgPhysical(root.attribute("height").value())) {
                pageOf(root);
                scale = drawing_.metres_per_unit;
            }
        });
        return scale;
    }

  private:
    /// Adds the line of the element to errors in attributes.
    template <typename Read>
    void at(pugi::xml_node node, Read read) {
        try {
            read();
        } catch (const SvgError& error) {
            file_.fail(node, '`' + std::string(svgName(node)) + "`: " + error.what());
        }
    }

    /// Collects ids and rules of style.
    void listElements(pugi::xml_node root) {
        std::vector<pugi::xml_node> styles;
        forEachElement(root, [&](pugi::xml_node node) {
            if (const pugi::xml_attribute id = node.attribute("id")) ids_.emplace(id.value(), node);
            if (svgName(node) == "style") styles.push_back(node);
        });
        if (styles.empty()) return;
        for (const pugi::xml_node style : styles)
            for (const pugi::xml_node text : style.children()) sheet_.add(text.value());
    }

    /// Calls visit(node) for all elements, without recursion for deep nesting.
    template <typename Visit>
    static void forEachElement(pugi::xml_node root, Visit visit) {
        for (pugi::xml_node node = root; node;) {
            if (node.type() == pugi::node_element) visit(node);
            if (node.first_child()) {
                node = node.first_child();
                continue;
            }
            while (node && node != root && !node.next_sibling()) node = node.parent();
            node = node == root ? pugi::xml_node() : node.next_sibling();
        }
    }

    /// True if the content fills its viewport in both directions.
    static bool isStretched(pugi::xml_node node) {
        return trimmed(node.attribute("preserveAspectRatio").value()).starts_with("none");
    }

    /// From the drawing's coordinates to metres, y up, the page's lower left corner in the origin.
    Affine pageOf(pugi::xml_node root) {
        const auto metres_of = [root](const char* key) {
            const std::string_view text = trimmed(root.attribute(key).value());
            const auto metres = text.empty() ? std::nullopt : parseSvgMetres(text);
            return metres && *metres > 0 ? metres : std::nullopt;
        };
        const auto width = metres_of("width"), height = metres_of("height");
        const auto box = svgViewBox(root);
        const double pixel = *parseSvgMetres("1");
        page_ = box.value_or(SvgBox{0, 0, width.value_or(0) / pixel, height.value_or(0) / pixel});
        const bool has_width = width && isSvgPhysical(root.attribute("width").value());
        const bool has_height = height && isSvgPhysical(root.attribute("height").value());
        double scale = 0, stretch = 1;  // of y
        if (asked_scale_) {
            scale = *asked_scale_;
        } else if (!options_.units.empty()) {
            scale = metresOf(options_.units);
            drawing_.scale = "a unit of the drawing is 1 " + options_.units + ", as asked for";
        } else if (!has_width && !has_height) {
            throw SvgError("the drawing has no scale, as its size is " +
                           std::string(width || height ? "in pixels" : "not said") + ": " +
                           kScaleHint);
        } else {
            const double x = has_width ? *width / page_.width : HUGE_VAL;
            const double y = has_height ? *height / page_.height : HUGE_VAL;
            // As large as fits, where both do not agree.
            scale = std::min(x, y);
            if (has_width && has_height && isStretched(root)) {
                scale = x;
                stretch = y / x;
            }
            drawing_.scale = unitText(scale) + ", as its size says";
        }
        drawing_.metres_per_unit = scale;
        const double up = stretch * scale;
        return {{scale, 0}, {0, -up}, {-page_.x * scale, (page_.y + page_.height) * up}};
    }

    void addChildren(pugi::xml_node node, const Around& around) {
        for (const pugi::xml_node child : node.children())
            if (child.type() == pugi::node_element) at(child, [&] { addElement(child, around); });
    }

    void addElement(pugi::xml_node node, Around around) {
        spend(1);
        const std::string_view kind = svgName(node);
        const bool is_group = isOneOf(kGroups, kind), is_shape = isOneOf(kShapes, kind);
        if (isOneOf(kOthers, kind)) ++drawing_.left_out[std::string(kind)];
        if (!is_group && !is_shape && kind != "use") return;
        const SvgElement& element = elementOf(node, around.is_used);
        spend(element.units);
        if (element.properties[SvgProperty::Display] == "none" ||
            isSvgClear(element.properties[SvgProperty::Opacity])) {
            ++drawing_.left_out["elements that are not displayed"];
            return;
        }
        if (++around.depth > kMaxElementDepth)
            throw SvgError("elements nested more than " + std::to_string(kMaxElementDepth) +
                           " deep: does one use itself?");
        around.frame = around.frame * element.transform;
        around.style = svgStyle(around.style, element.properties);
        around.names = around.names.with(element.names);
        if (is_shape) return addShape(node, kind, around);
        if (kind == "use") return addUse(node, around);
        if (kind == "svg") around.frame = around.frame * viewportOf(node, node);
        addChildren(node, around);
    }

    /// Returns the element itself; caches it if it may be used again.
    const SvgElement& elementOf(pugi::xml_node node, bool is_used) {
        if (!is_used) return element_ = readSvgElement(node, sheet_, options_);
        const auto [known, is_new] = elements_.try_emplace(node.hash_value());
        if (is_new) known->second = readSvgElement(node, sheet_, options_);
        return known->second;
    }

    /// The frame of the view box of an inner `svg` or a `symbol` at `placed`.
    [[nodiscard]] Affine viewportOf(pugi::xml_node node, pugi::xml_node placed) const {
        const bool is_use = node != placed;
        const Affine corner{
            {1, 0}, {0, 1}, is_use ? Vec2{} : Vec2{svgNumber(placed, "x"), svgNumber(placed, "y")}};
        const auto box = svgViewBox(node);
        if (!box) return corner;
        const auto size = [&](const char* key, double own, double around) {
            for (const pugi::xml_node element : {placed, node}) {
                std::string_view text = trimmed(element.attribute(key).value());
                if (text.empty()) continue;
                if (!text.ends_with('%')) return svgNumber(element, key);
                text.remove_suffix(1);
                const auto share = parseDouble(text);
                if (share && *share > 0) return around * *share / 100;
            }
            return is_use ? own : around;
        };
        const double width = size("width", box->width, page_.width);
        const double height = size("height", box->height, page_.height);
        Vec2 scale{width / box->width, height / box->height};
        if (!isStretched(node)) scale.x = scale.y = std::min(scale.x, scale.y);
        const Vec2 rest{(width - scale.x * box->width) / 2, (height - scale.y * box->height) / 2};
        const Vec2 origin{scale.x * box->x, scale.y * box->y};
        return corner * Affine{{scale.x, 0}, {0, scale.y}, rest - origin};
    }

    void addUse(pugi::xml_node node, Around around) {
        std::string_view href = node.attribute("href").value();
        if (href.empty()) href = node.attribute("xlink:href").value();
        const auto target =
            href.starts_with('#') ? ids_.find(std::string(href.substr(1))) : ids_.end();
        if (target == ids_.end()) {
            ++drawing_.left_out["uses of what the file lacks"];
            return;
        }
        around.is_used = true;
        around.frame =
            around.frame * Affine{{1, 0}, {0, 1}, {svgNumber(node, "x"), svgNumber(node, "y")}};
        if (svgName(target->second) != "symbol") return addElement(target->second, around);
        const SvgElement& symbol = elementOf(target->second, true);
        spend(symbol.units);
        around.frame = around.frame * viewportOf(target->second, node);
        around.style = svgStyle(around.style, symbol.properties);
        addChildren(target->second, around);
    }

    void spend(std::size_t units) {
        if (!budget_.take(units))
            throw SvgError("uses and curves of the drawing make " + budget_.excess());
    }

    /// Fills the page, without an outline.
    [[nodiscard]] bool isBackground(pugi::xml_node node, const Affine& frame,
                                    const SvgStyle& style) const {
        const auto covers = [](std::string_view text, double value, double page) {
            return text == "100%" || (value >= page * (1 - 1e-9) && value <= page * kMaxBackground);
        };
        const auto size = [node](const char* key) {
            const std::string_view text = trimmed(node.attribute(key).value());
            return text.ends_with('%') ? 0 : svgNumber(node, key);
        };
        return !style.has_stroke && frame.x == page_frame_.x && frame.y == page_frame_.y &&
               covers(node.attribute("width").value(), size("width"), page_.width) &&
               covers(node.attribute("height").value(), size("height"), page_.height);
    }

    void addShape(pugi::xml_node node, std::string_view kind, const Around& around) {
        const SvgStyle& style = around.style;
        if (!style.visible ||
            ((style.no_fill || style.clear_fill) && (style.no_stroke || style.clear_stroke))) {
            ++drawing_.left_out["elements that show nothing"];
            return;
        }
        if (kind == "rect" && isBackground(node, around.frame, style)) {
            ++drawing_.left_out["a background"];
            return;
        }
        for (const SvgSubpath& path : svgPaths(node, kind)) addPath(node, path, around);
    }

    /// A subpath as it lies in the plan.
    void addPath(pugi::xml_node node, const SvgSubpath& path, const Around& around) {
        const Affine& frame = around.frame;
        const std::string_view layer = around.names.planLayer();
        const std::string_view walls = around.names.walls == nullptr ? "" : around.names.walls;
        spend(1 + Budget::unitsOf(layer.size() + walls.size()));
        PlanShape shape;
        shape.layer = layer_text_.of(layer);
        shape.walls_in = walls_text_.of(walls);
        shape.path.line = file_.lineOf(node);
        shape.path.closed = path.closed;
        Polygon& points = shape.path.points;
        points.push_back(frame * path.start);
        for (const SvgPiece& piece : path.pieces) {
            std::visit([&](const auto& p) { addPiece(p, frame, shape); }, piece);
            if (points.size() > budget_.left()) spend(points.size());  // refuses
        }
        if (path.closed && points.back() != points.front())
            shape.chords.push_back({{points.back(), points.front()}, {}});
        if (path.closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
        spend(points.size());
        for (const Point2 p : points)
            if (!(std::max(std::abs(p.x), std::abs(p.y)) <= kMaxPlanCoordinate))
                throw SvgError("lies more than " + formatDouble(kMaxPlanCoordinate / 1000) +
                               " km from the origin: is the unit right (--units)?");
        if (points.size() < 3) shape.path.closed = false;
        if (points.size() >= 2) drawing_.shapes.push_back(std::move(shape));
    }

    static void addPiece(const SvgLine& line, const Affine& frame, PlanShape& shape) {
        const Point2 from = shape.path.points.back(), to = frame * line.to;
        if (from == to) return;
        shape.path.points.push_back(to);
        shape.chords.push_back({{from, to}, {}});
    }
    static void addPiece(const SvgCubic& cubic, const Affine& frame, PlanShape& shape) {
        const CubicCurve curve{shape.path.points.back(), frame * cubic.control1,
                               frame * cubic.control2, frame * cubic.to};
        appendCubic(curve, shape.path.points);
        // Drawing programs write arcs, such as those of doors, as these curves.
        if (const auto center = arcCenter(curve))
            shape.chords.push_back({{curve[0], curve[3]}, center});
    }
    static void addPiece(const SvgArc& arc, const Affine& frame, PlanShape& shape) {
        const Point2 from = shape.path.points.back(), to = frame * arc.to;
        const Vec2 major = frame * arc.major, minor = frame * arc.minor;
        const double longest = std::hypot(length(major), length(minor));
        const int count = arcPieces(arc.sweep, longest);
        for (int i = 1; i < count; ++i) {
            const double t = arc.from + arc.sweep * i / count;
            shape.path.points.push_back(frame * arc.center +
                                        (std::cos(t) * major + std::sin(t) * minor));
        }
        shape.path.points.push_back(to);
        const bool round = std::abs(length(major) - length(minor)) <= kRound * longest &&
                           std::abs(dot(major, minor)) <= kRound * longest * longest;
        if (round && from != to) shape.chords.push_back({{from, to}, frame * arc.center});
    }

    XmlFile file_;
    const ImportOptions& options_;
    std::optional<double> asked_scale_;
    std::unordered_map<std::string, pugi::xml_node> ids_;
    Budget budget_;
    std::unordered_map<std::size_t, SvgElement> elements_;  // that are used, by node
    SvgElement element_;                                    // read last, of others
    SvgSheet sheet_;
    SvgBox page_;
    Affine page_frame_;
    SvgDrawing drawing_;
    PrintableNames layer_text_, walls_text_;
};

/// A drawing's document, and its room.
struct SvgImport {
    Document document;
    PlanOutcome outcome;
};

/// The units that a drawing may have, and the decision for one of them.
struct SvgUnits {
    std::vector<UnitEvidence> ranking;
    const UnitEvidence* decided = nullptr;
    bool has_size = false;  ///< on paper
};

/// Decides on the unit of a drawing by its contents if the options do not state it, and its size
/// on paper is missing or impossible.
SvgUnits unitsOf(std::string_view bytes, const std::string& name, const ImportOptions& options) {
    SvgUnits units;
    if (!options.units.empty() || options.width_is) return units;
    const std::optional<double> paper = SvgReader(bytes, name, options).paperScale();
    units.has_size = paper.has_value();
    const LengthUnit stated{"its size", paper.value_or(0), 0};
    const LengthUnit* const own = paper ? &stated : nullptr;
    units.ranking = rankedUnits(
        [&](double metres) -> LayerSorter::Sorted {
            try {
                std::vector<PlanShape> shapes =
                    SvgReader(bytes, name, options, metres).read().shapes;
                leaveOutStrays(shapes);
                return LayerSorter({}, options).sort(std::move(shapes));
            } catch (const FormatError& /*not in this unit*/) {
                return {};
            }
        },
        Budget(bytes.size(), options.max_work), own);
    const UnitEvidence* const decided = decidedUnit(units.ranking, own);
    std::erase_if(units.ranking,
                  [&](const UnitEvidence& evidence) { return evidence.unit == own; });
    // A decided unit leads the ranking.
    if (decided != nullptr) units.decided = &units.ranking.front();
    return units;
}

SvgDrawing readDrawing(std::string_view bytes, const std::string& name,
                       const ImportOptions& options, const UnitEvidence* decided) {
    if (decided != nullptr) {
        SvgDrawing drawing = SvgReader(bytes, name, options, decided->unit->metres).read();
        drawing.scale = std::string("a unit of the drawing is 1 ") + decided->unit->name;
        return drawing;
    }
    if (!options.width_is) return SvgReader(bytes, name, options).read();
    const double metres = metresPerUnit(*options.width_is, name, [&](double metres_per_unit) {
        LayerSorter sorter({}, options);
        SvgDrawing drawing = SvgReader(bytes, name, options, metres_per_unit).read();
        LayerSorter::Sorted sorted = sorter.sort(std::move(drawing.shapes));
        sorter.mustHaveWalls(sorted, name, drawing.left_out);
        return std::move(sorted.walls);
    });
    SvgDrawing drawing = SvgReader(bytes, name, options, metres).read();
    drawing.scale =
        unitText(metres) + ", so that it is " + formatDouble(*options.width_is) + " m wide";
    return drawing;
}

/// \param hints whether the drawing may be imported again to report the effect of other options
SvgImport importSvg(std::string_view bytes, const std::string& name, const ImportOptions& asked,
                    const Schemas& schemas, const SvgUnits& units, bool hints,
                    std::vector<std::string>* better_layers = nullptr) {
    Budget whole(bytes.size(), asked.max_work);
    ImportOptions options = asked;
    options.max_work.whole = &whole;  // pays for uses and curves, and for the plan of them
    ImportRecords out(schemas, name, options);
    const UnitEvidence* const decided =
        options.units.empty() && !options.width_is ? units.decided : nullptr;
    SvgDrawing drawing = readDrawing(bytes, name, options, decided);
    if (decided != nullptr)
        out.warn(std::string(units.has_size ? "by its size on paper the drawing is no building"
                                            : "the drawing has no scale") +
                 ": its unit is read as 1 " + decided->unit->name + ", in which " +
                 evidenceText(*decided) + "; --units takes another");
    out.note(drawing.scale);
    for (const auto& [what, count] : drawing.left_out)
        out.note("left out: " + what + " (" + std::to_string(count) + ')');
    DrawingSource source{
        options.units.empty()
            ? "units of " + formatDouble(std::round(drawing.metres_per_unit * 1e9) / 1e6) + " mm"
            : options.units,
        drawing.metres_per_unit, bytes.size(), drawing.left_out};
    for (const UnitEvidence& evidence : units.ranking)
        source.likely_units.emplace_back(evidence.unit->name);
    if (hints)
        source.import = [&](ImportOptions other) {
            other.max_work = asked.max_work;  // as much again
            return importSvg(bytes, name, other, schemas, units, false).outcome;
        };
    source.better_layers = better_layers;
    warnOfUnread(drawing.unread, "save it as plain SVG, with attributes instead of rules", out);
    leaveOutStrays(drawing.shapes, &out);
    LayerSorter sorter({}, options);
    LayerSorter::Sorted shapes = sorter.sort(std::move(drawing.shapes));
    sorter.note(out);
    const PlanOutcome outcome =
        writeLinePlan(std::move(shapes), sorter, name, options, &source, out);
    return {out.take(), outcome};
}

}  // namespace

bool isSvg(std::string_view bytes) { return xmlRootName(bytes) == "svg"; }

Document readSvg(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    const SvgUnits units = unitsOf(bytes, name, options);
    return importWithNamedWalls(
        options, [&](const ImportOptions& asked, std::vector<std::string>* better_layers) {
            return importSvg(bytes, name, asked, schemas, units, true, better_layers).document;
        });
}

}  // namespace ispace
