// SPDX-License-Identifier: GPL-3.0-or-later
// Interface between lib/engine/drawing and the module that links Cairo.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drawing/drawing.h"

namespace ispace {

/// Returns the lines of a hatch across the visible part of a shape.
using HatchOf = std::vector<Segment2>(const Hatch& hatch, const Picture& picture,
                                      const DisplayList::Shape& shape);

/// Rows of pixels.
struct Rows {
    int first = 0, beyond = 0;
};

/// Functions of the module. They throw exceptions of the standard library: std::bad_alloc, and
/// others for impossible requests.
struct Painting {
    /// Computes a width in page units. \pre the text is printable
    double (*text_width)(const std::string& text, const TextStyle& style);
    /// Draws these rows of a page; the image has the size of the whole page, its other rows may be
    /// incomplete.
    Image (*pixels)(const Picture& picture, HatchOf& hatch_of, Rows rows);
    /// Draws pages of one document. \pre there is one or more
    std::string (*pdf)(std::span<const Picture> pages, HatchOf& hatch_of);
};
constexpr const char* kPainting = "kIspacePainting";

}  // namespace ispace
