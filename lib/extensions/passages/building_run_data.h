// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/passages: the state of a building's run.
//
// A trip is a state machine (TripState), advanced before each step: it gives its mover one command
// of a world at a time, and reads from the ends of commands how it went. Turns at passages are
// queues by stop. All maps are ordered by id, so that equal runs take equal decisions.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/building_script.h"
#include "extensions/passages/cabin.h"
#include "extensions/passages/lift_record.h"
#include "extensions/passages/storey_paths.h"
#include "geom/polygon.h"
#include "scene/scene.h"
#include "sim/collision.h"
#include "site/site_sight.h"

namespace ispace::passages {

/// Metres between two movers on a flight of stairs or waiting.
constexpr double kFlightGap = 0.2;

/// A robot or a person, in any of the worlds.
struct Traveller {
    std::string id;
    std::size_t room = 0;
    MoverSize size = {};
    MoverAbility ability = {};
    bool is_person = false;
    double max_speed = 0;
    std::vector<Record> records = {};  ///< its own, then those of its sensors
};

/// The state of a trip. A passage leads from Queueing over Nearing, Entering, Riding or Climbing,
/// and Leaving to AtEnd.
enum class TripState {
    Setting,   ///< about to begin a leg
    Walking,   ///< to where it waits, or to the goal
    Queueing,  ///< it waits for a passage
    Nearing,   ///< from there to the landing
    Entering,  ///< into the cabin
    Riding,
    Climbing,
    Leaving,  ///< out of the cabin, to the lane
    AtEnd,    ///< in the lane or on the last step, until the landing is free
    Pausing,  ///< at a point of the plan
    Turning   ///< to the heading of the plan, at its last point
};

/// A way over a storey after a passage of a trip.
struct StoreySection {
    std::size_t storey = 0;
    std::vector<Point2> points;
};

/// A trip of a mover to the points of a plan, as a sequence of commands in several worlds.
struct BuildingTrip {
    int command = 0;  ///< its id among those of the mover
    TripPlan plan;
    std::size_t goal = 0;             ///< of the plan's points
    SimTime pause_until{};            ///< of Pausing
    std::optional<std::size_t> only;  ///< passage to be used
    std::vector<Leg> legs;
    std::size_t leg = 0;
    TripState state = TripState::Setting;
    std::deque<Point2> steps;  ///< points of a way that it goes without a look around
    int running = 0;           ///< id of the command under way in its world; 0: none
    int attempts = 0;
    std::optional<Point2> spot;  ///< reserved, in the frame of the storey
    /// Once it is out of lifts and stairs, it clears the landing and ends so.
    std::optional<Outcome> ending;
    std::optional<RoomPoint> given_up;   ///< the goal at that moment
    std::optional<SimTime> blocked;      ///< since when others occupy its landing
    std::optional<SimTime> asked;        ///< when it last asked them to step aside
    SimTime queued{};                    ///< since when it waits for a passage
    std::vector<StoreySection> planned;  ///< after the passages of `planned_legs`
    std::vector<Leg> planned_legs;
    std::size_t planned_goal = 0;
};

/// A mover with walk=wander.
struct Wanderer {
    std::optional<SimTime> until;  ///< it stays on its storey; empty: it does not wander now
    std::optional<int> trip;       ///< to another storey, its command
    std::uint64_t draws = 0;       ///< of random numbers
};

/// A stop of a passage: whose turn it is.
struct Stop {
    std::deque<std::string> queue;
    std::string holder;  ///< the mover that enters or has left; "": none
};

/// An opening in the floor of a storey, in its frame.
struct OpenFloor {
    std::string passage;  ///< its id
    Polygon outline;
};

/// Returns the openings of each storey: shafts, straight stairs from below, and lifts.
std::vector<std::vector<OpenFloor>> openingsByStorey(const SiteScene& building,
                                                     const std::vector<StoreyLink>& passages);

struct BuildingRun::Data {
    Data(const SiteScene& the_building, const BuildingRunOptions& the_options);

    struct Room {
        std::string id;
        std::optional<std::size_t> storey;    // of a storey
        std::size_t passage = 0, flight = 0;  // of a cabin or a flight
        std::unique_ptr<World> world = {};
        std::unique_ptr<Replay> replay = {};
        std::unique_ptr<Simulation> simulation = {};
        std::shared_ptr<const Scene> known = {};  // of a storey: of which others know the sensors
    };

    void addRooms();
    void showSensors();
    void addTravellers();
    void addRoom(Room room, std::shared_ptr<const Scene> scene);
    [[nodiscard]] const StoreyPaths& waysOf(const Traveller& who) const {
        return ways.at(who.size);
    }
    [[nodiscard]] World& worldOf(const Traveller& who) { return *rooms[who.room].world; }
    [[nodiscard]] RobotStatus statusOf(const Traveller& who) const;
    [[nodiscard]] std::optional<std::size_t> storeyNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> liftNamed(std::string_view id) const;
    [[nodiscard]] std::optional<std::size_t> stopNamed(const StoreyLink& lift,
                                                       std::string_view storey) const;
    [[nodiscard]] std::vector<double> waits() const;
    [[nodiscard]] std::vector<LiftNames> liftNames() const;
    [[nodiscard]] LiftState liftState(std::size_t passage) const;
    void notifyLifts();

    // Replays.
    void replay();
    std::shared_ptr<const Scene> openReplay(Room& room, const Scene& scene) const;
    void showLifts(SimTime time);
    void locate();

    // Trips.
    /// Begins the trips of records, in the order of ids. \returns the findings about those without
    /// a way
    Diagnostics beginRecordedTrips();
    TripAnswer begin(const std::string& mover, BuildingTrip trip);
    [[nodiscard]] std::optional<Route> routeFrom(const Traveller& who, std::size_t storey,
                                                 Point2 at, const BuildingTrip& trip,
                                                 std::size_t goal) const;
    void advance();
    void advanceTrip(const std::string& id, BuildingTrip& trip);
    void advanceLifts();
    void setOut(Traveller& who, BuildingTrip& trip);
    void queueUp(Traveller& who, BuildingTrip& trip);
    void waitTurn(Traveller& who, BuildingTrip& trip);
    void enter(Traveller& who, BuildingTrip& trip);
    void enterCabin(Traveller& who, BuildingTrip& trip);
    void enterFlight(Traveller& who, BuildingTrip& trip);
    void tryAgain(Traveller& who, BuildingTrip& trip, Outcome outcome);
    void arriveAtGoal(Traveller& who, BuildingTrip& trip);
    bool turnAtGoal(Traveller& who, BuildingTrip& trip);
    void goToNextGoal(Traveller& who, BuildingTrip& trip);
    /// Returns the ways after the passages of its legs, which it computes once for each goal.
    [[nodiscard]] const std::vector<StoreySection>& sectionsOf(const Traveller& who,
                                                               BuildingTrip& trip) const;
    [[nodiscard]] bool isNearLanding(const Traveller& who, const BuildingTrip& trip) const;
    void climb(Traveller& who, BuildingTrip& trip);
    void leaveCabin(Traveller& who, BuildingTrip& trip);
    void step(Traveller& who, BuildingTrip& trip);
    void arrive(Traveller& who, BuildingTrip& trip);
    [[nodiscard]] std::string loadText(const Traveller& who) const;
    /// Returns the id of the thing that a person carries, or "".
    [[nodiscard]] static std::string loadOf(const Scene& scene, const std::string& person);
    /// \param reason why it is given up, which the event `unreached` tells
    void finish(const std::string& id, Outcome outcome, const std::string& reason = "");
    void notifyUnreached(const Traveller& who, const BuildingTrip& trip, const std::string& reason);
    void giveUp(Traveller& who, BuildingTrip& trip, Outcome outcome);
    void clearLanding(Traveller& who, BuildingTrip& trip);
    /// Returns how far from a landing it leaves it to others.
    [[nodiscard]] static double clearanceOf(const Traveller& who);
    void turnBack(Traveller& who, BuildingTrip& trip);
    static void reverse(BuildingTrip& trip);
    [[nodiscard]] static double laneOf(const Traveller& who, const StoreyLink& passage, bool is_up);
    /// Returns the landing on which a mover stands, or null.
    [[nodiscard]] const Landing* landingUnder(const Traveller& who) const;
    /// Returns the first of these spots that is free and not reserved.
    [[nodiscard]] std::optional<Point2> freeSpot(const Traveller& who,
                                                 const std::vector<Point2>& spots) const;
    /// Returns a way on its storey; after a failure one that leads round movers that stand, if
    /// there is one.
    [[nodiscard]] std::vector<Point2> wayTo(const Traveller& who, const BuildingTrip& trip,
                                            Point2 to) const;
    /// Sends those that wait or pause aside if they stand in the way of a circle that is stuck at a
    /// point of a storey. \returns true if there are any
    bool askAside(std::size_t storey, double radius, Point2 at, const std::vector<Point2>& way);
    /// Finds the nearest point where a mover can wait, off all landings and `apart` from a way.
    [[nodiscard]] std::optional<Point2> spotAside(const Traveller& who, Point2 from,
                                                  const std::vector<Point2>& way, double apart);
    void release(const std::string& id);
    void releaseHolders();
    [[nodiscard]] bool mayHoldOpen(std::size_t lift) const;
    [[nodiscard]] bool mayPass(const Traveller& who, const BuildingTrip& trip) const;

    // Wanderers.
    void advanceWanderers();
    void visitOtherStorey(const std::string& id, Wanderer& wanderer);
    void wanderOn(const std::string& id, int command, Outcome outcome);
    double random(const std::string& id, Wanderer& wanderer) const;

    /// Gives a mover a way in its present world.
    void send(Traveller& who, BuildingTrip& trip, std::vector<Point2> way, double speed);
    /// Sends it from point to point, turning on the spot: along ways that are known to be free.
    void sendStraight(Traveller& who, BuildingTrip& trip, std::deque<Point2> way);
    void goOn(Traveller& who, BuildingTrip& trip);
    /// Returns how the command ended; empty while it is under way.
    std::optional<Outcome> ended(const Traveller& who, BuildingTrip& trip) const;
    /// Moves a mover to another room; `is_put` ends its command and its trip as stopped. \returns
    /// the reason why that is impossible, or ""; all is then as before
    std::string move(Traveller& who, std::size_t room, const Pose2& pose, bool is_put = false);
    /// Returns the text of a refusal: "r1 has no room at upper/1,2: desk1 stands there".
    [[nodiscard]] std::string refusal(std::size_t room, Point2 at, const Traveller& who,
                                      const std::string& reason) const;
    /// Returns the refusal that names the body of a storey, as it is now, in which a mover would
    /// stand, or "".
    [[nodiscard]] std::string bodyText(std::size_t storey, Point2 at, const Traveller& who);
    /// Returns the opening in the floor at a point of a storey, or null.
    [[nodiscard]] const OpenFloor* openingAt(std::size_t storey, Point2 at) const;
    /// Returns true if it would overlap no body and no mover.
    [[nodiscard]] bool isFree(std::size_t room, Point2 at, const Traveller& who);
    /// Returns the reason why it would not, or "".
    [[nodiscard]] std::string noRoomText(std::size_t room, Point2 at, const Traveller& who);
    /// Returns the reason why a mover cannot be sent or put to a point of a storey, whatever moves
    /// there, or "": a body, or a floor that is open.
    [[nodiscard]] std::string noFloorText(std::size_t storey, Point2 at, const Traveller& who);
    /// Returns the next scene of a room, of these records. \throws FormatError as makeScene()
    [[nodiscard]] NextScene sceneOf(std::size_t room, std::vector<Record> records) const;
    /// \throws FormatError if a mover has no room where it is put; all is then as before
    void change(std::size_t room, const NextScene& next, std::vector<std::string> requests,
                std::span<const std::string> placed = {});
    /// Ends the trip of a mover and its command `running`, if not 0, as stopped.
    void endCommands(const Traveller& who, int running);
    std::string place(Traveller& who, std::size_t room, const Pose2& pose);
    void restart();

    SiteScene building;
    BuildingRunOptions options;
    std::vector<StoreyLink> passages;
    std::vector<std::vector<OpenFloor>> openings;  // by storey
    std::shared_ptr<RoomsAround> around;           // views of other storeys
    std::vector<Room> rooms;  // storeys, then the cabin or the flights of each passage
    std::vector<RunRoom> joined;
    std::vector<std::size_t> first_room;             // of each passage
    std::vector<Lift> lifts;                         // by passage; unused for stairs
    std::vector<std::vector<RoomState>> told_lifts;  // their states, by passage
    SimTime told_at{};                               // when they were told
    std::vector<std::vector<Rider>> riders;          // by passage
    std::vector<std::vector<Stop>> stops;            // by passage and stop
    std::map<MoverSize, StoreyPaths> ways;
    /// Obstacles of a storey as of its last change.
    struct PresentObstacles {
        std::int64_t changes = 0;  // of the storey's world
        Obstacles obstacles;
    };
    std::map<std::pair<std::size_t, double>, PresentObstacles> present;  // by storey and height
    std::map<std::string, Traveller, std::less<>> travellers;
    std::map<std::string, BuildingTrip, std::less<>> trips;
    std::map<std::string, Wanderer, std::less<>> wanderers;
    std::vector<TripEnd> ends, new_ends;
    std::vector<Observer> observers;
    std::optional<BuildingScript> script;
    std::optional<LiftRecorder> lift_recorder;
    std::optional<LiftReader> lift_reader;  // of a replay
};

}  // namespace ispace::passages
