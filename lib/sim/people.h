// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/sim only.
#pragma once

#include <string_view>
#include <vector>

#include "layout/scene.h"

namespace ispace {

/// Somebody who stands in the way: a circle on the floor that no robot may reach into.
struct Person {
    std::string_view id;
    Point2 place;
    double radius = 0;  ///< humanRadius
};

/// The people of a scene, in its order. The scene must outlive them.
std::vector<Person> peopleOf(const Scene& scene);

}  // namespace ispace
