// SPDX-License-Identifier: GPL-3.0-or-later
// Draws with Cairo, in a separately loaded module: linked into the programs, Cairo and the
// libraries that it requires, such as X11's, would cost 1.7 ms at each start, and the fonts 1.4 MB
// in each program.
#include <cairo-pdf.h>
#include <cairo.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "drawing/module/font.h"
#include "drawing/module/painter.h"

namespace ispace {

namespace {

using Kind = DisplayList::Kind;
using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

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

/// Cairo's rasteriser crashes if memory runs out, so the required memory is allocated beforehand as
/// a test. It takes two or three microseconds, as long as drawing a small shape.
void mustHaveMemory() {
    constexpr std::size_t kMax = std::size_t{8} << 20U;
    void* const memory = ::mmap(nullptr, kMax, PROT_READ | PROT_WRITE,
                                MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    ::munmap(memory, kMax);
}

/// Sets the font, independent of the machine's settings.
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

double advance(cairo_t* context, const std::string& text) {
    cairo_text_extents_t extents{};
    cairo_text_extents(context, text.c_str(), &extents);
    return extents.x_advance;
}

Surface surfaceOf(const Image& image) {
    Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height),
                    cairo_surface_destroy);
    check(cairo_surface_status(surface.get()));
    unsigned char* row = cairo_image_surface_get_data(surface.get());
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
        std::memcpy(row, &image.pixels[y * width], width * sizeof(std::uint32_t));
        row += cairo_image_surface_get_stride(surface.get());
    }
    cairo_surface_mark_dirty(surface.get());
    return surface;
}

/// Draws the shapes of a picture on a surface of its page.
class Painter {
  public:
    Painter(const Picture& picture, HatchOf& hatch_of, cairo_surface_t* surface)
        : picture_(picture),
          hatch_of_(hatch_of),
          list_(picture.list()),
          owner_(cairo_create(surface), cairo_destroy),
          context_(owner_.get()) {}

    /// Skips shapes outside these rows; the page unit is the pixel. With a clip, Cairo would round
    /// slightly differently.
    void keepTo(Rows rows) {
        if (rows.first > 0) first_ = rows.first;
        if (rows.beyond < picture_.height()) beyond_ = rows.beyond;
    }

    void paint() {
        cairo_set_fill_rule(context_, CAIRO_FILL_RULE_EVEN_ODD);
        cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
        cairo_set_source_rgb(context_, 1, 1, 1);
        cairo_paint(context_);
        for (const DisplayList::Shape& shape : list_.shapes)
            if (mayShow(shape)) draw(shape);
        check(cairo_status(context_));
    }

  private:
    void draw(const DisplayList::Shape& shape) {
        switch (shape.kind) {
            case Kind::Layer:
            case Kind::Group:
                cairo_save(context_);
                if (shape.first == shape.last) break;
                addCurves(shape, true);
                cairo_clip(context_);
                break;
            case Kind::End:
                cairo_restore(context_);
                break;
            case Kind::Text:
                write(list_.texts[shape.first]);
                break;
            case Kind::Image:
                copy(list_.images[shape.first]);
                break;
            case Kind::Area:
            case Kind::Lines:
            case Kind::Arc:
                if (shape.kind == Kind::Arc)
                    addArc(list_.arcs[shape.first]);
                else
                    addCurves(shape, shape.kind == Kind::Area);
                for (const Ink& ink : list_.inksOf(shape))
                    std::visit([&](const auto& kind) { apply(kind, shape); }, ink);
                cairo_new_path(context_);
        }
    }

    /// False if the shape lies above or below the rows.
    [[nodiscard]] bool mayShow(const DisplayList::Shape& shape) const {
        if (first_ == -kAll && beyond_ == kAll) return true;
        double low = kAll, high = -kAll;
        const auto add = [&](double y, double reach) {
            low = std::min(low, y - reach);
            high = std::max(high, y + reach);
        };
        switch (shape.kind) {
            case Kind::Text:
                add(list_.texts[shape.first].anchor.y, 2 * list_.texts[shape.first].style.size);
                break;
            case Kind::Area:
            case Kind::Lines:
                for (std::uint32_t i = shape.first; i < shape.last; ++i)
                    for (const Point2 p : list_.curve(i)) add(p.y, 0);
                break;
            case Kind::Arc:
                add(list_.arcs[shape.first].center.y, list_.arcs[shape.first].radius);
                break;
            default:
                return true;
        }
        double reach = 2;
        for (const Ink& ink : list_.inksOf(shape))
            if (const auto* stroke = std::get_if<Stroke>(&ink))
                reach = std::max(reach, stroke->width + 2);
        return low - reach <= beyond_ && high + reach >= first_;
    }

    void addCurves(const DisplayList::Shape& shape, bool closed) {
        for (std::uint32_t i = shape.first; i < shape.last; ++i) {
            const std::span<const Point2> curve = list_.curve(i);
            cairo_move_to(context_, curve[0].x, curve[0].y);
            for (const Point2 p : curve.subspan(1)) cairo_line_to(context_, p.x, p.y);
            if (closed) cairo_close_path(context_);
        }
    }
    void addArc(const DisplayList::Arc& arc) {
        if (!arc.isCircle()) cairo_move_to(context_, arc.center.x, arc.center.y);
        cairo_arc_negative(context_, arc.center.x, arc.center.y, arc.radius, -arc.from.radians(),
                           -arc.to.radians());
        cairo_close_path(context_);
    }
    void use(Color color) {
        cairo_set_source_rgba(context_, color.red, color.green, color.blue, color.alpha);
    }

    /// Tests memory now and then for small shapes, of which there may be many: Cairo frees their
    /// memory.
    void needMemory(const DisplayList::Shape& shape) {
        constexpr std::size_t kPointsOfArc = 128;
        if (shape.kind == Kind::Arc)
            unchecked_ += kPointsOfArc;
        else if (shape.kind == Kind::Area || shape.kind == Kind::Lines)
            unchecked_ += list_.ends[shape.last] - list_.ends[shape.first];
        else
            unchecked_ = kMany;
        if (unchecked_ < kMany) return;
        unchecked_ = 0;
        mustHaveMemory();
    }

    // Each keeps the path.
    void apply(Color color, const DisplayList::Shape& shape) {
        use(color);
        needMemory(shape);
        cairo_fill_preserve(context_);
    }
    void apply(const Stroke& stroke, const DisplayList::Shape& shape) {
        use(stroke.color);
        if (!stroke.dashes.empty()) unchecked_ = kMany;  // there may be thousands
        cairo_set_line_width(context_, stroke.width);
        cairo_set_dash(context_, stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0);
        cairo_set_line_cap(context_,
                           stroke.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        needMemory(shape);
        cairo_stroke_preserve(context_);
    }
    void apply(const Hatch& hatch, const DisplayList::Shape& shape) {
        const std::unique_ptr<cairo_path_t, decltype(&cairo_path_destroy)> path(
            cairo_copy_path(context_), cairo_path_destroy);
        cairo_save(context_);
        cairo_clip(context_);
        for (const Segment2& line : hatch_of_(hatch, picture_, shape)) {
            cairo_move_to(context_, line.a.x, line.a.y);
            cairo_line_to(context_, line.b.x, line.b.y);
        }
        apply(Stroke{hatch.color, hatch.width}, {});
        cairo_new_path(context_);
        cairo_restore(context_);
        cairo_append_path(context_, path.get());
    }

    void write(const DisplayList::Text& text) {
        const TextStyle& style = text.style;
        selectFont(context_, style);
        const double back = style.align == Align::Left     ? 0
                            : style.align == Align::Center ? advance(context_, text.text) / 2
                                                           : advance(context_, text.text);
        cairo_move_to(context_, text.anchor.x - back, text.anchor.y);
        if (style.halo) {
            cairo_text_path(context_, text.text.c_str());
            apply(Stroke{*style.halo, style.size / 4}, {});
            cairo_new_path(context_);
            cairo_move_to(context_, text.anchor.x - back, text.anchor.y);
        }
        use(style.color);
        cairo_show_text(context_, text.text.c_str());
        cairo_new_path(context_);
    }

    void copy(const DisplayList::Raster& raster) {
        const Surface pixels = surfaceOf(raster.image);
        cairo_save(context_);
        cairo_translate(context_, raster.corner.x, raster.corner.y);
        cairo_scale(context_, raster.pixel_width, raster.pixel_height);
        cairo_set_source_surface(context_, pixels.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(context_), CAIRO_FILTER_NEAREST);
        cairo_rectangle(context_, 0, 0, raster.image.width, raster.image.height);
        mustHaveMemory();
        cairo_fill(context_);
        cairo_restore(context_);
    }

    static constexpr std::size_t kMany = 1024;  // points drawn between two tests of memory
    static constexpr double kAll = 1e9;         // rows

    const Picture& picture_;
    HatchOf& hatch_of_;
    const DisplayList& list_;
    Context owner_;
    cairo_t* context_;
    double first_ = -kAll, beyond_ = kAll;  ///< rows that are drawn
    std::size_t unchecked_ = kMany;         ///< points drawn since the last test of memory
};

double widthOf(const std::string& text, const TextStyle& style) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    selectFont(context.get(), style);
    const double width = advance(context.get(), text);
    check(cairo_status(context.get()));
    return width;
}

Image pixelsOf(const Picture& picture, HatchOf& hatch_of, Rows rows) {
    Image image{static_cast<int>(std::lround(picture.width())),
                static_cast<int>(std::lround(picture.height())),
                {}};
    const auto width = static_cast<std::size_t>(image.width);
    image.pixels.resize(width * static_cast<std::size_t>(image.height));
    const Surface surface(
        cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(image.pixels.data()),
                                            CAIRO_FORMAT_RGB24, image.width, image.height,
                                            static_cast<int>(width * sizeof(std::uint32_t))),
        cairo_surface_destroy);
    Painter painter(picture, hatch_of, surface.get());
    painter.keepTo(rows);
    painter.paint();
    cairo_surface_flush(surface.get());
    for (std::uint32_t& pixel : image.pixels) pixel &= 0xFFFFFFU;  // the upper byte is undefined
    return image;
}

std::string pdfOf(std::span<const Picture> pages, HatchOf& hatch_of) {
    // Points a unit of a page.
    const auto points = [](const Picture& page) {
        return page.unit() == PageUnit::Millimetre ? 72 / 25.4 : 1;
    };
    std::string bytes;
    const Surface surface(cairo_pdf_surface_create_for_stream(
                              append, &bytes, points(pages.front()) * pages.front().width(),
                              points(pages.front()) * pages.front().height()),
                          cairo_surface_destroy);
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    for (const Picture& page : pages) {
        const double scale = points(page);
        cairo_surface_set_device_scale(surface.get(), 1, 1);
        cairo_pdf_surface_set_size(surface.get(), scale * page.width(), scale * page.height());
        cairo_surface_set_device_scale(surface.get(), scale, scale);
        Painter(page, hatch_of, surface.get()).paint();
        cairo_surface_show_page(surface.get());
    }
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
    return bytes;
}

}  // namespace

}  // namespace ispace

extern "C" __attribute__((visibility("default"))) const ispace::Painting kIspacePainting;
const ispace::Painting kIspacePainting{ispace::widthOf, ispace::pixelsOf, ispace::pdfOf};
