// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/dxf_shapes.h"
#include "io/import_options.h"

namespace ispace {

/// What a drawing in SVG shows.
struct SvgDrawing {
    std::vector<PlanShape> shapes;
    std::string scale;                            ///< what a unit is, and why, for a note
    std::map<std::string, std::size_t> left_out;  ///< elements, by what they are
};

/// The shapes of the drawing in metres, see readSvg. \throws FormatError with the line
SvgDrawing readSvgShapes(std::string_view bytes, const std::string& name,
                         const ImportOptions& options);

}  // namespace ispace
