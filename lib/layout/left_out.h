// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "layout/scene.h"

namespace ispace {

/// What a tool does not do yet with a keyword or a key, in one phrase: "`camera` is not simulated
/// yet, left out: c1, c2, c3 and 4 more".
std::string leftOutText(std::string_view name, std::string_view done,
                        const std::vector<std::string>& ids);

/// Such a phrase for each of these keywords that the scene has a record of, with a place or
/// without. \param done what does not become of it: "simulated", "measured" \param is_meant tells
/// of an index in Scene::records whether it counts; all do without it
std::vector<std::string> leftOut(const Scene& scene, std::span<const std::string_view> keywords,
                                 std::string_view done,
                                 const std::function<bool(std::size_t)>& is_meant = {});

}  // namespace ispace
