// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/appliances/appliance.h"
#include "extensions/appliances/meter_role.h"
#include "record/text.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "server/session.h"

namespace ispace::appliances {
namespace appliances_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kHour = 3600;
constexpr std::string_view kRoom =
    "#env 1\nispace size=10,8\nzone id=z at=0,0 size=10,8\ncube id=counter at=0,1 size=1,1,0.9\n";

Scene sceneOf(const std::string& layout) {
    static const bool added = [] {
        addSceneSchemas(applianceSchemas());
        addAppliances();
        return true;
    }();
    EXPECT_TRUE(added);
    const Document placed = readRecordText("#3dm 1\n" + layout, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(kRoom, "room.env", sceneSchemas()), &placed, shippedDevices());
}

Appliance first(const std::string& layout) { return applianceOf(sceneOf(layout).records.back()); }

std::string refusal(const std::string& layout) {
    try {
        sceneOf(layout);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

const ApplianceFigures& figuresOf(std::string_view kind) {
    for (const ApplianceKind& each : applianceKinds())
        if (each.name == kind) return each.figures;
    throw std::logic_error("no such kind");
}

/// Returns the energy in kWh from switching it on until a time, or until it is done.
double energyOf(const ApplianceFigures& figures, double until) {
    Appliance appliance;
    appliance.figures = figures;
    appliance.is_on = true;
    AppliancePhase phase = phaseAfterChange(appliance, nullptr, true, SimTime{});
    const SimTime end = simSeconds(until);
    double joules = 0;
    while (phase.since < end && phase.is_on) {
        appliance.state = phase.state;
        const SimTime next = std::min(endOf(figures, phase).value_or(end), end);
        joules += appliance.watts() * ispace::seconds(next - phase.since);
        if (next == end) break;
        phase = nextPhase(figures, phase);
    }
    return joules / (1000 * kHour);
}

/// The figures are those of their sources.
TEST(ApplianceCatalogue, AgreesWithLabelsAndPhysics) {
    ASSERT_EQ(applianceKinds().size(), 9U);
    for (const ApplianceKind& kind : applianceKinds()) EXPECT_FALSE(kind.source.empty());
    // A litre of water, 4186 J/kg K, from 15 to 100 degrees.
    const ApplianceFigures& kettle = figuresOf("kettle");
    EXPECT_NEAR(0.98 * kettle.start * kettle.start_time, 4186.0 * 85, 1000);
    EXPECT_NEAR(energyOf(figuresOf("fridge"), 365 * 24 * kHour), 207, 2);
    EXPECT_NEAR(energyOf(figuresOf("washer"), 24 * kHour), 0.47, 0.005);
    EXPECT_NEAR(energyOf(figuresOf("oven"), 0.78 * kHour), 0.85, 0.06);
    EXPECT_NEAR(energyOf(figuresOf("tv"), 1000 * kHour), 68, 0.1);
    EXPECT_NEAR(energyOf(figuresOf("display"), 1000 * kHour), 22, 0.1);
    EXPECT_NEAR(energyOf(figuresOf("gate"), kHour), (600 + 14 * 250) / 3.6e6, 1e-9);
}

TEST(ApplianceRecords, AreReadWithHints) {
    const Appliance kettle = first(
        "appliance id=k kind=kettle at=0,1 heading=90 height=95cm draws=1500,1200,2 lasts=2min,5,0 "
        "sound=50,60 heat=50%");
    EXPECT_EQ(kettle.watts(), 2);
    EXPECT_EQ(kettle.figures.start, 1500);
    EXPECT_EQ(kettle.figures.start_time, 120);
    EXPECT_EQ(kettle.figures.hold_sound, 60);
    EXPECT_EQ(kettle.figures.heat, 0.5);
    EXPECT_EQ(kettle.pose.position.z, 0.95);
    EXPECT_NE(refusal("appliance kind=ketle at=0,1")
                  .find("is none of dispenser, display, fridge, gate, kettle, oven, plug_lamp, tv, "
                        "washer, did you mean `kettle`?"),
              std::string::npos);
    for (const char* const bad :
         {"appliance at=0,1", "appliance kind=tv", "appliance kind=tv at=0,1 draws=1,2",
          "appliance kind=tv at=0,1 draws=1,-2,3", "appliance kind=tv at=0,1 lasts=1,2",
          "appliance kind=tv at=0,1 state=cooking", "appliance kind=tv at=0,1 heat=120%",
          "plug id=p", "plug id=p of=k count=0"})
        EXPECT_NE(refusal(bad), "") << bad;
}

TEST(ApplianceRecords, AreChecked) {
    const auto found = [](const std::string& layout) {
        std::string text;
        for (const Finding& finding : checkScene(sceneOf(layout))) text += finding.text() + "\n";
        return text;
    };
    EXPECT_EQ(found("appliance id=k kind=kettle at=0,1\nplug id=p of=k\n"), "");
    EXPECT_EQ(found("appliance id=kettle kind=kettle at=0,1\nplug id=p of=kettel\n"),
              "plug p is of `kettel`, which is no appliance; name `kettle`\n");
    EXPECT_EQ(found("plug id=p of=counter\n"),
              "plug p is of `counter`, which is no appliance; name one in `of`\n");
    EXPECT_EQ(found("appliance id=k kind=tv at=0,1\nplug id=p of=k\nplug id=q of=k\n"),
              "plug q is of `k`, which has the plug p; leave one of them out\n");
    EXPECT_NE(found("appliance id=k kind=tv at=9,1\n").find("stands outside the room"),
              std::string::npos);
    // One of two plugs meters.
    EXPECT_EQ(plugsOf(sceneOf("appliance id=k kind=tv at=0,1\nplug id=p of=k\nplug id=q of=k\n"
                              "plug id=r of=x\n"))
                  .size(),
              1U);
}

TEST(Appliance, HasStates) {
    const Scene scene =
        sceneOf("appliance id=k kind=kettle at=0,1 on=yes state=start\nplug id=p of=k\n");
    EXPECT_EQ(
        roomStates(scene),
        (std::vector<RoomState>{
            {"k", "on", "1"}, {"k", "state", "start"}, {"k", "power", "2200"}, {"p", "on", "1"}}));
    EXPECT_TRUE(isActuator("appliance"));
    EXPECT_EQ(stateEdit(scene, "k", "state=off"), "k.state=off");
    EXPECT_THROW(stateEdit(scene, "k", "power=3"), UsageError);
}

TEST(AppliancePhases, FollowSwitchesAndMains) {
    Appliance kettle;
    kettle.figures = figuresOf("kettle");
    const auto change = [&](const AppliancePhase& before, bool on, ApplianceState state,
                            bool mains = true) {
        kettle.is_on = on;
        kettle.state = state;
        return phaseAfterChange(kettle, &before, mains, seconds(7));
    };
    const AppliancePhase waiting{}, starting{true, ApplianceState::Start, true, seconds(1)};
    using enum ApplianceState;
    EXPECT_EQ(change(waiting, true, Standby).state, Start);
    EXPECT_EQ(change(waiting, true, Standby).since, SimTime(seconds(7)));
    EXPECT_EQ(change(starting, true, Start).since, SimTime(seconds(1)));
    EXPECT_EQ(change(starting, false, Start).state, Standby);
    // A state that is set is a switch, too.
    EXPECT_TRUE(change(waiting, false, Hold).is_on);
    EXPECT_FALSE(change(starting, true, Standby).is_on);
    EXPECT_FALSE(change(starting, true, Off).is_on);
    EXPECT_EQ(change(starting, true, Off).state, Off);
    // Without mains it is off, switched on or not, and goes on when they return.
    const AppliancePhase dark = change(starting, true, Start, false);
    EXPECT_EQ(dark.state, Off);
    EXPECT_TRUE(dark.is_on);
    EXPECT_EQ(change(dark, true, Off).state, Start);
    EXPECT_EQ(change({false, Off, false, {}}, false, Off).state, Standby);
    EXPECT_EQ(change(dark, true, Hold, false).state, Off);
    // At the start of a run.
    kettle.is_on = true;
    kettle.state = Standby;
    EXPECT_EQ(phaseAfterChange(kettle, nullptr, true, {}).state, Start);
    kettle.is_on = false;
    kettle.state = Hold;
    EXPECT_TRUE(phaseAfterChange(kettle, nullptr, true, {}).is_on);
}

TEST(AppliancePhases, EndInTime) {
    const ApplianceFigures& kettle = figuresOf("kettle");
    AppliancePhase phase{true, ApplianceState::Start, true, seconds(5)};
    EXPECT_EQ(endOf(kettle, phase), SimTime(seconds(170)));
    phase = nextPhase(kettle, phase);
    EXPECT_EQ(phase.state, ApplianceState::Hold);
    phase = nextPhase(kettle, phase);
    EXPECT_EQ(phase.state, ApplianceState::Standby);
    EXPECT_FALSE(phase.is_on);
    EXPECT_EQ(phase.since, SimTime(seconds(180)));
    EXPECT_EQ(endOf(kettle, phase), std::nullopt);
    // A fridge rests and starts again.
    const ApplianceFigures& fridge = figuresOf("fridge");
    phase = {true, ApplianceState::Start, true, {}};
    for (int i = 0; i < 3; ++i) phase = nextPhase(fridge, phase);
    EXPECT_EQ(phase.state, ApplianceState::Start);
    EXPECT_EQ(phase.since, SimTime(seconds(2701)));
}

/// Cycles that are shorter than a nanosecond do not hold up a run.
TEST(AppliancePhases, AreBounded) {
    ApplianceFigures figures;
    figures.hold_time = figures.rest_time = 1e-12;
    const AppliancePhase phase =
        phaseAt(figures, {true, ApplianceState::Hold, true, seconds(1)}, seconds(5));
    EXPECT_EQ(phase.since, SimTime(seconds(5)));
    const ApplianceFigures& kettle = figuresOf("kettle");
    EXPECT_EQ(phaseAt(kettle, {true, ApplianceState::Start, true, {}}, seconds(1000)).since,
              SimTime(seconds(175)));
}

/// A run in which changes are made as the server does.
class MeterRole : public ::testing::Test {
  protected:
    explicit MeterRole()
        : scene_(sceneOf("appliance id=kettle kind=kettle at=0,1\nplug id=p of=kettle count=0.001\n"
                         "appliance id=fridge kind=fridge at=2,1 on=yes\nplug id=pf of=fridge\n")),
          world_(scene_, milliseconds(500)),
          simulation_(world_, {}, parseClock("step"), std::nullopt),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeMeters({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
        simulation_.events().want({EventKind::State});
    }
    void act(const std::string& change) {
        changes_ += change + "\n";
        // The server goes on without a change that fails.
        try {
            world_.change(makeScene(editedRecords(world_.scene(), parseEdits(change),
                                                  [](const std::string&) { return std::nullopt; }),
                                    world_.scene(), shippedDevices()));
        } catch (const FormatError&) {
            changes_ += "refused\n";
        }
    }
    std::string run(int steps, Session& session) {
        std::string told;
        for (int i = 0; i < steps; ++i) {
            while (simulation_.isChangeDue()) act(simulation_.takeScriptedChange());
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(1));
            service_->stepped();
            session.proceed();
            told += session.take();
        }
        return told;
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
    std::string changes_;
};

TEST_F(MeterRole, MetersAndSwitches) {
    Session all(state_), fridge(state_);
    EXPECT_EQ(ask(all, "METER *"), "OK METER * t=0.000 plugs=p,pf\n");
    EXPECT_EQ(ask(fridge, "METER pf"), "OK METER pf t=0.000 plugs=pf\n");
    EXPECT_EQ(ask(all, "READ p"), "OK READ id=p t=0.000 on=1 power=0 energy=0.000000\n");
    EXPECT_EQ(ask(all, "READ k"), "ERR 404 no plug `k`\n");
    EXPECT_EQ(ask(fridge, "READ p").substr(0, 8), "ERR 404 ");
    EXPECT_EQ(ask(all, "WATCH"), "OK WATCH t=0.000\n");
    run(10, all);
    act("SET kettle.on=yes");
    const std::string told = run(10, all);
    EXPECT_NE(told.find("EVENT meter id=p t=6.000 on=1 power=2200 energy=0.000000\n"),
              std::string::npos)
        << told;
    // A step with 2200 W for each from the second one on, a count for each 3600 J.
    EXPECT_NE(told.find("EVENT meter id=p t=7.500 on=1 power=2200 energy=0.001222\n"),
              std::string::npos)
        << told;
    // The plug cuts it off, and it goes on.
    act("SET p.on=no");
    run(4, all);
    EXPECT_NE(ask(all, "READ p").find(" on=0 power=0 "), std::string::npos);
    act("SET p.on=yes");
    run(2 * 60 * 5, all);
    EXPECT_EQ(
        changes_,
        "ACT fridge state=start\nACT fridge state=hold\nSET kettle.on=yes\nACT kettle state=start\n"
        "SET p.on=no\nACT kettle state=off\nSET p.on=yes\nACT kettle state=start\n"
        "ACT kettle state=hold\nACT kettle on=no state=standby\n");
    EXPECT_EQ(ask(all, "UNWATCH").substr(0, 10), "OK UNWATCH");
}

/// A thing that is gone makes a joint change fail; the others ask again.
TEST_F(MeterRole, AsksAgain) {
    Session session(state_);
    ask(session, "METER *");
    run(8, session);
    act("ACT kettle on=yes ; fridge on=no");
    run(1, session);
    changes_.clear();
    act("DELETE pf fridge");
    run(4, session);
    EXPECT_EQ(
        changes_,
        "DELETE pf fridge\nACT kettle state=start ; fridge state=standby\nrefused\nACT kettle "
        "state=start\n");
    EXPECT_NE(ask(session, "READ p").find("power=2200 "), std::string::npos);
}

/// Appliances of one moment change together.
TEST_F(MeterRole, JoinsChanges) {
    Session session(state_);
    ask(session, "METER *");
    run(10, session);
    changes_.clear();
    act("ACT kettle state=hold ; fridge state=off");
    run(2, session);
    EXPECT_EQ(changes_,
              "ACT kettle state=hold ; fridge state=off\nACT kettle on=yes ; fridge on=no\n");
    EXPECT_EQ(ask(session, "READ pf").find("on=1 power=0 ") == std::string::npos, false);
}

TEST_F(MeterRole, FollowsChangesOfRecords) {
    Session session(state_);
    ask(session, "METER *");
    run(2, session);
    world_.change(sceneOf("appliance id=tv kind=tv at=1,1\nplug id=p of=tv\nplug id=q of=gone\n"));
    run(2, session);
    EXPECT_NE(ask(session, "READ p").find("power=0.4 "), std::string::npos);
    EXPECT_EQ(ask(session, "READ q").substr(0, 8), "ERR 404 ");
    EXPECT_EQ(ask(session, "READ pf").substr(0, 8), "ERR 404 ");
}

TEST(Meters, AreNoneWithoutAppliances) {
    const Scene scene = sceneOf("robot id=r1 at=2,0\n");
    World world(scene, milliseconds(5));
    Simulation simulation(world, {}, parseClock("step"), std::nullopt);
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeMeters({&room, 1}, 1), nullptr);
}

}  // namespace appliances_test
}  // namespace ispace::appliances
