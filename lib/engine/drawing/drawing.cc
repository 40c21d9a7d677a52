// SPDX-License-Identifier: GPL-3.0-or-later
// Stores the shapes of pictures, in page units: views are applied when a shape is added, so that
// writers read numbers of the page alone.
#include "drawing/drawing.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "drawing/color.h"

namespace ispace {

namespace {

using Kind = DisplayList::Kind;

std::uint32_t index(std::size_t size) { return static_cast<std::uint32_t>(size); }

}  // namespace

Picture::Picture(double width, double height, PageUnit unit)
    : width_(width), height_(height), unit_(unit) {
    if (!(width >= 1 && width <= kMaxSide && height >= 1 && height <= kMaxSide))
        throw UsageError("a picture of " + formatFixed(width, 0) + " x " + formatFixed(height, 0) +
                         " cannot be drawn, wanted 1 to " + formatFixed(kMaxSide, 0) + " each way");
}

void Picture::describe(std::string title, std::string description) {
    title_ = std::move(title);
    description_ = std::move(description);
}

void Picture::pushView(const PageView& view) {
    views_.push_back(view);
    pushed_.push_back(Pushed::View);
}

void Picture::pushClip(std::span<const Polygon> inside) {
    // An empty clip hides all shapes.
    const Polygon nowhere = {{-1, -1}};
    push(Kind::Group, {}, inside.empty() ? std::span(&nowhere, 1) : inside);
}

void Picture::pushLayer(std::string_view name, std::span<const Polygon> clip) {
    push(Kind::Layer, {"", std::string(name)}, clip);
}

void Picture::pushGroup(std::string_view id, std::string_view title) {
    push(Kind::Group, {std::string(id), std::string(title)}, {});
}

void Picture::push(Kind kind, DisplayList::Name name, std::span<const Polygon> clip) {
    add(kind, add(clip), {});
    list_.names.push_back(std::move(name));
    pushed_.push_back(Pushed::Mark);
}

void Picture::pop() {
    assert(!pushed_.empty());
    const Pushed last = pushed_.back();
    pushed_.pop_back();
    if (last == Pushed::View) {
        views_.pop_back();
        return;
    }
    const Kind kind = list_.shapes.back().kind;
    const bool is_empty = kind == Kind::Layer || kind == Kind::Group;
    if (is_empty && (kind == Kind::Layer || list_.names.back().id.empty())) {
        list_.shapes.pop_back();
        list_.names.pop_back();
    } else {
        add(Kind::End, {}, {});
    }
}

Point2 Picture::toPage(Point2 p) const {
    // Cairo counts in 24.8 fixed point: points far off the page are moved towards it.
    constexpr double kFar = 1e6;
    const Point2 page = views_.empty() ? p : views_.back() * p;
    return {std::clamp(page.x, -kFar, kFar), std::clamp(page.y, -kFar, kFar)};
}

std::pair<std::uint32_t, std::uint32_t> Picture::add(std::span<const Polygon> curves) {
    const std::uint32_t first = index(list_.ends.size() - 1);
    for (const Polygon& curve : curves) {
        if (curve.empty()) continue;
        for (const Point2 p : curve) list_.points.push_back(toPage(p));
        list_.ends.push_back(index(list_.points.size()));
    }
    return {first, index(list_.ends.size() - 1)};
}

void Picture::add(Kind kind, std::pair<std::uint32_t, std::uint32_t> range, Inks inks) {
    // Adjacent shapes mostly have equal styles.
    const std::size_t known = list_.inks.size();
    const bool again = inks.size() <= known &&
                       std::equal(inks.begin(), inks.end(),
                                  list_.inks.end() - static_cast<std::ptrdiff_t>(inks.size()));
    if (!again) list_.inks.insert(list_.inks.end(), inks.begin(), inks.end());
    const std::uint32_t first_ink = index(list_.inks.size() - inks.size());
    list_.shapes.push_back(
        {kind, range.first, range.second, first_ink, first_ink + index(inks.size())});
}

void Picture::area(std::span<const Polygon> curves, Inks inks) {
    if (const auto range = add(curves); range.first < range.second) add(Kind::Area, range, inks);
}

void Picture::lines(std::span<const std::vector<Point2>> chains, Inks inks) {
    if (const auto range = add(chains); range.first < range.second) add(Kind::Lines, range, inks);
}

void Picture::lines(std::span<const Segment2> segments, Inks inks) {
    if (segments.empty()) return;
    const std::uint32_t first = index(list_.ends.size() - 1);
    const Segment2* previous = nullptr;
    for (const Segment2& segment : segments) {
        if (previous == nullptr || !(previous->b == segment.a)) {
            if (previous != nullptr) list_.ends.push_back(index(list_.points.size()));
            list_.points.push_back(toPage(segment.a));
        }
        list_.points.push_back(toPage(segment.b));
        previous = &segment;
    }
    list_.ends.push_back(index(list_.points.size()));
    add(Kind::Lines, {first, index(list_.ends.size() - 1)}, inks);
}

void Picture::line(Point2 a, Point2 b, const Stroke& stroke) {
    const Segment2 segment{a, b};
    lines(std::span(&segment, 1), {stroke});
}

void Picture::circle(Point2 center, double radius, Inks inks) {
    addArc({toPage(center), toPage(radius), Angle(), Angle::degrees(360)}, inks);
}

void Picture::sector(Point2 center, double radius, Angle from, Angle to, Inks inks) {
    addArc({toPage(center), toPage(radius), from, to}, inks);
}

void Picture::addArc(const DisplayList::Arc& arc, Inks inks) {
    list_.arcs.push_back(arc);
    list_.arcs.back().radius = std::min(arc.radius, 1e6);
    add(Kind::Arc, {index(list_.arcs.size() - 1), 0}, inks);
}

void Picture::image(Point2 corner, Image image, double pixel_width, double pixel_height) {
    if (image.width < 1 || image.height < 1) return;
    list_.images.push_back(
        {toPage(corner), std::move(image), toPage(pixel_width), toPage(pixel_height)});
    add(Kind::Image, {index(list_.images.size() - 1), 0}, {});
}

void Picture::text(Point2 anchor, std::string_view text, const TextStyle& style) {
    if (text.empty()) return;
    list_.texts.push_back({toPage(anchor), printable(text), style});
    add(Kind::Text, {index(list_.texts.size() - 1), 0}, {});
}

namespace {

/// Scales a line with its dashes.
Stroke scaled(Stroke stroke, double scale) {
    stroke.width *= scale;
    for (double& dash : stroke.dashes) dash *= scale;
    return stroke;
}

Ink scaled(const Ink& ink, double scale) {
    if (const auto* stroke = std::get_if<Stroke>(&ink)) return scaled(*stroke, scale);
    if (const auto* hatch = std::get_if<Hatch>(&ink)) {
        Hatch lines = *hatch;
        lines.spacing = std::max(0.5, lines.spacing * scale);
        lines.width *= scale;
        lines.offset *= scale;
        return lines;
    }
    return ink;
}

}  // namespace

/// Appends the other's lists and shifts the indices of its shapes behind those that are here.
void Picture::inset(const Picture& other, Point2 corner, double scale) {
    const DisplayList& from = other.list_;
    const auto at = [&](Point2 p) {
        return Point2{corner.x + scale * p.x, corner.y + scale * p.y};
    };
    const std::uint32_t curves = index(list_.ends.size() - 1), points = index(list_.points.size());
    const std::uint32_t inks = index(list_.inks.size()), arcs = index(list_.arcs.size());
    const std::uint32_t texts = index(list_.texts.size()), images = index(list_.images.size());
    for (const Point2 p : from.points) list_.points.push_back(at(p));
    for (std::size_t i = 1; i < from.ends.size(); ++i) list_.ends.push_back(points + from.ends[i]);
    for (const Ink& ink : from.inks) list_.inks.push_back(scaled(ink, scale));
    for (DisplayList::Arc arc : from.arcs) {
        arc.center = at(arc.center);
        arc.radius *= scale;
        list_.arcs.push_back(arc);
    }
    for (DisplayList::Text text : from.texts) {
        text.anchor = at(text.anchor);
        text.style.size *= scale;
        list_.texts.push_back(std::move(text));
    }
    for (DisplayList::Raster raster : from.images) {
        raster.corner = at(raster.corner);
        raster.pixel_width *= scale;
        raster.pixel_height *= scale;
        list_.images.push_back(std::move(raster));
    }
    for (DisplayList::Shape shape : from.shapes) {
        if (shape.kind == Kind::Layer) shape.kind = Kind::Group;
        if (shape.kind == Kind::Group) list_.names.emplace_back();
        const std::uint32_t offset = shape.kind == Kind::Text    ? texts
                                     : shape.kind == Kind::Image ? images
                                     : shape.kind == Kind::Arc   ? arcs
                                                                 : curves;
        shape.first += offset;
        shape.last += offset;
        shape.first_ink += inks;
        shape.last_ink += inks;
        list_.shapes.push_back(shape);
    }
}

std::string Picture::write(PictureFormat format) const {
    assert(pushed_.empty());
    switch (format) {
        case PictureFormat::Svg:
            return writeSvg(*this);
        case PictureFormat::Pdf:
            return writePdf(std::span(this, 1));
        case PictureFormat::Png:
            break;
    }
    return writePng(*this);
}

std::vector<Segment2> hatchLines(const Hatch& hatch, const Box2& box) {
    std::vector<Segment2> lines;
    if (box.empty()) return lines;
    const Vec2 seen = unitVector(hatch.direction);
    const Vec2 along{seen.x, -seen.y}, left_of{-seen.y, -seen.x};
    const double reach = std::hypot(box.width(), box.depth()) / 2 + hatch.width;
    const double spacing = std::max(hatch.spacing, 0.5);
    const Vec2 middle = box.center() - Point2{};
    const double at = dot(left_of, middle), begin = dot(along, middle);
    const auto number = [&](double place) { return (place - hatch.offset) / spacing; };
    const double last = std::floor(number(at + reach));
    for (double k = std::ceil(number(at - reach)); k <= last; ++k) {
        const Point2 foot = Point2{} + (k * spacing + hatch.offset) * left_of;
        lines.push_back({foot + (begin - reach) * along, foot + (begin + reach) * along});
    }
    return lines;
}

Box2 visibleBox(const Picture& picture, const DisplayList::Shape& shape) {
    Box2 box;
    for (std::uint32_t i = shape.first; i < shape.last; ++i)
        for (const Point2 p : picture.list().curve(i))
            box.add(
                {std::clamp(p.x, 0.0, picture.width()), std::clamp(p.y, 0.0, picture.height())});
    return box;
}

std::string fitText(std::string_view text, double width, const TextStyle& style) {
    std::string clean = printable(text);
    if (textWidth(clean, style) <= width) return clean;
    std::vector<std::size_t> ends = {0};  // of each character
    while (ends.back() < clean.size())
        ends.push_back(ends.back() + utf8Length(std::string_view(clean).substr(ends.back())));
    const auto shortened = [&clean, &ends](std::size_t characters) {
        return clean.substr(0, ends[characters]) + "…";
    };
    std::size_t fits = 0, too_long = ends.size() - 1;
    while (too_long - fits > 1) {
        const std::size_t middle = fits + (too_long - fits) / 2;
        (textWidth(shortened(middle), style) <= width ? fits : too_long) = middle;
    }
    return shortened(fits);
}

double roundStep(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= least * (1 - 1e-9)) return digit * power;
    return 10 * power;
}

double usualScale(double least) {
    for (double power = 1;; power *= 10)
        for (const double digit : {1.0, 2.0, 2.5, 5.0})
            if (const double scale = digit * power; scale >= least && scale == std::floor(scale))
                return scale;
}

void drawScaleBar(Picture& picture, Point2 corner, double most, double page_per_metre, double em,
                  const std::string& more) {
    using namespace palette;
    const double limit = most / page_per_metre;
    const double power = std::pow(10, std::floor(std::log10(limit)));
    const double digit = limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1;
    const int pieces = digit == 5 ? 5 : 4;
    const double piece = digit * power * page_per_metre / pieces, thick = 0.32 * em;
    picture.pushGroup("", "bar of scale");
    for (int i = 0; i < pieces; ++i) {
        const double x = corner.x + i * piece, top = corner.y - thick;
        picture.area(Polygon{{x, corner.y}, {x + piece, corner.y}, {x + piece, top}, {x, top}},
                     {i % 2 == 0 ? kInk : kWhite, Stroke{kInk, 0.05 * em}});
    }
    const std::string metres = formatDouble(std::round(digit * power * 1e9) / 1e9) + " m";
    picture.text({corner.x + pieces * piece + 0.6 * em, corner.y + 0.05 * em}, metres + more,
                 {em, false, Align::Left, kInk, {}});
    picture.pop();
}

}  // namespace ispace
