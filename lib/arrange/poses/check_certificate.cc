// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numbers>
#include <utility>

#include "arrange/poses/box_sums.h"
#include "arrange/poses/certificate.h"
#include "arrange/poses/pose_search.h"
#include "base/error.h"

namespace ispace {

namespace {

using poses::BoxCore;
using poses::BoxView;
using poses::BoxViews;
using poses::CheckedBox;
using poses::PoseBox;
using poses::Sector;

using Boxes = std::array<std::uint32_t, kMostPosed>;

/// A floor in fine cells, and in large ones, which suffice for most tuples.
struct Floors {
    const BoxViews& fine;
    const BoxViews& large;
};

class CertificateChecker {
  public:
    CertificateChecker(const Floors& floors, const Sector& sector, int sensors, int times,
                       const PoseCertificate& certificate, const std::string& name)
        : floors_(floors),
          sector_(sector),
          count_(static_cast<std::size_t>(sensors)),
          times_(static_cast<std::size_t>(times)),
          certificate_(certificate),
          name_(name) {}

    CertificateCheck check();

  private:
    /// Boxes of several sensors, in the order of the tree of boxes.
    struct Group {
        Boxes boxes{};
        std::uint32_t end = 0;  // of its subtree; the next group is its first half
        double most = 0;
        bool is_whole = false;
    };

    [[noreturn]] void refuse(const std::string& message) const {
        throw FormatError({name_, 0, 0, message});
    }
    char nextOf(const std::string& tree, std::size_t& at, const char* name) const;
    void readBox(const PoseBox& box, int depth);
    void readGroup(const std::string& tree, std::size_t& at, const char* name, Boxes boxes,
                   std::size_t size, std::vector<Group>& groups);
    [[nodiscard]] bool isOutOfOrder(const Boxes& boxes, std::size_t size) const;
    void computeViews();
    void boundPairs();
    [[nodiscard]] double mostOf(std::uint32_t first, std::uint32_t second) const;
    [[nodiscard]] double boundOf(const Boxes& boxes) const;
    [[nodiscard]] double boundIn(bool is_large, const Boxes& boxes) const;
    [[nodiscard]] double sharedBy(bool is_large, const Boxes& boxes) const;
    /// Bounds the area that poses of boxes see together: those of `known` by their areas, `pair` by
    /// its own (0: none), and the others by their views.
    [[nodiscard]] double unionOf(bool is_large, const Boxes& boxes, std::size_t size,
                                 unsigned known, unsigned pair = 0, double paired = 0) const;
    [[nodiscard]] double pairOf(bool is_large, const Boxes& pair) const;
    [[nodiscard]] CertificateCheck boundTuples() const;

    Floors floors_;
    const Sector& sector_;
    std::size_t count_, times_;
    const PoseCertificate& certificate_;
    const std::string& name_;
    std::size_t at_ = 0;  // in the tree of boxes
    std::vector<CheckedBox> boxes_;
    std::vector<Group> pairs_, tuples_;
    std::vector<std::uint32_t> blind_;  // boxes that were left out: their poses must see no floor
};

char CertificateChecker::nextOf(const std::string& tree, std::size_t& at, const char* name) const {
    if (at == tree.size()) refuse(std::string("the tree of ") + name + " ends early");
    return tree[at++];
}

void CertificateChecker::readBox(const PoseBox& box, int depth) {
    constexpr int kDeepest = 64;
    const char node = nextOf(certificate_.boxes, at_, "boxes");
    const auto own = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back({.box = box});
    if (node != '.') {
        if (depth == kDeepest) refuse("a box is divided more than 64 times");
        PoseBox first = box, second = box;
        if (node == 'x') {
            first.at.high.x = second.at.low.x = box.at.center().x;
        } else if (node == 'y') {
            first.at.high.y = second.at.low.y = box.at.center().y;
        } else {
            first.span = second.span = box.span / 2;
            second.from += first.span;
        }
        readBox(first, depth + 1);
        boxes_[own].second = static_cast<std::uint32_t>(boxes_.size());
        readBox(second, depth + 1);
    }
    boxes_[own].end = static_cast<std::uint32_t>(boxes_.size());
}

/// Poses of equal sensors may be assumed in the order of boxes.
bool CertificateChecker::isOutOfOrder(const Boxes& boxes, std::size_t size) const {
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t k = i + 1; k < size; ++k)
            if (boxes_[boxes[k]].end <= boxes[i]) return true;
    return false;
}

void CertificateChecker::readGroup(const std::string& tree, std::size_t& at, const char* name,
                                   Boxes boxes, std::size_t size, std::vector<Group>& groups) {
    const char node = nextOf(tree, at, name);
    const std::size_t own = groups.size();
    if (node == '-') refuse(std::string("the tree of ") + name + " leaves out all poses");
    groups.push_back({.boxes = boxes});
    if (node == '.') {
        groups[own].is_whole = true;
        for (std::size_t i = 0; i < size; ++i) boxes_[boxes[i]].is_used = true;
    } else {
        const auto which = static_cast<std::size_t>(node - '0');
        if (which >= size) refuse(std::string("no sensor ") + node + " in a tree of " + name);
        const std::uint32_t halved = boxes[which], second = boxes_[halved].second;
        if (second == 0) refuse(std::string("the tree of ") + name + " halves a whole box");
        for (const std::uint32_t half : {halved + 1, second}) {
            boxes[which] = half;
            if (at < tree.size() && tree[at] == '-') {
                ++at;
                if (!isOutOfOrder(boxes, size)) blind_.push_back(half);
            } else {
                readGroup(tree, at, name, boxes, size, groups);
            }
        }
    }
    groups[own].end = static_cast<std::uint32_t>(groups.size());
}

void CertificateChecker::computeViews() {
    constexpr std::size_t kMostBytes = std::size_t{8} << 30U;
    for (const std::uint32_t id : blind_) boxes_[id].is_used = true;
    std::uint32_t end = 0;  // of the used boxes so far
    for (std::uint32_t id = 0; id < boxes_.size(); ++id) {
        if (boxes_[id].is_used) end = std::max(end, boxes_[id].end);
        boxes_[id].is_part = id < end;
    }
    std::atomic<std::size_t> parts = 0;
    tbb::parallel_for(std::size_t{0}, boxes_.size(), [this, &parts](std::size_t i) {
        CheckedBox& box = boxes_[i];
        if (box.second != 0 && !box.is_part) return;
        box.large_view = floors_.large.viewOf(box.box);
        box.most = box.large_view.area;
        if (!box.is_part) {
            box.large_view = {};
            return;
        }
        box.large_core = floors_.large.coreOf(box.box);
        if (box.is_used) {
            box.view = floors_.fine.viewOf(box.box);
            box.most = std::min(box.most, box.view.area);
            box.core = floors_.fine.coreOf(box.box);
        }
        parts += box.view.parts.size() + box.core.parts.size() + box.large_view.parts.size() +
                 box.large_core.parts.size();
        if (parts * sizeof(std::uint16_t) > kMostBytes)
            refuse("the views of its boxes need more than 8 GiB");
    });
    // A sensor that sees no floor may be moved anywhere else.
    for (const std::uint32_t id : blind_)
        if (!boxes_[id].view.parts.empty()) refuse("a tree leaves out poses that see floor");
    for (std::size_t i = boxes_.size(); i-- > 0;) {
        CheckedBox& box = boxes_[i];
        if (box.second == 0) continue;
        const double halves = std::max(boxes_[i + 1].most, boxes_[box.second].most);
        box.most = box.is_part ? std::min(box.most, halves) : halves;
    }
}

double CertificateChecker::unionOf(bool is_large, const Boxes& boxes, std::size_t size,
                                   unsigned known, unsigned pair, double paired) const {
    std::array<BoxViews::Known, kMostPosed> areas{};
    std::array<const BoxView*, kMostPosed> views{};
    std::size_t areas_size = pair == 0 ? 0 : 1, views_size = 0, in_pair = 0;
    areas[0].area = paired;
    for (std::size_t i = 0; i < size; ++i) {
        const CheckedBox& box = boxes_[boxes[i]];
        const BoxCore& core = is_large ? box.large_core : box.core;
        if ((pair >> i & 1U) != 0)
            areas[0].cores[in_pair++] = &core;
        else if ((known >> i & 1U) != 0)
            areas[areas_size++] = {box.most, {&core, nullptr}};
        else
            views[views_size++] = is_large ? &box.large_view : &box.view;
    }
    return (is_large ? floors_.large : floors_.fine)
        .unionOf({areas.data(), areas_size}, {views.data(), views_size});
}

/// Bounds the area that two poses see together by their own boxes.
double CertificateChecker::pairOf(bool is_large, const Boxes& pair) const {
    double most = boxes_[pair[0]].most + boxes_[pair[1]].most;
    for (unsigned known = 0; known < 4; ++known)
        most = std::min(most, unionOf(is_large, pair, 2, known));
    return most;
}

void CertificateChecker::boundPairs() {
    tbb::parallel_for(std::size_t{0}, pairs_.size(), [this](std::size_t i) {
        Group& pair = pairs_[i];
        if (pair.is_whole) pair.most = pairOf(false, pair.boxes);
    });
    for (std::size_t i = pairs_.size(); i-- > 0;)
        for (std::uint32_t half = static_cast<std::uint32_t>(i) + 1; half < pairs_[i].end;
             half = pairs_[half].end)
            pairs_[i].most = std::max(pairs_[i].most, pairs_[half].most);
}

/// Bounds the area that poses of two boxes see together, by the pairs that they share poses with.
double CertificateChecker::mostOf(std::uint32_t first, std::uint32_t second) const {
    const std::uint32_t ids[] = {first, second};
    double most = 0;
    for (std::uint32_t i = 0; i < pairs_.size();) {
        const Group& pair = pairs_[i];
        bool is_apart = pair.most <= most, is_within = true;
        for (std::size_t k = 0; k < 2; ++k) {
            const std::uint32_t own = pair.boxes[k], own_end = boxes_[own].end;
            const std::uint32_t other = ids[k], end = boxes_[other].end;
            is_apart = is_apart || own_end <= other || end <= own;
            is_within = is_within && other <= own && own_end <= end;
        }
        if (is_apart) {
            i = pair.end;
        } else if (pair.is_whole || is_within) {
            most = pair.most;
            i = pair.end;
        } else {
            ++i;
        }
    }
    return most;
}

/// A sensor adds no more than the largest single view in its box, less its overlap with others, and
/// floor that one of n sensors sees is in n - 1 of the pairs of them.
double CertificateChecker::boundIn(bool is_large, const Boxes& boxes) const {
    if (times_ > 1) return sharedBy(is_large, boxes);
    const unsigned everyone = (1U << count_) - 1;
    double all = 0;
    for (std::size_t i = 0; i < count_; ++i) all += boxes_[boxes[i]].most;
    double bound = all, sum = 0;
    const auto is_open = [&] { return bound > certificate_.bound; };
    for (unsigned known = everyone + 1; known-- > 0 && is_open();)
        bound = std::min(bound, unionOf(is_large, boxes, count_, known));
    for (std::size_t i = 0; i < count_ && is_open(); ++i)
        for (std::size_t k = i + 1; k < count_ && is_open(); ++k) {
            const unsigned both = 1U << i | 1U << k;
            double pair = pairOf(is_large, {boxes[i], boxes[k]});
            if (!pairs_.empty()) pair = std::min(pair, mostOf(boxes[i], boxes[k]));
            sum += pair;
            bound = std::min(bound, all - boxes_[boxes[i]].most - boxes_[boxes[k]].most + pair);
            if (i + 2 == count_) bound = std::min(bound, sum / static_cast<double>(count_ - 1));
            for (unsigned known = everyone + 1; known-- > 0 && is_open();)
                if ((known & both) == 0)
                    bound = std::min(bound, unionOf(is_large, boxes, count_, known, both, pair));
        }
    return bound;
}

double CertificateChecker::boundOf(const Boxes& boxes) const {
    constexpr int kHalvings = 8;
    double bound = boundIn(true, boxes);
    if (bound > certificate_.bound && count_ > 1)
        bound =
            std::min(bound, poses::BoxSums(floors_.large, boxes_, times_)
                                .boundOf({boxes.data(), count_}, certificate_.bound, kHalvings));
    return bound > certificate_.bound ? std::min(bound, boundIn(false, boxes)) : bound;
}

/// Bounds the area that several of the sensors see.
double CertificateChecker::sharedBy(bool is_large, const Boxes& boxes) const {
    std::array<BoxViews::Placed, kMostPosed> placed{};
    for (std::size_t i = 0; i < count_; ++i) {
        const CheckedBox& box = boxes_[boxes[i]];
        placed[i] = is_large ? BoxViews::Placed{box.most, &box.large_view, &box.large_core}
                             : BoxViews::Placed{box.most, &box.view, &box.core};
    }
    return (is_large ? floors_.large : floors_.fine)
        .sharedBy({placed.data(), count_}, times_, certificate_.bound);
}

/// Bounds tuples until one exceeds the certificate; each before the first of these is bounded.
CertificateCheck CertificateChecker::boundTuples() const {
    constexpr double kRounding = 1e-9;
    const double enough = certificate_.bound * (1 + kRounding);
    std::vector<double> bounds(tuples_.size());
    std::atomic<std::size_t> first = tuples_.size(), bounded = 0;  // first: that exceeds
    tbb::parallel_for(std::size_t{0}, tuples_.size(), [&](std::size_t i) {
        if (!tuples_[i].is_whole || i > first) return;
        bounds[i] = boundOf(tuples_[i].boxes);
        ++bounded;
        if (bounds[i] <= enough) return;
        for (std::size_t least = first; i < least && !first.compare_exchange_weak(least, i);) {
        }
    });
    const bool is_proven = first == tuples_.size();
    return {is_proven ? *std::max_element(bounds.begin(), bounds.end()) : bounds[first],
            is_proven ? 0 : first + 1,
            bounded,
            boxes_.size(),
            pairs_.size(),
            tuples_.size(),
            floors_.fine.floorArea()};
}

CertificateCheck CertificateChecker::check() {
    readBox({floors_.fine.box(), 0, sector_.isRound() ? 0 : 2 * std::numbers::pi}, 0);
    if (at_ != certificate_.boxes.size()) refuse("more than one tree of boxes");
    std::size_t at = 0;
    if (!certificate_.pairs.empty()) readGroup(certificate_.pairs, at, "pairs", {}, 2, pairs_);
    if (at != certificate_.pairs.size()) refuse("more than one tree of pairs");
    at = 0;
    readGroup(certificate_.tuples, at, "tuples", {}, count_, tuples_);
    if (at != certificate_.tuples.size()) refuse("more than one tree of tuples");
    computeViews();
    boundPairs();
    return boundTuples();
}

}  // namespace

CertificateCheck checkCertificate(std::span<const Region> floor, std::size_t most,
                                  const Sector& sector, int sensors, const PoseGoal& goal,
                                  const PoseCertificate& certificate, const std::string& name) {
    constexpr std::size_t kFine = 16;  // cells in a large one
    const BoxViews fine(floor, most, sector, goal.weights);
    const BoxViews large(floor, std::max(most / kFine, std::size_t{1}), sector, goal.weights);
    return CertificateChecker({fine, large}, sector, sensors, goal.times, certificate, name)
        .check();
}

}  // namespace ispace
