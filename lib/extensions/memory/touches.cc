// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes lie in a grid on the floor with the reach of the largest one: a look-up is O(volumes
// near), and a huge volume makes all look-ups slower. A stay that ends is as long as its positions
// were inside, without the hold.
#include "extensions/memory/touches.h"

#include <algorithm>
#include <tuple>

namespace ispace::memory {

bool VolumeIndex::store(Volume volume) {
    const auto known = volumes_.find(volume.id);
    if (known == volumes_.end() && volumes_.size() >= kMost) return false;
    std::string id = volume.id;
    volumes_.insert_or_assign(std::move(id), std::move(volume));
    is_known_ = false;
    return true;
}

bool VolumeIndex::forget(std::string_view id) {
    const auto found = volumes_.find(id);
    if (found == volumes_.end()) return false;
    volumes_.erase(found);
    is_known_ = false;
    return true;
}

const Volume* VolumeIndex::find(std::string_view id) const {
    const auto found = volumes_.find(id);
    return found == volumes_.end() ? nullptr : &found->second;
}

std::vector<const Volume*> VolumeIndex::about(std::size_t room, Point3 point) const {
    if (!is_known_) {
        rooms_.clear();
        for (const auto& [id, volume] : volumes_) {
            if (rooms_.size() <= volume.room) rooms_.resize(volume.room + 1);
            rooms_[volume.room].volumes.push_back(&volume);
        }
        for (Room& each : rooms_) {
            std::vector<Point2> places;
            places.reserve(each.volumes.size());
            double reach = 0;
            for (const Volume* const volume : each.volumes) {
                places.push_back(volume->at.onFloor());
                reach = std::max(reach, volume->reach());
            }
            each.grid.rebuild(places, reach);
        }
        is_known_ = true;
    }
    std::vector<const Volume*> found;
    if (room >= rooms_.size()) return found;
    Box2 box;
    box.add(point.onFloor());
    rooms_[room].grid.forEachNear(box, [&](std::size_t i) {
        if (rooms_[room].volumes[i]->contains(point)) found.push_back(rooms_[room].volumes[i]);
    });
    std::sort(found.begin(), found.end(), [&](const Volume* a, const Volume* b) {
        return std::tuple(length(a->at - point), std::string_view(a->id)) <
               std::tuple(length(b->at - point), std::string_view(b->id));
    });
    return found;
}

std::vector<Touch> Touches::moved(const std::string& tag, const std::vector<const Volume*>& inside,
                                  SimTime now) {
    std::vector<Touch> done;
    for (const Volume* const volume : inside) {
        const auto [stay, is_new] = stays_.try_emplace({tag, volume->id}, Stay{now, now});
        if (is_new) done.push_back({Touch::Kind::Touch, now, volume->id, tag, SimTime(0)});
        stay->second.inside = now;
        const SimTime lasted = now - stay->second.begun;
        if (stay->second.is_long || lasted < simSeconds(volume->dwell)) continue;
        stay->second.is_long = true;
        done.push_back({Touch::Kind::Dwell, now, volume->id, tag, lasted});
    }
    return done;
}

std::vector<Touch> Touches::passed(SimTime now) {
    std::vector<Touch> done;
    for (auto each = stays_.begin(); each != stays_.end();) {
        const auto& [key, stay] = *each;
        if (now - stay.inside < kHold) {
            ++each;
            continue;
        }
        done.push_back({Touch::Kind::Leave, now, key.second, key.first, stay.inside - stay.begun});
        each = stays_.erase(each);
    }
    return done;
}

std::vector<std::string> Touches::tagsIn(std::string_view volume) const {
    std::vector<std::string> tags;
    for (const auto& [key, stay] : stays_)
        if (key.second == volume) tags.push_back(key.first);
    return tags;
}

}  // namespace ispace::memory
