// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>

#include "base/error.h"
#include "base/number.h"
#include "base/utf8.h"
#include "draw/font.h"
#include "draw/svg_text.h"

namespace ispace {

namespace {

cairo_status_t append(void* closure, const unsigned char* bytes, unsigned int length) {
    try {
        static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(bytes), length);
    } catch (const std::bad_alloc&) {
        return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
}

void check(cairo_status_t status) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    throw std::logic_error(std::string("cairo: ") + cairo_status_to_string(status));
}

/// Cairo jumps into a function that has returned where it finds no memory while it draws: what it
/// may want has to be there before. It costs a microsecond or two.
void mustHaveMemory() {
    constexpr std::size_t kMost = std::size_t{8} << 20U;
    void* const memory = ::mmap(nullptr, kMost, PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    ::munmap(memory, kMost);
}

/// Sets the font, independent of what the machine's settings prefer.
void selectFont(cairo_t* context, const TextStyle& style) {
    cairo_set_font_face(context, fontFace(style.bold));
    cairo_set_font_size(context, style.size);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(context, options);
    cairo_font_options_destroy(options);
}

}  // namespace

double textWidth(std::string_view text, const TextStyle& style) {
    const std::string clean = printable(text);
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
        cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), cairo_surface_destroy);
    const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                     cairo_destroy);
    selectFont(context.get(), style);
    cairo_text_extents_t extents{};
    cairo_text_extents(context.get(), clean.c_str(), &extents);
    check(cairo_status(context.get()));
    return extents.x_advance;
}

struct Canvas::Data {
    PictureFormat format;
    double width, height;
    std::string bytes;
    cairo_surface_t* surface = nullptr;
    cairo_t* context = nullptr;
    std::vector<std::optional<PageView>> views = {std::nullopt};  // the innermost last; none: page
    std::string svg_texts;  // elements that Cairo, which writes glyphs, does not know
    bool finished = false;

    Data(PictureFormat wanted, double w, double h) : format(wanted), width(w), height(h) {
        switch (format) {
            case PictureFormat::Png:
                surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                                     static_cast<int>(std::lround(width)),
                                                     static_cast<int>(std::lround(height)));
                break;
            case PictureFormat::Svg:
                surface = cairo_svg_surface_create_for_stream(append, &bytes, width, height);
                cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
                break;
            case PictureFormat::Pdf:
                surface = cairo_pdf_surface_create_for_stream(append, &bytes, width, height);
                cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
                break;
        }
        context = cairo_create(surface);
        cairo_set_fill_rule(context, CAIRO_FILL_RULE_EVEN_ODD);
        cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
        cairo_set_source_rgb(context, 1, 1, 1);
        cairo_paint(context);
    }
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;
    ~Data() {
        cairo_destroy(context);
        cairo_surface_destroy(surface);
    }

    [[nodiscard]] Point2 toPage(Point2 p) const {
        // Cairo counts in 24.8 fixed point: what lies far off the page is brought near it.
        constexpr double kFar = 1e6;
        const Point2 page = views.back() ? *views.back() * p : p;
        return {std::clamp(page.x, -kFar, kFar), std::clamp(page.y, -kFar, kFar)};
    }
    [[nodiscard]] double toPage(double length) const {
        return views.back() ? length * views.back()->scale : length;
    }
    void moveTo(Point2 p) const {
        const Point2 page = toPage(p);
        cairo_move_to(context, page.x, page.y);
    }
    void lineTo(Point2 p) const {
        const Point2 page = toPage(p);
        cairo_line_to(context, page.x, page.y);
    }
    void addCurve(const Polygon& polygon) const {
        if (polygon.empty()) return;
        moveTo(polygon.front());
        for (std::size_t i = 1; i < polygon.size(); ++i) lineTo(polygon[i]);
        cairo_close_path(context);
    }
    void addRegion(const Region& region) const {
        addCurve(region.outline);
        for (const Polygon& hole : region.holes) addCurve(hole);
    }
    void addArc(Point2 center, double radius, Angle from, Angle to) const {
        const Point2 page = toPage(center);
        cairo_arc_negative(context, page.x, page.y, std::min(toPage(radius), 1e6), -from.radians(),
                           -to.radians());
    }
    void addCircle(Point2 center, double radius) const {
        addArc(center, radius, Angle(), Angle::degrees(360));
        cairo_close_path(context);
    }
    void use(Color color) const {
        cairo_set_source_rgba(context, color.red, color.green, color.blue, color.alpha);
    }
    void fillPath(Color color) const {
        use(color);
        mustHaveMemory();
        cairo_fill(context);
    }
    void strokePath(const Stroke& stroke) const {
        use(stroke.color);
        cairo_set_line_width(context, stroke.width);
        cairo_set_dash(context, stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0);
        cairo_set_line_cap(context,
                           stroke.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        mustHaveMemory();
        cairo_stroke(context);
    }
    /// Lines across all that the clip lets through.
    void hatchClip(const Hatch& hatch) const {
        double left = 0, top = 0, right = 0, bottom = 0;
        cairo_clip_extents(context, &left, &top, &right, &bottom);
        if (left >= right || top >= bottom) return;
        const Vec2 seen = unitVector(hatch.direction);
        const Vec2 along{seen.x, -seen.y}, left_of{-seen.y, -seen.x};
        const Point2 middle{(left + right) / 2, (top + bottom) / 2};
        const double reach = std::hypot(right - left, bottom - top) / 2 + hatch.width;
        const double spacing = std::max(hatch.spacing, 0.5);
        const double at = dot(left_of, middle - Point2{}), begin = dot(along, middle - Point2{});
        const auto number = [&](double place) { return (place - hatch.offset) / spacing; };
        const double last = std::floor(number(at + reach));
        for (double k = std::ceil(number(at - reach)); k <= last; ++k) {
            const Point2 foot = Point2{} + (k * spacing + hatch.offset) * left_of;
            const Point2 from = foot + (begin - reach) * along, to = foot + (begin + reach) * along;
            cairo_move_to(context, from.x, from.y);
            cairo_line_to(context, to.x, to.y);
        }
        strokePath({hatch.color, hatch.width});
    }
    void push(std::optional<PageView> view) {
        cairo_save(context);
        views.push_back(view);
    }
};

Canvas::Canvas(PictureFormat format, double width, double height) {
    if (!(width >= 1 && width <= kLongestSide && height >= 1 && height <= kLongestSide))
        throw UsageError("a picture of " + formatFixed(width, 0) + " x " + formatFixed(height, 0) +
                         " cannot be drawn, wanted 1 to " + formatFixed(kLongestSide, 0) +
                         " each way");
    data_ = std::make_unique<Data>(format, width, height);
}

Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

double Canvas::width() const { return data_->width; }
double Canvas::height() const { return data_->height; }

void Canvas::pushView(const PageView& view) { data_->push(view); }

void Canvas::pushClip(const Polygon& inside) {
    data_->push(data_->views.back());
    data_->addCurve(inside);
    cairo_clip(data_->context);
}

void Canvas::pushClip(const Region& inside) {
    data_->push(data_->views.back());
    data_->addRegion(inside);
    cairo_clip(data_->context);
}

void Canvas::pushClip(std::span<const Polygon> inside) {
    data_->push(data_->views.back());
    for (const Polygon& curve : inside) data_->addCurve(curve);
    cairo_clip(data_->context);
}

void Canvas::pop() {
    assert(data_->views.size() > 1);
    data_->views.pop_back();
    cairo_restore(data_->context);
}

Point2 Canvas::toPage(Point2 p) const { return data_->toPage(p); }

void Canvas::fill(const Polygon& polygon, Color color) { fill(std::span(&polygon, 1), color); }

void Canvas::fill(const Region& region, Color color) {
    data_->addRegion(region);
    data_->fillPath(color);
}

void Canvas::fill(std::span<const Polygon> curves, Color color) {
    for (const Polygon& curve : curves) data_->addCurve(curve);
    data_->fillPath(color);
}

void Canvas::hatch(std::span<const Polygon> curves, const Hatch& hatch) {
    pushClip(curves);
    data_->hatchClip(hatch);
    pop();
}

void Canvas::stroke(const Polygon& polygon, const Stroke& stroke) {
    this->stroke(std::span(&polygon, 1), stroke);
}

void Canvas::stroke(std::span<const Polygon> curves, const Stroke& stroke) {
    for (const Polygon& curve : curves) data_->addCurve(curve);
    data_->strokePath(stroke);
}

void Canvas::stroke(const Region& region, const Stroke& stroke) {
    data_->addRegion(region);
    data_->strokePath(stroke);
}

void Canvas::line(Point2 a, Point2 b, const Stroke& stroke) {
    const Segment2 segment{a, b};
    lines(std::span(&segment, 1), stroke);
}

void Canvas::lines(std::span<const Segment2> segments, const Stroke& stroke) {
    const Segment2* previous = nullptr;
    for (const Segment2& segment : segments) {
        if (previous == nullptr || !(previous->b == segment.a)) data_->moveTo(segment.a);
        data_->lineTo(segment.b);
        previous = &segment;
    }
    data_->strokePath(stroke);
}

void Canvas::polyline(std::span<const Point2> points, const Stroke& stroke) {
    for (const Point2& p : points) &p == points.data() ? data_->moveTo(p) : data_->lineTo(p);
    data_->strokePath(stroke);
}

void Canvas::fillCircle(Point2 center, double radius, Color color) {
    data_->addCircle(center, radius);
    data_->fillPath(color);
}

void Canvas::strokeCircle(Point2 center, double radius, const Stroke& stroke) {
    data_->addCircle(center, radius);
    data_->strokePath(stroke);
}

void Canvas::strokeArc(Point2 center, double radius, Angle from, Angle to, const Stroke& stroke) {
    cairo_new_sub_path(data_->context);
    data_->addArc(center, radius, from, to);
    data_->strokePath(stroke);
}

void Canvas::fillSector(Point2 center, double radius, Angle from, Angle to, Color color) {
    data_->moveTo(center);
    data_->addArc(center, radius, from, to);
    cairo_close_path(data_->context);
    data_->fillPath(color);
}

void Canvas::image(Point2 corner, const Image& picture, double pixel_width, double pixel_height) {
    if (picture.width < 1 || picture.height < 1) return;
    using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
    const Surface pixels(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height),
        cairo_surface_destroy);
    check(cairo_surface_status(pixels.get()));
    unsigned char* row = cairo_image_surface_get_data(pixels.get());
    const auto width = static_cast<std::size_t>(picture.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
        std::memcpy(row, &picture.pixels[y * width], width * sizeof(std::uint32_t));
        row += cairo_image_surface_get_stride(pixels.get());
    }
    cairo_surface_mark_dirty(pixels.get());

    const Point2 page = data_->toPage(corner);
    cairo_t* context = data_->context;
    cairo_save(context);
    cairo_translate(context, page.x, page.y);
    cairo_scale(context, data_->toPage(pixel_width), data_->toPage(pixel_height));
    cairo_set_source_surface(context, pixels.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_NEAREST);
    cairo_rectangle(context, 0, 0, picture.width, picture.height);
    mustHaveMemory();
    cairo_fill(context);
    cairo_restore(context);
}

void Canvas::text(Point2 anchor, std::string_view text, const TextStyle& style) {
    const std::string clean = printable(text);
    const double length = textWidth(clean, style);
    const double back = style.align == Align::Left     ? 0
                        : style.align == Align::Center ? length / 2
                                                       : length;
    const Point2 page = data_->toPage(anchor);
    if (data_->format == PictureFormat::Svg) {
        const Point2 begin{page.x - back, page.y};
        if (style.halo) appendSvgText(data_->svg_texts, begin, length, clean, style, true);
        appendSvgText(data_->svg_texts, begin, length, clean, style, false);
        return;
    }
    cairo_t* context = data_->context;
    selectFont(context, style);
    if (style.halo) {
        cairo_move_to(context, page.x - back, page.y);
        cairo_text_path(context, clean.c_str());
        data_->strokePath({*style.halo, style.size / 4});
    }
    cairo_move_to(context, page.x - back, page.y);
    data_->use(style.color);
    cairo_show_text(context, clean.c_str());
    cairo_new_path(context);
}

std::string Canvas::encode() {
    Data& data = *data_;
    if (!data.finished) {
        data.finished = true;
        check(cairo_status(data.context));
        if (data.format == PictureFormat::Png)
            check(cairo_surface_write_to_png_stream(data.surface, append, &data.bytes));
        cairo_surface_finish(data.surface);
        check(cairo_surface_status(data.surface));
        if (data.format == PictureFormat::Svg)
            data.bytes = withTexts(renumberSurfaces(data.bytes), data.svg_texts);
    }
    return data.bytes;
}

}  // namespace ispace
