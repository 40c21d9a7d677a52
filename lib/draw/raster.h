// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draw/picture.h"

namespace ispace {

/// The pixels that write(PictureFormat::Png) encodes, for films. \pre every push has its pop
Image rasterOf(const Picture& picture);

}  // namespace ispace
