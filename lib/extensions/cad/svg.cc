// SPDX-License-Identifier: GPL-3.0-or-later
// A plan from SVG (W3C, SVG 1.1 and 2; CSS 2.1 cascade in svg_sheet.cc). The document is walked
// with the state that elements inherit: transform, style, names, clip. `use` shares elements, so a
// small file may draw a million: each use is paid for. Scale is the hard part: pages state it, or
// the drawing's contents decide (io/plan/drawing_unit.h).
#include "extensions/cad/cad.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
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
#include "extensions/cad/svg.h"
#include "io/import_records.h"
#include "io/plan/drawing_unit.h"
#include "io/plan/line_plan.h"
#include "io/unread.h"
#include "io/xml_file.h"

namespace ispace::cad {

namespace {

/// The contents of an SVG file that an import uses.
struct SvgDrawing {
    std::vector<PlanShape> shapes;
    std::string scale;  ///< length of a unit and its source, for a note
    double metres_per_unit = 0;
    std::map<std::string, std::size_t> left_out;  ///< elements, by type or reason
    std::vector<UnreadThing> unread;              ///< rules that may hide lines, and uses
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

/// Thickness of strokes that are walls, in metres; thinner ones are pens.
constexpr double kThinnestStroke = 0.08, kThickestStroke = 0.8;
constexpr double kLongestPaper = 1.5;  // metres: more than A0
constexpr const char* kOddClip = "element with a clip-path that is not read";
/// Units of Budget for an element that is not read: its names are copied.
constexpr std::size_t kUnreadElementWork = 20;

/// Scales of plans on paper, and in feet and inches: 1/48 is 1/4" to the foot.
constexpr std::array<std::pair<const char*, double>, 6> kScales{
    {{"1:50", 50}, {"1:100", 100}, {"1:200", 200}, {"1:20", 20}, {"1:10", 10}, {"1:500", 500}}};
constexpr std::array<std::pair<const char*, double>, 5> kInchScales{
    {{"1:48", 48}, {"1:96", 96}, {"1:24", 24}, {"1:192", 192}, {"1:12", 12}}};

double metresOf(const std::string& unit) {
    for (const LengthUnit& known : kLengthUnits)
        if (unit == known.name) return known.metres;
    throw SvgError("unknown unit " + unit);
}

/// The visible part of what a `clip-path` clips: the union of its shapes, each by its `clip-rule`.
struct Clip {
    struct Part {
        std::vector<Polygon> rings;  ///< in the plan's frame
        bool is_even_odd = false;

        [[nodiscard]] bool shows(Point2 p) const {
            int winding = 0, count = 0;
            for (const Polygon& ring : rings) {
                if (locate(ring, p) == Side::Outside) continue;
                winding += signedArea(ring) < 0 ? -1 : 1;
                ++count;
            }
            return is_even_odd ? count % 2 == 1 : winding != 0;
        }
    };
    std::vector<Part> parts;
    Box2 box;

    [[nodiscard]] bool shows(Point2 p) const {
        return box.contains(p) && std::any_of(parts.begin(), parts.end(),
                                              [p](const Part& part) { return part.shows(p); });
    }
    [[nodiscard]] std::size_t corners() const {
        std::size_t count = 0;
        for (const Part& part : parts)
            for (const Polygon& ring : part.rings) count += ring.size();
        return count;
    }
};

/// The context of an element.
struct Around {
    Affine frame;
    SvgStyle style;
    SvgNames names;
    SvgBox view = {};  ///< the nearest viewport, in its inner coordinates
    int depth = 0;
    bool is_used = false;          ///< by `use`
    const char* unread = nullptr;  ///< why the place or the visible part of its shapes is unknown
    bool has_pen = false;          ///< strokes are as wide on the page whatever the frame
    std::vector<std::shared_ptr<const Clip>> clips = {};
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
          has_sheet_file_(bytes.substr(0, kProlog).find("<?xml-stylesheet") !=
                          std::string_view::npos),
          options_(options),
          asked_scale_(metres_per_unit),
          budget_(bytes.size(), options.max_work) {}

    SvgDrawing read() {
        const pugi::xml_node root = file_.root();
        if (svgName(root) != "svg") file_.fail(root, "no `svg` at the root");
        listElements(root);
        at(root, [&] {
            page_frame_ = pageOf(root);
            addChildren(root, {page_frame_, svgStyle({}, svgProperties(root, sheet_)), {}, page_});
        });
        for (const auto& [selector, count] : sheet_.unread())
            for (std::size_t i = 0; i < count; ++i)
                drawing_.unread.push_back({"the CSS rule `" + printable(selector) + '`'});
        if (has_sheet_file_) drawing_.unread.push_back({"the file of a style sheet"});
        return std::move(drawing_);
    }

    /// Sets what scaleHint() says, for the message that the drawing has no scale.
    void setRanking(const std::vector<UnitEvidence>& ranking) { ranking_ = scaleHint(ranking); }

    /// Returns true if the size on paper is in inches, or in points and not that of a sheet of the
    /// series A, which programs write in points, too.
    [[nodiscard]] bool isInInches() {
        const pugi::xml_node root = file_.root();
        const std::string_view width = trimmed(root.attribute("width").value());
        if (!width.ends_with("pt")) return width.ends_with("in");
        const double across = root.attribute("width").as_double();
        const double down = root.attribute("height").as_double();
        constexpr double kSides = 1.41421, kRounding = 0.01;
        const double sides = std::max(across, down) / std::min(across, down);
        return !(std::abs(sides - kSides) < kRounding);
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
    /// Returns true if paper has such sizes. \pre paperScale() was called
    [[nodiscard]] bool isOnPaper() const {
        return std::max(page_.width, page_.height) * drawing_.metres_per_unit <= kLongestPaper;
    }

  private:
    static constexpr std::size_t kProlog = 4096;  // bytes before the first element

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
        std::vector<std::string_view> styles;
        forEachElement(root, [&](pugi::xml_node node) {
            if (const pugi::xml_attribute id = node.attribute("id")) ids_.emplace(id.value(), node);
            if (svgName(node) != "style") return;
            for (const pugi::xml_node text : node.children()) styles.emplace_back(text.value());
        });
        sheet_ = SvgSheet(styles);
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
                           std::string(width || height ? "in pixels" : "not said") +
                           (ranking_.empty() ? std::string(": ") + kScaleHint : ranking_));
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
        around.frame = around.frame * transformOf(element, around.view);
        around.style = svgStyle(around.style, element.properties);
        around.names = around.names.with(element.names);
        around.has_pen = element.properties[SvgProperty::VectorEffect] == "non-scaling-stroke";
        addClip(element.properties, around);
        if (is_shape) return addShape(node, kind, around);
        if (kind == "use") return addUse(node, around);
        if (kind == "svg") enterViewport(node, node, around);
        if (kind == "switch") return addSwitch(node, around);
        addChildren(node, around);
    }

    static Affine transformOf(const SvgElement& element, const SvgBox& view) {
        const auto origin = svgOrigin(element.properties[SvgProperty::TransformOrigin], view);
        if (!origin) return element.transform;
        return Affine{{1, 0}, {0, 1}, *origin} * element.transform *
               Affine{{1, 0}, {0, 1}, -1 * *origin};
    }

    /// Returns true if one of the languages between commas is English.
    static bool hasEnglish(std::string_view languages) {
        while (!languages.empty()) {
            const std::size_t comma = std::min(languages.find(','), languages.size());
            if (trimmed(languages.substr(0, comma)).starts_with("en")) return true;
            languages.remove_prefix(std::min(comma + 1, languages.size()));
        }
        return false;
    }

    /// Adds the first child with conditions that hold, as browsers do that have no extensions.
    void addSwitch(pugi::xml_node node, const Around& around) {
        for (const pugi::xml_node child : node.children()) {
            if (child.type() != pugi::node_element) continue;
            const std::string_view language = trimmed(child.attribute("systemLanguage").value());
            if (!trimmed(child.attribute("requiredExtensions").value()).empty()) continue;
            if (child.attribute("systemLanguage") && !hasEnglish(language)) continue;
            at(child, [&] { addElement(child, around); });
            return;
        }
    }

    /// Returns the element that `url(#id)` names; none for other text.
    [[nodiscard]] pugi::xml_node namedBy(std::string_view url) const {
        const std::size_t mark = url.find('#');
        if (!url.starts_with("url(") || mark == std::string_view::npos) return {};
        std::string_view id = url.substr(mark + 1);
        id = id.substr(0, id.find_first_of(")\"'"));
        const auto found = ids_.find(std::string(id));
        return found == ids_.end() ? pugi::xml_node() : found->second;
    }

    /// Adds the clip and the mask of an element.
    void addClip(const SvgProperties& properties, Around& around) {
        if (const std::string_view mask = properties[SvgProperty::Mask];
            !mask.empty() && mask != "none")
            around.unread = "element with a mask";
        const std::string_view box = properties[SvgProperty::TransformBox];
        if (!box.empty() && box != "view-box" &&
            !properties[SvgProperty::TransformOrigin].empty() &&
            !properties[SvgProperty::Transform].empty())
            around.unread = "element turned about its own box";
        const std::string_view url = properties[SvgProperty::ClipPath];
        if (url.empty() || url == "none") return;
        const pugi::xml_node node = namedBy(url);
        if (!node || svgName(node) != "clipPath") {
            if (!url.starts_with("url(")) around.unread = kOddClip;  // shapes of CSS
            return;
        }
        if (std::string_view(node.attribute("clipPathUnits").value()) == "objectBoundingBox") {
            around.unread = kOddClip;
            return;
        }
        const auto clip = std::make_shared<Clip>();
        const SvgElement own = elementAt(node);
        const Affine frame = around.frame * transformOf(own, around.view);
        for (const pugi::xml_node child : node.children()) {
            pugi::xml_node shape = child;
            if (child.type() != pugi::node_element) continue;
            spend(kUnreadElementWork);
            const SvgElement element = elementAt(child);
            if (element.properties[SvgProperty::Display] == "none") continue;
            Affine placed = frame * transformOf(element, around.view);
            if (svgName(child) == "use") {
                std::string_view href = child.attribute("href").value();
                if (href.empty()) href = child.attribute("xlink:href").value();
                const auto target =
                    href.starts_with('#') ? ids_.find(std::string(href.substr(1))) : ids_.end();
                if (target == ids_.end()) continue;
                shape = target->second;
                placed = placed *
                         Affine{{1, 0}, {0, 1}, {svgNumber(child, "x"), svgNumber(child, "y")}} *
                         transformOf(elementAt(shape), around.view);
            }
            const std::string_view kind = svgName(shape);
            if (isOneOf(kOthers, kind)) {
                around.unread = kOddClip;  // letters
                return;
            }
            if (!isOneOf(kShapes, kind)) continue;  // draws nothing
            Clip::Part part;
            // Inherited: the shape's own rule, else that of its `use`, else that of the clip.
            for (const std::string_view rule :
                 {elementAt(shape).properties[SvgProperty::ClipRule],
                  element.properties[SvgProperty::ClipRule], own.properties[SvgProperty::ClipRule]})
                if (!rule.empty()) {
                    part.is_even_odd = rule == "evenodd";
                    break;
                }
            for (const SvgSubpath& path : svgPaths(shape, kind, around.view)) {
                const PlanShape ring = shapeOf(path, placed);
                if (ring.path.points.size() < 3) continue;
                for (const Point2 p : ring.path.points) clip->box.add(p);
                part.rings.push_back(ring.path.points);
            }
            clip->parts.push_back(std::move(part));
        }
        around.clips.push_back(clip);
    }

    /// Returns the element itself; caches it if it may be used again.
    const SvgElement& elementOf(pugi::xml_node node, bool is_used) {
        if (!is_used) return element_ = elementAt(node);
        const auto [known, is_new] = elements_.try_emplace(node.hash_value());
        if (is_new) known->second = elementAt(node);
        return known->second;
    }

    /// Reads an element, and pays for the selectors that it is compared with.
    SvgElement elementAt(pugi::xml_node node) {
        SvgElement element = readSvgElement(node, sheet_, options_);
        spend(element.matching);
        return element;
    }

    /// Enters the view box of an inner `svg` or a `symbol` at `placed`.
    void enterViewport(pugi::xml_node node, pugi::xml_node placed, Around& around) const {
        const bool is_use = node != placed;
        const SvgBox& outer = around.view;
        const Affine corner{{1, 0},
                            {0, 1},
                            is_use ? Vec2{}
                                   : Vec2{svgNumber(placed, "x", 0, outer.width),
                                          svgNumber(placed, "y", 0, outer.height)}};
        const auto box = svgViewBox(node);
        const auto size = [&](const char* key, double own, double whole) {
            for (const pugi::xml_node element : {placed, node}) {
                const std::string_view text = trimmed(element.attribute(key).value());
                if (text.empty() || text == "auto") continue;
                const double value = svgNumber(element, key, 0, whole);
                if (value > 0) return value;
            }
            return is_use && box ? own : whole;
        };
        const double width = size("width", box ? box->width : 0, outer.width);
        const double height = size("height", box ? box->height : 0, outer.height);
        if (!box) {
            around.frame = around.frame * corner;
            around.view = {0, 0, width, height};
            return;
        }
        Vec2 scale{width / box->width, height / box->height};
        if (!isStretched(node)) scale.x = scale.y = std::min(scale.x, scale.y);
        const Vec2 rest{(width - scale.x * box->width) / 2, (height - scale.y * box->height) / 2};
        const Vec2 origin{scale.x * box->x, scale.y * box->y};
        around.frame = around.frame * corner * Affine{{scale.x, 0}, {0, scale.y}, rest - origin};
        around.view = *box;
    }

    void addUse(pugi::xml_node node, Around around) {
        std::string_view href = node.attribute("href").value();
        if (href.empty()) href = node.attribute("xlink:href").value();
        const auto target =
            href.starts_with('#') ? ids_.find(std::string(href.substr(1))) : ids_.end();
        if (target == ids_.end()) {
            ++drawing_.left_out["uses of what the file lacks"];
            spend(kUnreadElementWork);
            drawing_.unread.push_back({"use of " + excerpt(href),
                                       layer_text_.of(around.names.planLayer()),
                                       {},
                                       file_.lineOf(node)});
            return;
        }
        around.is_used = true;
        around.frame = around.frame * Affine{{1, 0},
                                             {0, 1},
                                             {svgNumber(node, "x", 0, around.view.width),
                                              svgNumber(node, "y", 0, around.view.height)}};
        if (svgName(target->second) != "symbol") return addElement(target->second, around);
        const SvgElement& symbol = elementOf(target->second, true);
        spend(symbol.units);
        enterViewport(target->second, node, around);
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
        const bool has_no_fill = style.no_fill || style.clear_fill || kind == "line";
        const bool has_no_stroke =
            style.no_stroke || style.clear_stroke || !(style.stroke_width.value_or(1) > 0);
        if (!style.visible || (has_no_fill && has_no_stroke)) {
            ++drawing_.left_out["elements that show nothing"];
            return;
        }
        if (kind == "rect" && isBackground(node, around.frame, style)) {
            ++drawing_.left_out["a background"];
            return;
        }
        const Affine& f = around.frame;
        const double width = style.stroke_width.value_or(0) * std::sqrt(std::abs(cross(f.x, f.y)));
        const bool is_wall = has_no_fill && style.has_stroke && !has_no_stroke && !around.has_pen &&
                             width >= kThinnestStroke && width <= kThickestStroke;
        // A dashed outline of a filled shape bounds it.
        const bool is_dashed = style.is_dashed && has_no_fill && !has_no_stroke;
        for (const SvgSubpath& path : svgPaths(node, kind, around.view))
            addPath(node, path, around, is_wall ? width : 0, is_dashed);
    }

    /// Converts a subpath to a shape without names.
    PlanShape shapeOf(const SvgSubpath& path, const Affine& frame) {
        PlanShape shape;
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
        if (points.size() < 3) shape.path.closed = false;
        return shape;
    }

    /// Adds a subpath as it lies in the plan. \param thickness of the wall; 0: it is a face
    void addPath(pugi::xml_node node, const SvgSubpath& path, const Around& around,
                 double thickness, bool is_dashed) {
        const std::string_view layer = around.names.planLayer();
        const std::string_view walls = around.names.walls == nullptr ? "" : around.names.walls;
        spend(1 + Budget::unitsOf(layer.size() + walls.size()));
        PlanShape shape = shapeOf(path, around.frame);
        shape.layer = layer_text_.of(layer);
        shape.walls_in = walls_text_.of(walls);
        shape.path.line = file_.lineOf(node);
        shape.path.thickness = thickness;
        shape.is_dashed =
            is_dashed &&
            std::all_of(path.pieces.begin(), path.pieces.end(), [](const SvgPiece& piece) {
                return std::holds_alternative<SvgLine>(piece);
            });
        if (shape.path.points.size() < 2) return;
        requireOnEarth(shape, file_.name());
        std::vector<PlanShape> shown{std::move(shape)};
        for (const auto& clip : around.clips) shown = clipped(std::move(shown), *clip);
        for (PlanShape& part : shown) {
            if (around.unread != nullptr) {
                spend(kUnreadElementWork);
                drawing_.unread.push_back(
                    {around.unread, part.layer, {}, part.path.line, {}, bounds(part.path.points)});
            }
            drawing_.shapes.push_back(std::move(part));
        }
    }

    /// Returns the parts of the shapes that a clip shows, as open paths where it cuts. Costs the
    /// product of their points.
    std::vector<PlanShape> clipped(std::vector<PlanShape> shapes, const Clip& clip) {
        const std::size_t corners = clip.corners();
        std::vector<PlanShape> shown;
        for (PlanShape& shape : shapes) {
            const PlanPath& path = shape.path;
            spend(path.points.size() * corners);
            if (!clip.box.meets(bounds(path.points))) {
                ++drawing_.left_out["elements outside of their clip-path"];
                continue;
            }
            PlanShape part = blankOf(shape);
            bool is_whole = true;
            const auto end_part = [&] {
                if (part.path.points.size() >= 2) shown.push_back(std::move(part));
                part = blankOf(shape);
            };
            std::vector<PlanShape> before = std::exchange(shown, {});
            for (std::size_t i = 0; i < path.pieceCount(); ++i) {
                const Segment2 piece = path.piece(i);
                const std::vector<std::pair<double, double>> shares = clipShares(piece, clip);
                spend(shares.size() * corners);
                for (const auto& [from, to] : shares) {
                    const Point2 a = piece.a + from * (piece.b - piece.a);
                    const Point2 b = to == 1 ? piece.b : piece.a + to * (piece.b - piece.a);
                    if (!clip.shows(a + 0.5 * (b - a))) {
                        is_whole = false;
                        end_part();
                        continue;
                    }
                    if (part.path.points.empty()) part.path.points.push_back(a);
                    part.path.points.push_back(b);
                    part.chords.push_back({{a, b}, {}});
                }
            }
            end_part();
            if (is_whole) shown = {std::move(shape)};
            before.insert(before.end(), std::make_move_iterator(shown.begin()),
                          std::make_move_iterator(shown.end()));
            shown = std::move(before);
        }
        return shown;
    }

    static PlanShape blankOf(const PlanShape& shape) {
        PlanShape blank;
        blank.layer = shape.layer;
        blank.walls_in = shape.walls_in;
        blank.path.line = shape.path.line;
        blank.path.thickness = shape.path.thickness;
        blank.is_dashed = shape.is_dashed;
        return blank;
    }

    /// Splits a piece where it crosses the clip.
    static std::vector<std::pair<double, double>> clipShares(const Segment2& piece,
                                                             const Clip& clip) {
        std::vector<double> cuts{0, 1};
        const Vec2 along = piece.b - piece.a;
        const auto cut = [&](const Polygon& ring) {
            forEachEdge(ring, [&](const Segment2& edge) {
                const Vec2 side = edge.b - edge.a, way = edge.a - piece.a;
                const double turn = cross(along, side);
                if (turn == 0) return;
                const double share = cross(way, side) / turn, across = cross(way, along) / turn;
                if (share > 0 && share < 1 && across >= 0 && across <= 1) cuts.push_back(share);
            });
        };
        for (const Clip::Part& part : clip.parts)
            for (const Polygon& ring : part.rings) cut(ring);
        std::sort(cuts.begin(), cuts.end());
        std::vector<std::pair<double, double>> shares;
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
            if (cuts[i] < cuts[i + 1]) shares.emplace_back(cuts[i], cuts[i + 1]);
        return shares;
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
    bool has_sheet_file_;
    std::string ranking_;
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
    std::vector<LengthUnit> candidates;  ///< of the ranking: scales on paper, and units
    std::vector<UnitEvidence> ranking;
    const UnitEvidence* decided = nullptr;
    bool has_size = false;  ///< on paper
};

/// Returns the usual scales of a drawing on paper, and the units that a unit of the drawing may be,
/// unless that is a length on paper, as a millimetre.
std::vector<LengthUnit> candidatesOf(std::optional<double> paper, bool is_on_paper,
                                     bool is_in_inches) {
    std::vector<LengthUnit> all;
    const auto add = [&](const auto& scales) {
        for (const auto& [name, factor] : scales) all.push_back({name, factor * *paper, 0});
    };
    if (paper && is_on_paper && is_in_inches) add(kInchScales);
    if (paper && is_on_paper && !is_in_inches) add(kScales);
    constexpr double kSame = 1e-3, kInch = 0.0254;
    const auto lengths = {0.001, 0.01, 1.0, kInch, kInch / 72, kInch / 90, kInch / 96};
    if (!paper || std::none_of(lengths.begin(), lengths.end(), [&](double length) {
            return std::abs(*paper - length) <= kSame * length;
        }))
        all.insert(all.end(), usualUnits().begin(), usualUnits().end());
    return all;
}

/// Returns "its unit is read as 1 cm", or "it is read at the scale of 1:50".
std::string decisionText(const UnitEvidence& decided) {
    const std::string unit = decided.unit->name;
    return unit.starts_with("1:") ? "it is read at the scale of " + unit
                                  : "its unit is read as 1 " + unit;
}

/// Ranks the units of a drawing by its contents, and decides on one if its size on paper is missing
/// or impossible.
SvgUnits unitsOf(std::string_view bytes, const std::string& name, const ImportOptions& options) {
    SvgUnits units;
    SvgReader sized(bytes, name, options);
    const std::optional<double> paper = sized.paperScale();
    units.has_size = paper.has_value();
    units.candidates.assign(usualUnits().begin(), usualUnits().end());
    if (options.units.empty())
        units.candidates = candidatesOf(paper, sized.isOnPaper(), sized.isInInches());
    const LengthUnit stated{"its size", paper.value_or(0), 0};
    const LengthUnit* const own = paper ? &stated : nullptr;
    Budget reading(bytes.size(), options.max_work);
    const auto read = [&](double metres) -> LayerSorter::Sorted {
        try {
            ImportOptions shared = options;
            shared.max_work.whole = &reading;
            std::vector<PlanShape> shapes = SvgReader(bytes, name, shared, metres).read().shapes;
            leaveOutStrays(shapes);
            return LayerSorter({}, options).sort(std::move(shapes));
        } catch (const FormatError& /*not to be read*/) {
            return {};
        }
    };
    units.ranking =
        rankedUnits(read, Budget(bytes.size(), options.max_work), own, units.candidates);
    const UnitEvidence* const decided = decidedUnit(units.ranking, own);
    std::erase_if(units.ranking,
                  [&](const UnitEvidence& evidence) { return evidence.unit == own; });
    // A decided unit leads the ranking.
    if (decided != nullptr) units.decided = &units.ranking.front();
    return units;
}

SvgDrawing readDrawing(std::string_view bytes, const std::string& name,
                       const ImportOptions& options, const UnitEvidence* decided,
                       const SvgUnits& units) {
    if (decided != nullptr) {
        SvgDrawing drawing = SvgReader(bytes, name, options, decided->unit->metres).read();
        drawing.scale = unitText(decided->unit->metres);
        return drawing;
    }
    if (!options.width_is) {
        SvgReader reader(bytes, name, options);
        reader.setRanking(units.ranking);
        return reader.read();
    }
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
                    const Schemas& schemas, SvgUnits& units, bool hints,
                    std::vector<std::string>* better_layers = nullptr) {
    Budget whole(bytes.size(), asked.max_work);
    ImportOptions options = asked;
    options.max_work.whole = &whole;  // pays for uses and curves, and for the plan of them
    ImportRecords out(schemas, name, options);
    const UnitEvidence* const decided =
        options.units.empty() && !options.width_is ? units.decided : nullptr;
    SvgDrawing drawing = readDrawing(bytes, name, options, decided, units);
    if (decided != nullptr)
        out.warn(std::string(units.has_size ? "by its size on paper the drawing is no building"
                                            : "the drawing has no scale") +
                 ": " + decisionText(*decided) + ", in which " + evidenceText(*decided) +
                 "; --units" + (units.has_size ? " and --width-is take others" : " takes another"));
    out.note(drawing.scale);
    for (const auto& [what, count] : drawing.left_out)
        out.note("left out: " + what + " (" + std::to_string(count) + ')');
    DrawingSource source{
        options.units.empty()
            ? "units of " + formatDouble(std::round(drawing.metres_per_unit * 1e9) / 1e6) + " mm"
            : options.units,
        drawing.metres_per_unit, bytes.size(), drawing.left_out};
    source.ranking = [&]() -> const std::vector<UnitEvidence>& {
        if (units.candidates.empty()) units = unitsOf(bytes, name, asked);
        return units.ranking;
    };
    Budget again(bytes.size(), asked.max_work);  // for all hints
    if (hints)
        source.import = [&](ImportOptions other) {
            other.max_work = {asked.max_work.max, &again};
            return importSvg(bytes, name, other, schemas, units, false).outcome;
        };
    source.better_layers = better_layers;
    leaveOutStrays(drawing.shapes, &out);
    if (const auto way = movedHome(drawing.shapes, name)) {
        out.report(surveyText(*way, "drawing"));
        for (UnreadThing& thing : drawing.unread)
            if (!thing.extent.empty())
                thing.extent = {thing.extent.low - *way, thing.extent.high - *way};
    }
    LayerSorter sorter({}, options);
    LayerSorter::Sorted shapes = sorter.sort(std::move(drawing.shapes));
    sorter.note(out);
    std::erase_if(drawing.unread, [&](const UnreadThing& thing) {
        return !thing.layer.empty() && !sorter.mayBeWall(thing.layer);
    });
    const PlanOutcome outcome =
        writeLinePlan(std::move(shapes), sorter, name, options, &source, out);
    warnOfUnread(drawing.unread, outcome.rooms,
                 "save it as plain SVG, with attributes instead of rules and masks, and without "
                 "other files",
                 out);
    return {out.take(), outcome};
}

}  // namespace

bool isSvg(std::string_view bytes) { return xmlRootName(bytes) == "svg"; }

Document readSvg(std::string_view bytes, const std::string& name, const ImportOptions& options,
                 const Schemas& schemas) {
    SvgUnits units;
    if (options.units.empty() && !options.width_is) units = unitsOf(bytes, name, options);
    return importWithNamedWalls(
        options, [&](const ImportOptions& asked, std::vector<std::string>* better_layers) {
            return importSvg(bytes, name, asked, schemas, units, true, better_layers).document;
        });
}

}  // namespace ispace::cad
