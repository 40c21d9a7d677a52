// SPDX-License-Identifier: GPL-3.0-or-later
// The names of layers, blocks and groups in drawings, and what they say of their lines: words of
// two dozen languages, the National CAD Standard (AIA), ISO 13567 and BS 1192.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// True if a list of words holds this one. O(words)
template <typename List>
bool isOneOf(const List& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Lower case of ASCII, Latin, Greek and Cyrillic letters below U+0460 in UTF-8, in any locale;
/// lower case has as many bytes. Other bytes stay.
std::string lowerCased(std::string_view text);

/// Returns true if one of the globs matches the name of a layer; letters match in either case.
bool matchesLayer(const std::vector<std::string>& globs, std::string_view layer);

/// Returns true if a word of the name of a layer, block or group means wall in one of two dozen
/// languages (A-WALL, Außenwände, murs_ext, СТЕНЫ, 墙), and no word means hatching, text, doors or
/// windows of them.
bool isWallName(std::string_view name);

/// Returns true if a word of the name of a layer means furniture, dimensions, text, hatching, axes,
/// stairs, frames of sheets, electrical or plumbing in one of two dozen languages (A-FURN, Möbel,
/// cotas, размеры, 家具), or it is of such a class of ISO 13567 or of another discipline (E-POWR),
/// and it is no isWallName().
bool isNoWallName(std::string_view name);

/// Returns true if a word of the name of a layer means door (A-DOOR, Innentüren, PORTES, 门), or
/// ISO 13567 has it as an element of internal walls, and it is no isNoWallName(): text and
/// hatching of doors.
bool isDoorName(std::string_view name);

/// Returns the same for windows and glazing.
bool isWindowName(std::string_view name);

/// Returns true if the name of a block or group means furniture or a fixture (bed, Sofa_3, 马桶),
/// or isNoWallName().
bool isThingName(std::string_view name);

}  // namespace ispace
