// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/axis.h"

#include <cmath>

#include "base/number.h"
#include "draw/palette.h"

namespace ispace {

double roundStep(double least) {
    const double power = std::pow(10, std::floor(std::log10(least)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= least * (1 - 1e-9)) return digit * power;
    return 10 * power;
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
