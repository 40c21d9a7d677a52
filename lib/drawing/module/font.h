// SPDX-License-Identifier: GPL-3.0-or-later
// The font of pictures; for the module only.
#pragma once

struct _cairo_font_face;  // NOLINT(bugprone-reserved-identifier): Cairo's cairo_font_face_t

namespace ispace {

/// DejaVu Sans, regular or bold. The faces are part of the program, so that text has the same
/// shapes and lengths on every machine, whatever fonts are installed there and however they are
/// configured. The face lives as long as the process. \throws std::runtime_error if FreeType cannot
/// read it; std::bad_alloc
_cairo_font_face* fontFace(bool bold);

}  // namespace ispace
