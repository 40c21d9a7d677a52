// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of ARIA's classes that need no server: functors, resolver, packets, threads,
// configurations, arguments, sockets, poses, sonars.
#include <Sim_Aria.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <list>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "support/test_folder.h"

namespace {

struct Callee {
    int sum = 0;
    void none() { sum += 1; }
    void one(int a) { sum += a; }
    void two(int a, double b) { sum += a + static_cast<int>(b); }
    bool three(const std::string& text, int n, int m) {
        return static_cast<int>(text.size()) == n + m;
    }
    [[nodiscard]] int constant() const { return 23; }
};
int product(int a, int b) { return a * b; }

TEST(SimAriaFunctors, StoredAndGivenParameters) {
    Callee callee;
    ArFunctorC<Callee> none(callee, &Callee::none);
    ArFunctor1C<Callee, int> one(&callee, &Callee::one, 10);
    ArFunctor2C<Callee, int, double> two(&callee, &Callee::two, 100, 200.5);
    ArRetFunctor3C<bool, Callee, const std::string&, int, int> three(callee, &Callee::three, "abcd",
                                                                     1, 3);
    for (ArFunctor* functor : {static_cast<ArFunctor*>(&none), static_cast<ArFunctor*>(&one),
                               static_cast<ArFunctor*>(&two)})
        functor->invoke();
    EXPECT_EQ(callee.sum, 1 + 10 + 300);
    one.invoke(5);
    two.invoke(7);
    two.invoke(7, 8);
    EXPECT_EQ(callee.sum, 311 + 5 + 207 + 15);
    one.setP1(20);
    one.invoke();
    EXPECT_EQ(callee.sum, 558);
    EXPECT_TRUE(three.invokeR());
    EXPECT_FALSE(three.invokeR("abc"));
    EXPECT_TRUE(three.invokeR("abc", 0));
    EXPECT_TRUE(three.invokeR("abc", 2, 1));
    EXPECT_EQ((ArRetFunctor1C<int, Callee, int>().invokeR(5)), 0);
    const Callee fixed{};
    ArConstRetFunctorC<int, Callee> constant(fixed, &Callee::constant);
    ArRetFunctor<int>* const as_base = &constant;
    EXPECT_EQ(as_base->invokeR(), 23);
    ArGlobalRetFunctor2<int, int, int> global(&product, 6, 7);
    EXPECT_EQ(global.invokeR(), 42);
    EXPECT_EQ(global.invokeR(2), 14);
    ArFunctorC<Callee> empty;
    ArFunctor1C<Callee, int> empty1;
    empty.invoke();
    empty1.invoke(5);
    none.setName("%s %d", "task", 1);
    EXPECT_STREQ(none.getName(), "task 1");
}

/// An action with a fixed wish.
class Wish : public ArAction {
  public:
    Wish() : ArAction("wish") {}
    ArActionDesired* fire(ArActionDesired current) override {
        seen = current.getVel();
        return &desired;
    }
    ArActionDesired desired;
    double seen = 0;
};

TEST(SimAriaResolver, SharesStrengthByPriority) {
    ArRobot robot;
    Wish high, middle, low, other;
    robot.addAction(&low, 10);
    robot.addAction(&high, 90);
    robot.addAction(&middle, 50);
    ArResolver* const resolver = robot.getResolver();
    const auto resolve = [&] { return resolver->resolve(robot.getActionMap(), &robot); };
    high.desired.setVel(100, 0.25);
    middle.desired.setVel(300, 0.5);
    low.desired.setVel(1000);
    EXPECT_NEAR(resolve()->getVel(), 0.25 * 100 + 0.5 * 300 + 0.25 * 1000, 1e-9);
    EXPECT_EQ(resolve()->getVelStrength(), 1);
    EXPECT_NEAR(middle.seen, 100, 1e-9);
    // A full wish leaves no share.
    high.desired.setVel(100);
    EXPECT_EQ(resolve()->getVel(), 100);
    // The lowest limit holds, of any priority; of one with no strength, none.
    high.desired.setMaxVel(500);
    low.desired.setMaxVel(200);
    middle.desired.setMaxVel(10, 0);
    EXPECT_EQ(resolve()->getMaxVel(), 200);
    // Equal priorities are averaged by strength.
    high.desired.reset();
    middle.desired.reset();
    robot.addAction(&other, 50);
    middle.desired.setDeltaHeading(30, 0.25);
    other.desired.setDeltaHeading(-10, 0.75);
    EXPECT_NEAR(resolve()->getDeltaHeading(), 0, 1e-9);
    // A rotation of lower priority does not mix with a heading.
    low.desired.setRotVel(50);
    EXPECT_EQ(resolve()->getRotVelStrength(), 0);
    middle.deactivate();
    other.deactivate();
    EXPECT_EQ(resolve()->getRotVel(), 50);
    // A heading becomes a change of heading.
    low.desired.setHeading(170);
    EXPECT_NEAR(resolve()->getDeltaHeading(), 170, 1e-9);
}

TEST(SimAriaResolver, NeedsNoRobot) {
    ArActionConstantVelocity slow("slow", 200), fast("fast", 400);
    ArResolver::ActionMap actions = {{50, &slow}, {50, &fast}};
    ArPriorityResolver resolver;
    EXPECT_EQ(resolver.resolve(&actions, nullptr)->getVel(), 300);
}

TEST(SimAriaMath, AWholeTurnHasAllAngles) {
    for (const double angle : {-180.0, -90.0, 0.0, 33.0, 180.0}) {
        EXPECT_TRUE(ArMath::angleBetween(angle, -180, 180)) << angle;
        EXPECT_TRUE(ArMath::angleBetween(angle, 0, 360)) << angle;
        EXPECT_TRUE(ArMath::angleBetween(angle, 1, 0) || angle == 0.5) << angle;
    }
    EXPECT_FALSE(ArMath::angleBetween(0.5, 1, 0));
    EXPECT_TRUE(ArMath::angleBetween(20, 20, 20));
    EXPECT_FALSE(ArMath::angleBetween(21, 20, 20));
}

/// Once removed, an action may outlive its robot.
TEST(SimAriaActions, RemovedOnesForgetTheRobot) {
    Wish twice, by_name;
    std::unique_ptr<ArRobot> robot(new ArRobot);
    robot->addAction(&twice, 50);
    robot->addAction(&twice, 40);
    robot->addAction(&by_name, 30);
    EXPECT_TRUE(robot->remAction(&twice));
    EXPECT_EQ(twice.getRobot(), robot.get());
    EXPECT_TRUE(robot->remAction(&twice));
    EXPECT_EQ(twice.getRobot(), nullptr);
    EXPECT_TRUE(robot->remAction("wish"));
    EXPECT_EQ(by_name.getRobot(), nullptr);
    EXPECT_FALSE(robot->remAction("wish"));
}

TEST(SimAriaPackets, ReadWhatWasWritten) {
    ArRobotPacket packet;
    packet.setID(0xb0);
    packet.byteToBuf(-3);
    packet.uByteToBuf(200);
    packet.byte2ToBuf(-12345);
    packet.uByte4ToBuf(4000000000U);
    packet.strToBuf("text");
    packet.finalizePacket();
    EXPECT_TRUE(packet.verifyCheckSum());
    EXPECT_EQ(packet.getID(), 0xb0);
    EXPECT_EQ(packet.getLength(), 4 + 1 + 1 + 2 + 4 + 5 + 2);
    EXPECT_EQ(packet.bufToByte(), -3);
    EXPECT_EQ(packet.bufToUByte(), 200);
    EXPECT_EQ(packet.bufToByte2(), -12345);
    EXPECT_EQ(packet.bufToUByte4(), 4000000000U);
    EXPECT_EQ(packet.bufToString(), "text");
    EXPECT_EQ(packet.getReadLength(), packet.getLength() - 2);
    EXPECT_TRUE(packet.isValid());
    packet.bufToUByte4();
    EXPECT_FALSE(packet.isValid());
}

TEST(SimAriaPackets, BytesBeforeTheFooterAreLeft) {
    ArBasePacket packet(64, 4, nullptr, 10);
    packet.setLength(5);
    packet.setReadLength(4);
    EXPECT_FALSE(packet.bufferContainsBytes(1));
    packet.setLength(16);
    EXPECT_TRUE(packet.bufferContainsBytes(2));
    EXPECT_FALSE(packet.bufferContainsBytes(3));
    packet.setReadLength(2);
    EXPECT_EQ(packet.getDataReadLength(), 0);
}

class Counter : public ArASyncTask {
  public:
    void* runThread(void*) override {
        while (getRunningWithLock()) {
            mutex.lock();
            ++count;
            mutex.unlock();
            condition.signal();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return nullptr;
    }
    ArMutex mutex;
    ArCondition condition;
    int count = 0;
};

TEST(SimAriaThreads, AConditionWakesTheWaiter) {
    Counter counter;
    EXPECT_EQ(counter.condition.timedWait(1), ArCondition::STATUS_WAIT_TIMEDOUT);
    counter.runAsync();
    EXPECT_EQ(counter.condition.wait(), 0);
    counter.stopRunning();
    EXPECT_EQ(counter.join(), 0);
    EXPECT_GT(counter.count, 0);
    EXPECT_EQ(counter.join(), ArThread::STATUS_NO_SUCH_THREAD);
}

TEST(SimAriaConfig, RoundTripAndErrors) {
    const ispace::testing::TestFolder folder;
    const std::string file = folder.file("aria.cfg");
    int whole = 3;
    double share = 0.25;
    bool on = true;
    char name[8] = "robot";
    ArConfig config;
    config.addParam(ArConfigArg("Whole", &whole, "a number", -10, 10), "First");
    config.addParam(ArConfigArg("Share", &share, "a share", 0.0, 1.0), "First");
    config.addParam(ArConfigArg("On", &on, "a switch"), "Second");
    config.addParam(ArConfigArg("Name", name, "a name", sizeof name), "Second");
    EXPECT_FALSE(config.addParam(ArConfigArg("whole", &whole, ""), "First"));
    ASSERT_TRUE(config.writeFile(file.c_str()));
    whole = 0, share = 0, on = false, name[0] = 0;
    char error[200];
    ASSERT_TRUE(config.parseFile(file.c_str(), false, false, error, sizeof error)) << error;
    EXPECT_EQ(whole, 3);
    EXPECT_EQ(share, 0.25);
    EXPECT_TRUE(on);
    EXPECT_STREQ(name, "robot");
    std::FILE* const bad = std::fopen(file.c_str(), "w");
    std::fputs("Section First\nWhole 11\nUnknown 5\nShare 1\n", bad);
    std::fclose(bad);
    EXPECT_FALSE(config.parseFile(file.c_str(), true, true, error, sizeof error));
    EXPECT_NE(std::string(error).find(":2: bad value in `Whole 11`"), std::string::npos) << error;
    EXPECT_EQ(whole, 3);
    EXPECT_EQ(share, 1);
    std::remove(file.c_str());
    EXPECT_FALSE(config.parseFile(file.c_str(), true, true, error, sizeof error));
}

struct Waypoints {
    std::list<ArArgumentBuilder> read;
    std::list<ArArgumentBuilder*> pointers;
    bool add(ArArgumentBuilder* words) {
        read.push_back(*words);
        return words->getArgc() == 2;
    }
    const std::list<ArArgumentBuilder*>* all() {
        pointers.clear();
        for (ArArgumentBuilder& one : read) pointers.push_back(&one);
        return &pointers;
    }
};

TEST(SimAriaConfig, FunctorsSectionsAndOptions) {
    const ispace::testing::TestFolder folder;
    const std::string file = folder.file("aria.cfg");
    Waypoints points;
    ArRetFunctor1C<bool, Waypoints, ArArgumentBuilder*> set(points, &Waypoints::add);
    ArRetFunctorC<const std::list<ArArgumentBuilder*>*, Waypoints> get(points, &Waypoints::all);
    int speed = 1, range = 1;
    ArConfig config;
    config.addParam(ArConfigArg("Point", &set, &get, "a point of the way"), "Way");
    config.addParam(ArConfigArg("Speed", &speed, "mm/s"), "Way");
    config.addParam(ArConfigArg("Range", &range, "mm"), "Other");
    const auto write = [&](const char* text) {
        std::FILE* const out = std::fopen(file.c_str(), "w");
        std::fputs(text, out);
        std::fclose(out);
    };
    write("Section Way\nPoint 1 2\nPoint 3 4\nSpeed 5\nSection Other\nRange 6\n");
    char name[] = "test", option[] = "-Speed", value[] = "7";
    char* words[] = {name, option, value, nullptr};
    int count = 3;
    ArArgumentParser parser(&count, words);
    config.useArgumentParser(&parser);
    std::list<std::string> sections = {"way"};
    ASSERT_TRUE(config.parseFile(file.c_str(), false, false, nullptr, 0, &sections));
    EXPECT_EQ(speed, 7);
    EXPECT_EQ(range, 1);
    EXPECT_EQ(count, 1);
    ASSERT_EQ(points.read.size(), 2U);
    EXPECT_STREQ(points.read.back().getFullString(), "3 4");
    EXPECT_STREQ(points.read.back().getExtraString(), "Point");
    // Both lines are written, and read again.
    ASSERT_TRUE(config.writeFile(file.c_str()));
    ASSERT_TRUE(config.parseFile(file.c_str()));
    EXPECT_EQ(points.read.size(), 4U);
    write("Section Way\nPoint 1\n");
    EXPECT_FALSE(config.parseFile(file.c_str()));
}

TEST(SimAriaActionGroup, LeavesTheRobotAloneThatFollowsItsOwn) {
    alignas(ArRobot) unsigned char memory[sizeof(ArRobot)];
    ArRobot* const first = new (memory) ArRobot;
    ArActionGroupStop group(first);
    first->~ArRobot();
    ArRobot* const second = new (memory) ArRobot;
    {
        ArActionStop stop;
        second->addAction(&stop, 50);
        group.activateExclusive();
        EXPECT_TRUE(stop.isActive());
    }
    second->~ArRobot();
}

/// Echoes at these points, mm.
class Echoes : public ArRangeDevice {
  public:
    explicit Echoes(const std::vector<ArPose>& points)
        : ArRangeDevice(1, 1, "echoes", 5000), readings_(points.size()) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            readings_[i].newData(0, points[i], 1);
            pointers_.push_back(&readings_[i]);
        }
    }
    [[nodiscard]] const std::list<ArSensorReading*>* getRawReadings() const override {
        return &pointers_;
    }

  private:
    std::vector<ArSensorReading> readings_;
    std::list<ArSensorReading*> pointers_;
};

TEST(SimAriaLineFinder, ACornerOfALineIsNoPointBesideIt) {
    // A wall of eleven points, and two more round its corner: too few for a line.
    std::vector<ArPose> points;
    for (int i = 0; i <= 10; ++i) points.emplace_back(100 * i, 0);
    points.emplace_back(1000, 100);
    points.emplace_back(1000, 200);
    Echoes echoes(points);
    ArLineFinder finder(&echoes);
    ASSERT_EQ(finder.getLines()->size(), 1U);
    EXPECT_EQ(finder.getLines()->at(0)->getEndPoint(), 10);
    std::string rest;
    for (const auto& point : *finder.getNonLinePoints()) rest += std::to_string(point.first) + " ";
    EXPECT_EQ(rest, "11 12 ");
}

TEST(SimAriaFileParser, LinesByTheirFirstWord) {
    const ispace::testing::TestFolder folder;
    std::FILE* const out = std::fopen(folder.file("points.txt").c_str(), "w");
    std::fputs("POINT 1 2 ; first\n\n# none\nspeed 3\npoint 4\npoint 5 6\n", out);
    std::fclose(out);
    Waypoints points, others;
    ArRetFunctor1C<bool, Waypoints, ArArgumentBuilder*> add(points, &Waypoints::add),
        add_other(others, &Waypoints::add);
    ArFileParser parser(folder.path().c_str());
    EXPECT_TRUE(parser.addHandler("point", &add));
    EXPECT_FALSE(parser.addHandler("Point", &add));
    EXPECT_FALSE(parser.parseFile("points.txt", false));  // ends at the unknown word
    EXPECT_EQ(points.read.size(), 1U);
    EXPECT_TRUE(parser.addHandler(nullptr, &add_other));
    EXPECT_FALSE(parser.parseFile("points.txt"));  // a point has two numbers
    EXPECT_EQ(points.read.size(), 4U);
    ASSERT_EQ(others.read.size(), 1U);
    EXPECT_STREQ(others.read.front().getFullString(), "speed 3");
    EXPECT_EQ(others.read.front().getArgInt(1), 3);
    EXPECT_TRUE(parser.remHandler(&add));
    EXPECT_FALSE(parser.remHandler("point"));
    EXPECT_FALSE(parser.parseFile("missing.txt", true, true));
}

TEST(SimAriaKeys, FunctionKeysHaveNumbers) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    std::FILE* const input = fdopen(ends[0], "r");
    {
        ArKeyHandler keys(false, false, input);
        const std::string typed = "\033OP\033[15~\033[24~\033[17;2~\033[6~\033[3~x";
        ASSERT_EQ(write(ends[1], typed.data(), typed.size()), static_cast<ssize_t>(typed.size()));
        for (const int key : {ArKeyHandler::F1, ArKeyHandler::F5, ArKeyHandler::F12,
                              ArKeyHandler::F6, ArKeyHandler::PAGEDOWN, ArKeyHandler::DEL})
            EXPECT_EQ(keys.getKey(), key);
        EXPECT_EQ(keys.getKey(), 'x');
        EXPECT_EQ(keys.getKey(), -1);
    }
    close(ends[1]);
    std::fclose(input);
}

TEST(SimAriaStatistics, SectorsAndTheMeanSquare) {
    ArSectors<> sectors;
    for (double angle = 0; angle < 315; angle += 45) sectors.update(angle);
    EXPECT_FALSE(sectors.didAll());
    sectors.update(-1);
    EXPECT_TRUE(sectors.didAll());
    ArRootMeanSquareCalculator square;
    EXPECT_EQ(square.getRootMeanSquare(), 0);
    square.add(100000);
    square.add(-100000);
    EXPECT_NEAR(square.getRootMeanSquare(), 100000, 1e-6);
    char name[4];
    EXPECT_TRUE(ArUtil::getFileName("maps/robots", name, sizeof name));
    EXPECT_STREQ(name, "rob");
}

// A second of latitude is 30.9 m, of longitude the cosine of it.
TEST(SimAriaGps, MapsLieOnTheEarth) {
    const ArMapGPSCoords map(ArLLACoords(48.1, 11.6, 500));
    double east = 0, north = 0, up = 0;
    map.convertLLA2MapCoords(ArLLACoords(48.1 + 1.0 / 3600, 11.6 + 1.0 / 3600, 501), east, north,
                             up);
    EXPECT_NEAR(north, 30892, 10);
    EXPECT_NEAR(east, 20696, 20);
    EXPECT_NEAR(up, 1000, 1);
    double latitude = 0, longitude = 0, altitude = 0;
    map.convertMap2LLACoords(east, north, up, latitude, longitude, altitude);
    EXPECT_NEAR(latitude, 48.1 + 1.0 / 3600, 1e-10);
    EXPECT_NEAR(longitude, 11.6 + 1.0 / 3600, 1e-10);
    EXPECT_NEAR(altitude, 501, 1e-5);
}

TEST(SimAriaArguments, ValuesDefaultsAndTheRest) {
    ArArgumentBuilder builder;
    builder.add("-speed %d -name \"two words\" -wrong x -far 3000000000 -on true rest", 42);
    ArArgumentParser parser(&builder);
    int speed = 0, wrong = 7, none = 5;
    bool set = true, on = false;
    const char* name = "";
    EXPECT_TRUE(parser.checkParameterArgumentInteger("-speed", &speed, &set));
    EXPECT_TRUE(set);
    EXPECT_EQ(speed, 42);
    EXPECT_TRUE(parser.checkParameterArgumentString("-name", &name));
    EXPECT_STREQ(name, "two words");
    EXPECT_FALSE(parser.checkParameterArgumentInteger("-wrong", &wrong, &set));
    EXPECT_FALSE(set);
    EXPECT_FALSE(parser.checkParameterArgumentInteger("-far", &wrong, &set));
    EXPECT_FALSE(set);
    EXPECT_EQ(wrong, 7);
    EXPECT_TRUE(parser.checkParameterArgumentInteger("-none", &none, &set));
    EXPECT_FALSE(set);
    EXPECT_TRUE(parser.checkParameterArgumentBool("-on", &on));
    EXPECT_TRUE(on);
    parser.addDefaultArgument("-connectLaser -laserDegrees 180");
    EXPECT_TRUE(parser.checkArgument("-connectLaser"));
    EXPECT_FALSE(parser.checkArgument("-connectLaser"));
    EXPECT_STREQ(parser.checkParameterArgument("-laserDegrees"), "180");
    ASSERT_EQ(parser.getArgc(), 1U);
    EXPECT_STREQ(parser.getArg(0), "rest");
    EXPECT_FALSE(parser.checkHelpAndWarnUnparsed());
    EXPECT_TRUE(parser.checkHelpAndWarnUnparsed(1));
}

TEST(SimAriaArguments, WordsAsNumbers) {
    ArArgumentBuilder builder;
    builder.addPlain("42 -3.5 true 4x \"\" 0 3000000000 -2147483648 99999999999999999999");
    bool ok = false;
    EXPECT_EQ(builder.getArgInt(0, &ok), 42);
    EXPECT_TRUE(ok && builder.isArgInt(5));
    EXPECT_EQ(builder.getArgInt(1), 0);
    EXPECT_EQ(builder.getArgDouble(1, &ok), -3.5);
    EXPECT_TRUE(ok);
    for (const std::size_t i : {1U, 2U, 3U, 4U, 6U, 8U, 9U}) EXPECT_FALSE(builder.isArgInt(i)) << i;
    EXPECT_EQ(builder.getArgInt(6), 0) << "beyond an int";
    EXPECT_EQ(builder.getArgDouble(6), 3e9);
    EXPECT_EQ(builder.getArgInt(7, &ok), std::numeric_limits<int>::min());
    EXPECT_TRUE(ok);
    for (const std::size_t i : {2U, 3U, 4U, 9U}) EXPECT_FALSE(builder.isArgDouble(i)) << i;
    EXPECT_TRUE(builder.getArgBool(2, &ok) && ok);
    EXPECT_FALSE(builder.getArgBool(5, &ok));
    EXPECT_TRUE(ok && builder.isArgBool(2) && !builder.isArgBool(0) && !builder.isArgBool(9));
}

TEST(SimAriaSockets, ALineEachWay) {
    ArSocket server, client, accepted;
    ASSERT_TRUE(server.open(0, ArSocket::TCP, "127.0.0.1"));
    ASSERT_TRUE(client.connect("127.0.0.1", server.getPortNumber()));
    ASSERT_TRUE(server.accept(&accepted));
    EXPECT_STREQ(accepted.getIPString(), "127.0.0.1");
    EXPECT_GT(accepted.writeString("%d words", 2), 0);
    EXPECT_EQ(client.readString(), "2 words");
    EXPECT_EQ(client.write("ok", 2), 2);
    char buffer[8];
    EXPECT_EQ(accepted.read(buffer, sizeof buffer, 1000), 2);
    EXPECT_EQ(accepted.read(buffer, sizeof buffer, 1), 0);
    const int port = server.getPortNumber();
    server.close();
    EXPECT_FALSE(client.connect("127.0.0.1", port));
    EXPECT_EQ(client.getError(), ArSocket::ConRefused);
}

std::string played;
bool play(const char* file, const char*) {
    played += file;
    return true;
}
bool never() { return false; }

TEST(SimAriaSounds, TheQueuePlaysInOrder) {
    played.clear();
    ArGlobalRetFunctor2<bool, const char*, const char*> player(&play);
    ArGlobalRetFunctor<bool> condition(&never);
    ArSoundsQueue queue;
    queue.setPlayWavFileCallback(&player);
    queue.pause();
    queue.play("a");
    ArSoundsQueue::Item skipped = queue.createDefaultFileItem("x");
    skipped.playbackConditionCallbacks.push_back(&condition);
    queue.addItem(skipped);
    queue.play("b");
    EXPECT_EQ(queue.getCurrentQueueSize(), 3U);
    queue.runAsync();
    queue.resume();
    while (queue.getCurrentQueueSize() > 0 || queue.isPlaying())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    queue.stop();
    queue.join();
    EXPECT_EQ(played, "ab");
}

TEST(SimAriaGeometry, TransformsInvert) {
    const ArTransform to_room(ArPose(1000, 500, 90));
    const ArPose moved = to_room.doTransform(ArPose(200, 100, 10));
    EXPECT_NEAR(moved.getX(), 900, 1e-9);
    EXPECT_NEAR(moved.getY(), 700, 1e-9);
    EXPECT_NEAR(moved.getTh(), 100, 1e-9);
    const ArPose back = to_room.doInvTransform(moved);
    EXPECT_NEAR(back.getX(), 200, 1e-9);
    EXPECT_NEAR(back.getY(), 100, 1e-9);
    const ArTransform between(ArPose(1, 2, 30), ArPose(7, -2, -60));
    const ArPose there = between.doTransform(ArPose(1, 2, 30));
    EXPECT_NEAR(there.findDistanceTo(ArPose(7, -2)), 0, 1e-9);
    EXPECT_NEAR(there.getTh(), -60, 1e-9);
    EXPECT_EQ(ArLineSegment(0, 0, 10, 0).getDistToLine(ArPose(13, 4)), 5);
}

ArTime timeOf(long ms) {
    ArTime time;
    time.setSec(100);
    time.setMSec(0);
    time.addMSec(ms);
    return time;
}

TEST(SimAriaInterpolation, PosesBetweenAndAfterReadings) {
    ArInterpolation poses(3);
    ArPose pose;
    EXPECT_EQ(poses.getPose(timeOf(0), &pose), -3) << "no readings";
    poses.addReading(timeOf(0), ArPose(0, 0, 170));
    EXPECT_EQ(poses.getPose(timeOf(0), &pose), 1);
    EXPECT_EQ(poses.getPose(timeOf(1), &pose), -3) << "one reading";
    poses.addReading(timeOf(100), ArPose(10, 20, -170));
    ArPoseWithTime newest;
    EXPECT_EQ(poses.getPose(timeOf(50), &pose, &newest), 1);
    EXPECT_EQ(pose, ArPose(5, 10, 180)) << "by the shorter turn";
    EXPECT_TRUE(newest.getTime().isAt(timeOf(100)));
    EXPECT_EQ(poses.getPose(timeOf(-1), &pose), -2);
    EXPECT_EQ(poses.getPose(timeOf(200), &pose), 0);
    EXPECT_EQ(pose, ArPose(20, 40, -150));
    EXPECT_EQ(poses.getPose(timeOf(5101), &pose), -1) << "more than 50 times the last two's time";
    poses.setAllowedMSForPrediction(90);
    EXPECT_EQ(poses.getPose(timeOf(200), &pose), -1);
    poses.setAllowedMSForPrediction();
    poses.addReading(timeOf(200), ArPose(10, 20));
    poses.addReading(timeOf(300), ArPose(10, 20));
    EXPECT_EQ(poses.getPose(timeOf(50), &pose), -2) << "three readings are kept";
    poses.reset();
    EXPECT_EQ(poses.getPose(timeOf(300), &pose), -3);
}

TEST(SimAriaPose, IsInMillimetresAndDegrees) {
    ArPose pose(1000, 0, 270);
    EXPECT_EQ(pose.getTh(), -90);
    EXPECT_EQ(ArPose(0, 0, -180).getTh(), 180);
    EXPECT_NEAR(pose.getThRad(), -M_PI / 2, 1e-15);
    EXPECT_EQ(pose.findDistanceTo(ArPose(1000, -300)), 300);
    EXPECT_EQ(pose.findAngleTo(ArPose(1000, -300)), -90);
    EXPECT_EQ((pose + ArPose(1, 2, -100)).getTh(), 170);
    EXPECT_EQ((pose - ArPose(1, 2, 100)).getX(), 999);
    EXPECT_TRUE(pose == ArPose(1000, 0, -90));
    EXPECT_TRUE(pose != ArPose(1000, 0, -91));
    double x = 0, y = 0;
    pose.getPose(&x, &y);
    EXPECT_EQ(x, 1000);
    EXPECT_EQ(ArMath::addAngle(170, 20), -170);
    EXPECT_EQ(ArMath::subAngle(-170, 20), 170);
    EXPECT_TRUE(ArMath::angleBetween(175, 170, -170));
    EXPECT_FALSE(ArMath::angleBetween(0, 170, -170));
    EXPECT_EQ(ArMath::roundInt(-2.5), -3);
}

TEST(SimAriaRangeBuffer, ReadingsAndPointersAreTheSame) {
    ArRangeDevice device(4, 8, "device", 5000);
    for (int i = 1; i <= 6; ++i) device.addReading(1000 * i, 0);
    const std::list<ArPoseWithTime>& readings = device.getCurrentReadings();
    ASSERT_EQ(readings.size(), 4U);
    EXPECT_EQ(readings.front().getX(), 6000);  // the newest first
    EXPECT_EQ(device.getCumulativeReadings().size(), 6U);
    EXPECT_EQ(device.getCurrentRangeBuffer().getCapacity(), 4U);
    device.getCurrentRangeBufferPtr()->addReadingConditional(4010, 0, 100 * 100);
    auto at = readings.begin();
    for (const ArPoseWithTime* pointer : *device.getCurrentBuffer()) EXPECT_EQ(pointer, &*at++);
    EXPECT_EQ(at, readings.end());
    device.applyTransform(ArTransform(ArPose(0, 100)));
    EXPECT_EQ(device.getCurrentBuffer()->front()->getY(), 100);
}

TEST(SimAriaRangeBuffer, NearPointsAreNotAddedAndSweepsRemove) {
    ArRangeBuffer buffer(10);
    bool added = false;
    for (int i = 0; i < 5; ++i) buffer.addReadingConditional(1000 * i, 0, 100 * 100, &added);
    EXPECT_TRUE(added);
    buffer.addReadingConditional(1050, 0, 100 * 100, &added);
    EXPECT_FALSE(added);
    EXPECT_EQ(buffer.getCurrentSize(), 5U);
    EXPECT_EQ(buffer.getBegin()->getX(), 1000);  // now the newest
    buffer.beginInvalidationSweep();
    for (auto at = buffer.getBegin(); at != buffer.getEnd(); ++at)
        if (at->getX() < 2500) buffer.invalidateReading(at);
    EXPECT_EQ(buffer.getCurrentSize(), 5U);
    buffer.endInvalidationSweep();
    ASSERT_EQ(buffer.getCurrentSize(), 2U);
    EXPECT_EQ(buffer.getBuffer()->size(), 2U);
    EXPECT_EQ(buffer.getBuffer()->back()->getX(), 3000);
}

TEST(SimAriaSonar, SectorsLookFromTheRobot) {
    ArSonarDevice sonar;
    std::vector<ArSensorReading> ring = {ArSensorReading(100, 100, 90), ArSensorReading(150, 0, 0),
                                         ArSensorReading(100, -100, -90)};
    const ArPose robot(1000, 1000, 90);
    EXPECT_EQ(sonar.currentReadingPolar(-90, 90), 5000);
    ring[0].newData(400, robot, 1);
    ring[1].newData(850, robot, 1);
    ring[2].newData(5000, robot, 1);
    EXPECT_NEAR(ring[1].getX(), 1000, 1e-9);
    EXPECT_NEAR(ring[1].getY(), 2000, 1e-9);
    sonar.processReadings(ring, robot);
    double angle = 0;
    EXPECT_NEAR(sonar.currentReadingPolar(-30, 30, &angle), 1000, 1e-6);
    EXPECT_NEAR(angle, 0, 1e-9);
    EXPECT_NEAR(sonar.currentReadingPolar(-90, 90, &angle), std::hypot(100, 500), 1e-6);
    EXPECT_NEAR(angle, std::atan2(500, 100) * 180 / M_PI, 1e-9);
    EXPECT_EQ(sonar.currentReadingPolar(-100, -60), 5000);
    EXPECT_NEAR(sonar.currentReadingBox(500, -200, 2000, 200), 1000, 1e-6);
    EXPECT_EQ(sonar.getCurrentBuffer()->size(), 2U);
    EXPECT_EQ(sonar.getMaxRange(), 5000U);
    for (int i = 0; i < 50; ++i) sonar.processReadings(ring, robot);
    EXPECT_EQ(sonar.getCurrentBuffer()->size(), 24U);
    EXPECT_EQ(sonar.getCumulativeBuffer()->size(), 64U);
    // Those of long ago are forgotten, and the far ones of the cumulative.
    sonar.processReadings({}, ArPose(9000, 9000));
    EXPECT_TRUE(sonar.getCumulativeBuffer()->empty());
}

TEST(SimAriaArguments, AreTakenFromTheLine) {
    char program[] = "a", host[] = "-rh", name[] = "there", rest[] = "left", flag[] = "-fast";
    char* words[] = {program, host, name, flag, rest, nullptr};
    int count = 5;
    ArArgumentParser parser(&count, words);
    EXPECT_TRUE(parser.checkArgument("-fast"));
    EXPECT_FALSE(parser.checkArgument("-fast"));
    EXPECT_STREQ(parser.checkParameterArgument("-rh"), "there");
    EXPECT_EQ(count, 2);
    EXPECT_STREQ(words[1], "left");
}

}  // namespace
