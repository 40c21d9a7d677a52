// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/people.h"

#include "layout/figures.h"

namespace ispace {

std::vector<Person> peopleOf(const Scene& scene) {
    std::vector<Person> people;
    for (const Placed& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.keyword() != "human") continue;
        people.push_back({scene.ids[placed.record], placed.pose.position.onFloor(),
                          humanRadius(record.number("height"))});
    }
    return people;
}

}  // namespace ispace
