// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "draw/picture.h"

namespace ispace {

/// 1, 2 or 5 times a power of ten, at least `least`. \pre least > 0
double roundStep(double least);

/// A bar of round length in black and white pieces, at most `most` page units long, with its length
/// and what else is to be said; `corner` is its lower left end on the page, `em` the size of text.
void drawScaleBar(Picture& picture, Point2 corner, double most, double page_per_metre, double em,
                  const std::string& more = "");

}  // namespace ispace
