// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a certificate: walks both trees, computes the view of each box that a tuple uses, and
// bounds each tuple. Poses that no tuple holds must be out of the order of the tree, or blind; a
// tree that leaves out others is refused. Boxes and tuples are independent, so that threads share
// them; the verdict does not depend on their number.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "extensions/proofs/poses/box_sums.h"
#include "extensions/proofs/poses/certificate.h"
#include "extensions/proofs/poses/pose_search.h"

namespace ispace::proofs {

namespace {

using poses::BoxCore;
using poses::BoxView;
using poses::BoxViews;
using poses::CheckedBox;
using poses::PoseBox;
using poses::Sector;

using Boxes = std::array<std::uint32_t, kMaxPosed>;

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
    /// Boxes of the sensors, in the order of the tree of boxes.
    struct Tuple {
        Boxes boxes{};
        bool is_whole = false;
    };

    [[noreturn]] void refuse(const std::string& message) const {
        throw FormatError({name_, 0, 0, message});
    }
    char nextOf(const std::string& tree, const char* name);
    void readBox(const PoseBox& box, int depth);
    void readTuple(Boxes boxes);
    [[nodiscard]] bool isOutOfOrder(const Boxes& boxes) const;
    void computeViews();
    [[nodiscard]] double boundOf(const Boxes& boxes) const;
    [[nodiscard]] double boundIn(bool is_large, const Boxes& boxes) const;
    [[nodiscard]] double sharedBy(bool is_large, const Boxes& boxes) const;
    /// Bounds the area that poses of boxes see together: those of `known` by their areas, and the
    /// others by their views.
    [[nodiscard]] double unionOf(bool is_large, const Boxes& boxes, unsigned known) const;
    [[nodiscard]] CertificateCheck boundTuples() const;

    Floors floors_;
    const Sector& sector_;
    std::size_t count_, times_;
    const PoseCertificate& certificate_;
    const std::string& name_;
    std::size_t at_ = 0;  // in the tree that is read
    std::vector<CheckedBox> boxes_;
    std::vector<Tuple> tuples_;
    std::vector<std::uint32_t> blind_;  // boxes that were left out: their poses must see no floor
};

char CertificateChecker::nextOf(const std::string& tree, const char* name) {
    if (at_ == tree.size()) refuse(std::string("the tree of ") + name + " ends early");
    return tree[at_++];
}

void CertificateChecker::readBox(const PoseBox& box, int depth) {
    constexpr int kMaxDepth = 64;
    const char node = nextOf(certificate_.boxes, "boxes");
    const auto own = static_cast<std::uint32_t>(boxes_.size());
    boxes_.push_back({.box = box});
    if (node != '.') {
        if (depth == kMaxDepth) refuse("a box is divided more than 64 times");
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
bool CertificateChecker::isOutOfOrder(const Boxes& boxes) const {
    for (std::size_t i = 0; i < count_; ++i)
        for (std::size_t k = i + 1; k < count_; ++k)
            if (boxes_[boxes[k]].end <= boxes[i]) return true;
    return false;
}

void CertificateChecker::readTuple(Boxes boxes) {
    const std::string& tree = certificate_.tuples;
    const char node = nextOf(tree, "tuples");
    if (node == '-') refuse("the tree of tuples leaves out all poses");
    tuples_.push_back({boxes, node == '.'});
    if (node == '.') {
        for (std::size_t i = 0; i < count_; ++i) boxes_[boxes[i]].is_used = true;
        return;
    }
    const auto which = static_cast<std::size_t>(node - '0');
    if (which >= count_) refuse(std::string("no sensor ") + node + " in a tree of tuples");
    const std::uint32_t halved = boxes[which], second = boxes_[halved].second;
    if (second == 0) refuse("the tree of tuples halves a whole box");
    for (const std::uint32_t half : {halved + 1, second}) {
        boxes[which] = half;
        if (at_ < tree.size() && tree[at_] == '-') {
            ++at_;
            if (!isOutOfOrder(boxes)) blind_.push_back(half);
        } else {
            readTuple(boxes);
        }
    }
}

/// Boxes that tuples use get views in fine and in large cells, boxes within them in large ones; of
/// the other leaves only the area is kept. Then a box sees no more than the better of its halves.
void CertificateChecker::computeViews() {
    constexpr std::size_t kMaxBytes = std::size_t{8} << 30U;
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
        if (parts * sizeof(std::uint16_t) > kMaxBytes)
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

double CertificateChecker::unionOf(bool is_large, const Boxes& boxes, unsigned known) const {
    std::array<BoxViews::Known, kMaxPosed> areas{};
    std::array<const BoxView*, kMaxPosed> views{};
    std::size_t areas_size = 0, views_size = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const CheckedBox& box = boxes_[boxes[i]];
        if ((known >> i & 1U) != 0)
            areas[areas_size++] = {box.most, is_large ? &box.large_core : &box.core};
        else
            views[views_size++] = is_large ? &box.large_view : &box.view;
    }
    return (is_large ? floors_.large : floors_.fine)
        .unionOf({areas.data(), areas_size}, {views.data(), views_size});
}

/// A sensor adds no more than the largest single view in its box, less its overlap with others.
double CertificateChecker::boundIn(bool is_large, const Boxes& boxes) const {
    if (times_ > 1) return sharedBy(is_large, boxes);
    double bound = 0;
    for (std::size_t i = 0; i < count_; ++i) bound += boxes_[boxes[i]].most;
    for (unsigned known = 1U << count_; known-- > 0 && bound > certificate_.bound;)
        bound = std::min(bound, unionOf(is_large, boxes, known));
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
    std::array<BoxViews::Placed, kMaxPosed> placed{};
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
            tuples_.size(),
            floors_.fine.floorArea()};
}

CertificateCheck CertificateChecker::check() {
    readBox({floors_.fine.box(), 0, sector_.isRound() ? 0 : 2 * std::numbers::pi}, 0);
    if (at_ != certificate_.boxes.size()) refuse("more than one tree of boxes");
    at_ = 0;
    readTuple({});
    if (at_ != certificate_.tuples.size()) refuse("more than one tree of tuples");
    computeViews();
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

}  // namespace ispace::proofs
