// SPDX-License-Identifier: GPL-3.0-or-later
// Files of rules for simrun --expect, judged over a few steps of a room.
#include <chrono>

#include "extensions/expect/expect.h"
#include "extensions/expect/rule_file.h"
#include "fuzz.h"
#include "record/text.h"
#include "scene/placement_schemas.h"

namespace {

using namespace ispace;

const Scene& room() {
    static const Scene scene =
        makeScene(readRecordText("#env 1\nispace size=6,4\nzone id=k at=1,0 size=1,1\nlamp id=l1 "
                                 "at=1,0\nheater id=h1 at=0,1\nrobot id=r1 at=0,0\nhuman id=ann "
                                 "at=-1,0 path=1,0\n",
                                 "room.env", sceneSchemas()),
                  nullptr, DeviceCatalogue());
    return scene;
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::vector<expect::Expectation> rules = expect::readRules(bytes, "rules.yaml");
    for (const expect::Expectation& rule : rules)
        require(expect::parseExpectation(rule.text).text == rule.text, "another sentence");
    World world(room(), std::chrono::milliseconds(200));
    expect::ExpectationJudge judge(world, rules);
    for (int step = 0; step < 20; ++step) {
        judge.observe();
        world.step();
    }
    for (const RunVerdict& verdict : judge.verdicts())
        require(verdict.is_met == verdict.reason.empty(), "a reason for what is met, or none");
}
