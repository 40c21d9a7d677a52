// SPDX-License-Identifier: GPL-3.0-or-later
// States of proofs over poses, as `arrange --resume` reads them: the search goes on to a bound that
// is no less than a layout, or refuses them.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "base/part_file.h"
#include "extensions/proofs/poses/pose_search.h"
#include "fuzz.h"

namespace {

using namespace ispace;

const Region kRoom{{{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 6}, {0, 6}}, {}};
constexpr double kFound = 1;
constexpr std::size_t kCells = 60, kMark = 8;  // bytes of the fingerprint of the search

class StopSoon : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return ++asked_ > kMaxAsked; }

  private:
    static constexpr int kMaxAsked = 6;
    mutable std::atomic<int> asked_ = 0;
};

JobResults emptyResults() {
    JobId job;
    job.tool = "arrange";
    return {"-", job, {}, false};
}

proofs::PoseBound goOn(JobResults& results, int sensors) {
    const proofs::poses::PoseFloor floor({&kRoom, 1}, kCells);
    StopSoon progress;
    return proofs::boundOverPoses(floor, {2.5, 2, 0},
                                  {.sensors = sensors,
                                   .found = kFound,
                                   .max_bytes = std::size_t{1} << 22U,
                                   .singles = 20,
                                   .share = {.results = &results}},
                                  progress);
}

/// The state of a search that was stopped.
std::string stateOf(int sensors) {
    JobResults results = emptyResults();
    (void)goOn(results, sensors);
    return results.find("posestate1").value();
}

}  // namespace

/// The first byte selects the number of sensors.
void ispace::fuzz::tryInput(std::string_view bytes) {
    static const std::string two = stateOf(2), three = stateOf(3);
    if (bytes.empty()) return;
    const bool is_three = bytes.front() % 2 != 0;
    std::string state = (is_three ? three : two).substr(0, kMark);
    state += bytes.substr(1);
    JobResults results = emptyResults();
    results.store("posestate1", state);
    const proofs::PoseBound ended = goOn(results, is_three ? 3 : 2);
    require(std::isfinite(ended.bound), "a bound that is no number");
    require(ended.bound >= std::max(kFound, ended.found.area), "a bound below a layout");
}
