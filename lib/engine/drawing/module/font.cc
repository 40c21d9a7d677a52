// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/module/font.h"

#include <cairo-ft.h>
#include <ft2build.h>

#include <new>
#include <stdexcept>
#include <string>
#include FT_FREETYPE_H

// The assembler embeds the files, which CMake finds, in the program.
// NOLINTNEXTLINE(hicpp-no-assembler)
asm(R"(
    .pushsection .rodata
    .balign 16
kFontRegular:
    .incbin ")" ISPACE_FONT_REGULAR R"("
kFontRegularEnd:
    .balign 16
kFontBold:
    .incbin ")" ISPACE_FONT_BOLD R"("
kFontBoldEnd:
    .popsection
)");

extern "C" {
extern const FT_Byte kFontRegular[], kFontRegularEnd[];
extern const FT_Byte kFontBold[], kFontBoldEnd[];
}

namespace ispace {

namespace {

void check(FT_Error error) {
    if (error == FT_Err_Ok) return;
    if (error == FT_Err_Out_Of_Memory) throw std::bad_alloc();
    throw std::runtime_error("the font of pictures cannot be used: FreeType error " +
                             std::to_string(error));
}

cairo_font_face_t* loaded(const FT_Byte* begin, const FT_Byte* end) {
    static FT_Library library = [] {
        FT_Library made = nullptr;
        check(FT_Init_FreeType(&made));
        return made;
    }();
    FT_Face face = nullptr;
    check(FT_New_Memory_Face(library, begin, static_cast<FT_Long>(end - begin), 0, &face));
    cairo_font_face_t* made = cairo_ft_font_face_create_for_ft_face(face, 0);
    if (cairo_font_face_status(made) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    return made;
}

}  // namespace

cairo_font_face_t* fontFace(bool bold) {
    // Never destroyed: Cairo's caches refer to them until the process ends.
    static cairo_font_face_t* const regular_face = loaded(kFontRegular, kFontRegularEnd);
    static cairo_font_face_t* const bold_face = loaded(kFontBold, kFontBoldEnd);
    return bold ? bold_face : regular_face;
}

}  // namespace ispace
