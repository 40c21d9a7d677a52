// SPDX-License-Identifier: GPL-3.0-or-later
// Parses attributes of SVG by its grammar (SVG 2, chapters 8 and 9). Arcs become centre form by
// appendix B.2.4; radii that are too small grow, as B.2.5 demands. Smooth curves mirror the control
// point before them.
#include "extensions/cad/svg.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/message.h"

namespace ispace::cad {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMaxSvgNumber = 1e12;  // of any number: drawings end far below
constexpr double kPixel = 0.0254 / 96;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Parses numbers, which may follow each other without blanks: `1.5.5-3`.
class Scanner {
  public:
    explicit Scanner(std::string_view text) : rest_(text) {}

    void skipBlanks() {
        while (!rest_.empty() && isBlank(rest_.front())) rest_.remove_prefix(1);
    }
    /// Blanks and one comma.
    void skipComma() {
        skipBlanks();
        if (!rest_.empty() && rest_.front() == ',') rest_.remove_prefix(1);
        skipBlanks();
    }
    [[nodiscard]] bool atEnd() const { return rest_.empty(); }
    [[nodiscard]] bool atLetter() const { return !rest_.empty() && isLetter(rest_.front()); }

    char letter() {
        const char c = rest_.front();
        rest_.remove_prefix(1);
        return c;
    }
    std::string_view word() {
        std::size_t size = 0;
        while (size < rest_.size() && isLetter(rest_[size])) ++size;
        const std::string_view word = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return word;
    }
    bool take(char c) {
        if (rest_.empty() || rest_.front() != c) return false;
        rest_.remove_prefix(1);
        return true;
    }

    double number() {
        const bool plus = rest_.size() > 1 && rest_[0] == '+' && rest_[1] != '-';
        const char* const begin = rest_.data() + (plus ? 1 : 0);
        double value = 0;
        const auto [end, error] = std::from_chars(begin, rest_.data() + rest_.size(), value);
        if (error != std::errc() || !(std::abs(value) <= kMaxSvgNumber)) fail("a number");
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }
    bool flag() {
        if (take('0')) return false;
        if (!take('1')) fail("a flag, 0 or 1");
        return true;
    }
    [[noreturn]] void fail(const std::string& wanted) const {
        throw SvgError((rest_.empty() ? std::string("it ends early")
                                      : "found " + excerpt(rest_.substr(0, 12))) +
                       ", wanted " + wanted);
    }

  private:
    std::string_view rest_;
};

double angleOf(Vec2 v) { return std::atan2(v.y, v.x); }

/// Computes the centre of an arc from its ends, as in appendix B.2.4 of SVG 2.
SvgPiece arcBetween(Point2 from, Point2 to, double rx, double ry, double degrees, bool large,
                    bool positive) {
    rx = std::abs(rx), ry = std::abs(ry);
    if (rx == 0 || ry == 0 || from == to) return SvgLine{to};
    const double turn = std::fmod(degrees, 360) * kPi / 180;
    const Vec2 x{std::cos(turn), std::sin(turn)}, y = perpendicular(x);
    const Vec2 half = 0.5 * (from - to);
    // In coordinates where the ellipse is a circle of radius 1.
    Vec2 unit{dot(half, x) / rx, dot(half, y) / ry};
    const double apart = length(unit);
    if (apart > 1) {
        rx *= apart, ry *= apart;
        unit = (1 / apart) * unit;
    }
    const double aside = std::sqrt(std::max(0.0, 1 - dot(unit, unit))) / length(unit);
    const Vec2 center = (large == positive ? -aside : aside) * Vec2{unit.y, -unit.x};
    const double begin = angleOf(unit - center), end = angleOf(-1.0 * unit - center);
    double sweep = end - begin;
    if (positive && sweep < 0) sweep += 2 * kPi;
    if (!positive && sweep > 0) sweep -= 2 * kPi;
    const Point2 middle = to + half + (center.x * rx) * x + (center.y * ry) * y;
    return SvgArc{middle, rx * x, ry * y, begin, sweep, to};
}

class PathParser {
  public:
    explicit PathParser(std::string_view data) : scan_(data) {}

    std::vector<SvgSubpath> parse() {
        scan_.skipBlanks();
        while (!scan_.atEnd()) {
            if (!scan_.atLetter()) scan_.fail("a command");
            const char letter = scan_.letter();
            relative_ = letter >= 'a';
            command_ = relative_ ? static_cast<char>(letter - 'a' + 'A') : letter;
            if (std::string_view("MLHVCSQTAZ").find(command_) == std::string_view::npos)
                throw SvgError("unknown command " + excerpt(std::string_view(&letter, 1)));
            if (paths_.empty() && command_ != 'M') throw SvgError("it does not begin with M");
            readCommand();
        }
        std::erase_if(paths_, [](const SvgSubpath& path) { return path.pieces.empty(); });
        return std::move(paths_);
    }

  private:
    /// One command letter serves all of its arguments.
    void readCommand() {
        scan_.skipBlanks();
        if (command_ == 'Z') return close();
        do {
            readArguments();
            scan_.skipComma();
        } while (!scan_.atEnd() && !scan_.atLetter());
    }

    double number() {
        scan_.skipComma();
        return scan_.number();
    }
    Point2 point() {
        const double x = number(), y = number();
        return relative_ ? Point2{at_.x + x, at_.y + y} : Point2{x, y};
    }

    void readArguments() {
        switch (command_) {
            case 'M':
                at_ = point();
                paths_.push_back({at_, {}, false});
                command_ = 'L';  // further pairs are lines
                control_ = at_;
                return;
            case 'L':
                return add(SvgLine{point()}, 'L');
            case 'H':
                return add(SvgLine{{number() + (relative_ ? at_.x : 0), at_.y}}, 'L');
            case 'V':
                return add(SvgLine{{at_.x, number() + (relative_ ? at_.y : 0)}}, 'L');
            case 'C':
            case 'S':
                return addCubic();
            case 'Q':
            case 'T':
                return addQuadratic();
            default:
                return addArc();
        }
    }

    /// Returns the control point mirrored at the current point, after a curve of the same kind.
    [[nodiscard]] Point2 mirrored(char kind) const {
        return last_ == kind ? at_ + (at_ - control_) : at_;
    }

    void addCubic() {
        const Point2 first = command_ == 'C' ? point() : mirrored('C');
        const Point2 second = point();
        add(SvgCubic{first, second, point()}, 'C');
        control_ = second;
    }
    void addQuadratic() {
        const Point2 control = command_ == 'Q' ? point() : mirrored('Q');
        const Point2 from = at_, to = point();
        add(SvgCubic{from + 2.0 / 3 * (control - from), to + 2.0 / 3 * (control - to), to}, 'Q');
        control_ = control;
    }
    void addArc() {
        const double rx = number(), ry = number(), degrees = number();
        scan_.skipComma();
        const bool large = scan_.flag();
        scan_.skipComma();
        const bool positive = scan_.flag();
        const Point2 from = at_, to = point();
        add(arcBetween(from, to, rx, ry, degrees, large, positive), 'A');
    }

    void add(const SvgPiece& piece, char kind) {
        // Behind a Z without M a new path begins where the last one began.
        if (paths_.back().closed) paths_.push_back({at_, {}, false});
        at_ = std::visit([](const auto& p) { return p.to; }, piece);
        paths_.back().pieces.push_back(piece);
        last_ = kind;
    }

    void close() {
        paths_.back().closed = true;
        at_ = paths_.back().start;
        last_ = 'Z';
        scan_.skipBlanks();
    }

    Scanner scan_;
    std::vector<SvgSubpath> paths_;
    char command_ = 0, last_ = 0;
    bool relative_ = false;
    Point2 at_, control_;
};

Affine affineOf(std::string_view kind, const std::vector<double>& v) {
    const auto want = [&](std::initializer_list<std::size_t> counts) {
        if (std::find(counts.begin(), counts.end(), v.size()) == counts.end())
            throw SvgError(std::string(kind) + " with " + std::to_string(v.size()) + " numbers");
    };
    const auto shift = [](double x, double y) { return Affine{{1, 0}, {0, 1}, {x, y}}; };
    if (kind == "matrix") {
        want({6});
        return {{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}};
    }
    if (kind == "translate") {
        want({1, 2});
        return shift(v[0], v.size() > 1 ? v[1] : 0);
    }
    if (kind == "scale") {
        want({1, 2});
        return {{v[0], 0}, {0, v.back()}, {}};
    }
    if (kind == "rotate") {
        want({1, 3});
        const Vec2 x = unitVector(Angle::degrees(v[0]));
        const Affine turn{x, perpendicular(x), {}};
        return v.size() == 1 ? turn : shift(v[1], v[2]) * turn * shift(-v[1], -v[2]);
    }
    want({1});
    const double slope = std::tan(std::fmod(v[0], 180) * kPi / 180);
    if (kind == "skewX") return {{1, 0}, {slope, 1}, {}};
    if (kind == "skewY") return {{1, slope}, {0, 1}, {}};
    throw SvgError("unknown transform " + excerpt(kind));
}

}  // namespace

std::vector<SvgSubpath> parseSvgPath(std::string_view data) { return PathParser(data).parse(); }

std::vector<double> parseSvgNumbers(std::string_view text) {
    std::vector<double> numbers;
    Scanner scan(text);
    scan.skipBlanks();
    while (!scan.atEnd()) {
        numbers.push_back(scan.number());
        scan.skipComma();
    }
    return numbers;
}

Affine parseSvgTransform(std::string_view text) {
    Affine all;
    Scanner scan(text);
    scan.skipComma();
    while (!scan.atEnd()) {
        const std::string_view kind = scan.word();
        scan.skipBlanks();
        if (kind.empty() || !scan.take('(')) scan.fail("a transform");
        std::vector<double> numbers;
        for (scan.skipBlanks(); !scan.take(')'); scan.skipComma()) numbers.push_back(scan.number());
        all = all * affineOf(kind, numbers);
        scan.skipComma();
    }
    return all;
}

std::optional<double> parseSvgMetres(std::string_view text) {
    constexpr std::pair<std::string_view, double> kUnits[] = {
        {"", kPixel},   {"px", kPixel},      {"mm", 0.001},      {"cm", 0.01},
        {"in", 0.0254}, {"pt", 0.0254 / 72}, {"pc", 0.0254 / 6}, {"Q", 0.00025}};
    Scanner scan(text);
    scan.skipBlanks();
    const double value = scan.number();
    const std::string_view unit = scan.word();
    scan.skipBlanks();
    for (const auto& [name, metres] : kUnits)
        if (unit == name && scan.atEnd()) return value * metres;
    return std::nullopt;
}

bool isSvgPhysical(std::string_view length) {
    length = trimmed(length);
    const bool has_unit =
        !length.empty() && std::isalpha(static_cast<unsigned char>(length.back()));
    return has_unit && !length.ends_with("px");
}

SvgSubpath svgEllipse(Point2 center, double radius_x, double radius_y) {
    const Point2 start{center.x + radius_x, center.y};
    return {start, {SvgArc{center, {radius_x, 0}, {0, radius_y}, 0, 2 * kPi, start}}, true};
}

SvgSubpath svgRectangle(Point2 corner, double width, double height, double radius_x,
                        double radius_y) {
    const double rx = std::min(radius_x, width / 2), ry = std::min(radius_y, height / 2);
    const double left = corner.x, top = corner.y, right = left + width, bottom = top + height;
    SvgSubpath path{{left + rx, top}, {}, true};
    const bool round = rx > 0 && ry > 0;
    const auto side = [&](Point2 to, Point2 center, double from, Point2 behind) {
        path.pieces.emplace_back(SvgLine{to});
        if (round)
            path.pieces.emplace_back(SvgArc{center, {rx, 0}, {0, ry}, from, kPi / 2, behind});
    };
    if (!round) path.start = corner;
    const double x = round ? rx : 0, y = round ? ry : 0;
    side({right - x, top}, {right - x, top + y}, -kPi / 2, {right, top + y});
    side({right, bottom - y}, {right - x, bottom - y}, 0, {right - x, bottom});
    side({left + x, bottom}, {left + x, bottom - y}, kPi / 2, {left, bottom - y});
    side({left, top + y}, {left + x, top + y}, kPi, {left + x, top});
    return path;
}

}  // namespace ispace::cad
