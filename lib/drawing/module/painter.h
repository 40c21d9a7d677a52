// SPDX-License-Identifier: GPL-3.0-or-later
// What lib/drawing and the module that links Cairo say to each other.
#pragma once

#include <string>
#include <vector>

#include "drawing/drawing.h"

namespace ispace {

/// The lines of a hatch across what shows of a shape.
using HatchOf = std::vector<Segment2>(const Hatch& hatch, const Picture& picture,
                                      const DisplayList::Shape& shape);

/// Rows of pixels.
struct Rows {
    int first = 0, beyond = 0;
};

/// The functions of the module. They throw what the standard library has: std::bad_alloc, and
/// others for what cannot be.
struct Painting {
    /// \pre the text is printable
    double (*text_width)(const std::string& text, const TextStyle& style);
    /// Of the whole page, of which these rows are drawn and others may be in part.
    Image (*pixels)(const Picture& picture, HatchOf& hatch_of, Rows rows);
    std::string (*pdf)(const Picture& picture, HatchOf& hatch_of);
};
constexpr const char* kPainting = "kIspacePainting";

}  // namespace ispace
