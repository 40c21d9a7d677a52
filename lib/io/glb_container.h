// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ispace {

/// The two chunks of a binary glTF 2.0 file that matter.
struct GlbChunks {
    std::string_view json;    ///< never empty
    std::string_view binary;  ///< empty if there is none
};

/// Takes the container apart; every length is checked against what is there. The parts point into
/// `bytes`. \throws FormatError \pre isGlb(bytes)
GlbChunks glbChunks(std::string_view bytes, const std::string& name);

/// Writes the container: JSON, and the parts one after another as its binary data.
/// \throws FormatError for more than 2 GiB, which some readers take for a negative length
std::string glbContainer(std::string_view json, std::span<const std::string_view> parts);

}  // namespace ispace
