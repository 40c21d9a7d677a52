// SPDX-License-Identifier: GPL-3.0-or-later
// An element a piece, of the weight of its length. The rays from a place serve all headings there,
// as in other demands. content() holds all pieces exactly: a result that was computed for other
// ways is not taken for this one.
#include "extensions/presence/presence_demand.h"

#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "extensions/presence/presence.h"
#include "sense/motion_sense.h"

namespace ispace::presence {

namespace {

class PresenceDemand : public Demand {
  public:
    PresenceDemand(std::shared_ptr<const PeoplePaths> ways, double plane)
        : ways_(std::move(ways)), view_(*ways_, plane) {
        weights_.reserve(ways_->pieces.size());
        for (const PathPiece& piece : ways_->pieces) weights_.push_back(piece.length);
    }

    [[nodiscard]] std::string option() const override { return "--presence"; }
    [[nodiscard]] std::string_view one() const override { return "piece of way"; }
    [[nodiscard]] std::string_view many() const override { return "pieces of way"; }
    [[nodiscard]] const std::vector<double>& weights() const override { return weights_; }
    [[nodiscard]] std::string nothingText() const override {
        return "nothing to detect: nobody walks in the ways of --presence";
    }
    [[nodiscard]] std::string content() const override {
        std::string text;
        for (const PathPiece& piece : ways_->pieces)
            for (const double part : {static_cast<double>(piece.person), piece.time, piece.place.x,
                                      piece.place.y, piece.velocity.x, piece.velocity.y})
                text.append(formatDouble(part)) += ' ';
        return text;
    }
    void mustServe(const SensorModel& model, const std::string& id) const override {
        if (!detectsMotion(model))
            throw UsageError("--presence: " + id +
                             " detects no motion: give PIR sensors or radars");
    }
    [[nodiscard]] bool isServedBy(const Sensor& sensor) const override {
        return detectsMotion(sensor.model) && !sensor.mount && !sensor.person;
    }
    [[nodiscard]] std::vector<std::uint8_t> sightOf(const Sensor& sensor,
                                                    const RayScenes& worlds) const override {
        return view_.unhidden(worlds.mesh(kindOf(sensor.model).stopped_by), sensor);
    }
    using Demand::servedBy;
    [[nodiscard]] CellSet servedBy(const Sensor& sensor,
                                   const std::vector<std::uint8_t>& sight) const override {
        return view_.detected(sensor, sight);
    }

  private:
    std::shared_ptr<const PeoplePaths> ways_;
    PresenceView view_;
    std::vector<double> weights_;
};

}  // namespace

std::shared_ptr<const Demand> presenceDemand(std::shared_ptr<const PeoplePaths> ways,
                                             double plane) {
    return std::make_shared<PresenceDemand>(std::move(ways), plane);
}

}  // namespace ispace::presence
