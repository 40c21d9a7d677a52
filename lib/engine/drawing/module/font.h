// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the module: the font of pictures.
#pragma once

struct _cairo_font_face;  // NOLINT(bugprone-reserved-identifier): Cairo's cairo_font_face_t

namespace ispace {

/// Returns DejaVu Sans, regular or bold. The faces are embedded, so that text has the same shapes
/// and widths on every machine, independent of its installed fonts and their configuration. The
/// face lives as long as the process. \throws std::runtime_error if FreeType cannot read it;
/// std::bad_alloc
_cairo_font_face* fontFace(bool bold);

}  // namespace ispace
