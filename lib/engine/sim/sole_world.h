// SPDX-License-Identifier: GPL-3.0-or-later
// The run of one room behind the interface of many (worlds.h): requests about storeys and lifts are
// refused with a reason.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/worlds.h"

namespace ispace {

/// The world of a run that has no others: a room with the id "", so that names of things have no
/// room before them. Movers stay in it, so that they take commands and changes of the room alone.
class SoleWorld final : public Worlds {
  public:
    /// \pre the simulation outlives this object
    explicit SoleWorld(Simulation& simulation) : room_{"", &simulation} {}

    [[nodiscard]] bool areCoupled() const override { return false; }
    [[nodiscard]] std::span<const RunRoom> rooms() const override { return {&room_, 1}; }
    [[nodiscard]] std::optional<std::size_t> roomOf(std::string_view /*mover*/) const override {
        return std::nullopt;
    }
    [[nodiscard]] std::string whereText(std::size_t /*room*/) const override { return ""; }
    [[nodiscard]] RoomFrame frameOf(std::size_t /*room*/) const override { return {{}, true}; }
    [[nodiscard]] std::vector<PassageOutline> passageOutlines(std::size_t /*room*/) const override {
        return {};
    }
    [[nodiscard]] std::vector<PlannedPath> plannedPaths(std::size_t /*room*/) const override {
        return {};
    }
    TripAnswer travel(const std::string& /*mover*/, TripPlan /*plan*/) override {
        return {.refusal = kNone};
    }
    TripAnswer ride(const std::string& /*mover*/, std::string_view /*lift*/,
                    std::string_view /*storey*/) override {
        return {.refusal = kNone};
    }
    std::string endTrip(const std::string& /*mover*/, Outcome /*outcome*/) override { return ""; }
    void abandonTrip(const std::string& /*mover*/) override {}
    std::string place(const std::string& /*mover*/, const std::optional<RoomPoint>& /*at*/,
                      std::optional<Angle> /*heading*/) override {
        return kNone;
    }
    void restart() override {}
    std::string call(std::string_view /*lift*/, std::string_view /*storey*/) override {
        return kNone;
    }
    std::string hold(std::string_view /*lift*/, std::string_view /*storey*/) override {
        return kNone;
    }
    [[nodiscard]] std::vector<LiftState> lifts() const override { return {}; }
    [[nodiscard]] std::span<const TripEnd> tripEnds() const override { return {}; }
    void onMove(Observer /*observer*/) override {}

  private:
    static constexpr const char* kNone = "this run has one room";
    RunRoom room_;
};

}  // namespace ispace
