// SPDX-License-Identifier: GPL-3.0-or-later
// The value of --size, wherever a tool draws a picture.
#pragma once

#include <string>

namespace ispace {

/// Columns and rows of a picture.
struct PictureSize {
    int columns = 1280, rows = 960;
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// Parses `N` or `W,H`, each side from 16 to 16384 pixels; rows are 0 for N. \throws UsageError
PictureSize pictureSize(const std::string& text);

}  // namespace ispace
