// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/electronic_tag.h"

#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "env/body.h"
#include "env/body_shapes.h"
#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

/// Numbers of people among those of a room, by their ids.
class PersonNumbers {
  public:
    explicit PersonNumbers(const RoomRecords& room) : room_(room) {}
    /// Returns the number past all people for an unknown one.
    std::size_t operator()(const std::string& id) {
        if (numbers_.empty())
            for (std::size_t i = 0; i < room_.records.size(); ++i)
                if (room_.records[i].keyword() == "human")
                    numbers_.emplace(room_.ids[i], numbers_.size());
        const auto found = numbers_.find(id);
        return found == numbers_.end() ? numbers_.size() : found->second;
    }

  private:
    const RoomRecords& room_;
    std::unordered_map<std::string_view, std::size_t> numbers_;
};

std::vector<ElectronicTag> tagsOf(const RoomRecords& room) {
    using Carrier = ElectronicTag::Carrier;
    constexpr double kAbove = 0.01;  // a tag lies on a thing, not in its surface
    std::vector<ElectronicTag> tags;
    PersonNumbers number_of(room);
    std::size_t robots = 0, people = 0;
    for (const Record& record : room.records) {
        const bool is_robot = record.keyword() == "robot", is_person = record.keyword() == "human";
        const std::size_t mover = is_robot ? robots++ : is_person ? people++ : 0;
        if (record.schema().find("tag") == nullptr || !record.has("tag")) continue;
        ElectronicTag tag{record.text("tag"),
                          is_robot    ? Carrier::Robot
                          : is_person ? Carrier::Person
                                      : Carrier::Thing,
                          mover,
                          {},
                          false};
        if (const std::string person = personWith(record); !person.empty()) {
            tag.carrier = Carrier::Person;
            tag.mover = number_of(person);
            tag.is_in_hand = true;
        }
        if (tag.carrier == Carrier::Thing) {
            const Tuple& at = record.tuple("at");
            tag.at = {at[0], at[1], topOf(bodyOf(record)) + kAbove};
        }
        tags.push_back(std::move(tag));
    }
    return tags;
}

}  // namespace

SharedList<ElectronicTag> sharedTags(const RoomRecords& room) {
    return room.shared<ElectronicTag>([&room] { return tagsOf(room); });
}

}  // namespace ispace
