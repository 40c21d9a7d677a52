// SPDX-License-Identifier: GPL-3.0-or-later
// What --storey says.
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// The storeys that a user names: all of them, one as a room by itself, or some as a building.
///
/// A word is the id or the name of a storey, or a pattern of them; case matters in neither if no
/// storey fits exactly. `all` is the pattern `*`.
struct StoreyChoice {
    std::vector<std::string> words = {};  ///< of --storey, in their order; none: all

    [[nodiscard]] bool isEmpty() const { return words.empty(); }
    /// Returns true for the word `all`, in any case.
    [[nodiscard]] static bool isAll(const std::string& word);
    /// Returns true for one word that is no pattern: the room of that storey is meant, with ids
    /// without a prefix.
    [[nodiscard]] bool isOne() const;
    /// Returns the word of isOne(), else "".
    [[nodiscard]] std::string one() const { return isOne() ? words.front() : std::string(); }
};

}  // namespace ispace
